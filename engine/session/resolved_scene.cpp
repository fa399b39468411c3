#include "session/resolved_scene.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "import/file_options.hpp"
#include "import/scene_file.hpp"
#include "measure/picture_file.hpp"
#include "scene/built_in.hpp"
#include "scene/camera_named.hpp"
#include "scene/classify.hpp"
#include "scene/default_camera.hpp"
#include "scene/inside_camera.hpp"
#include "scene/light.hpp"
#include "scene/number.hpp"
#include "scene/unsupported_feature.hpp"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace catoptric::session {

namespace {

constexpr std::size_t kMaxSceneLights = 16;
constexpr std::size_t kMaxEnvironmentTexels = std::size_t{1} << 25; // 8192 x 4096
constexpr std::size_t kManyMirrorsLimit = 64; // scenes with more mirrors get a message

bool is_built_in(const std::string& name) {
    return std::ranges::any_of(scene::built_in_scenes(), [&](const scene::BuiltInScene& scene) {
        return scene.name == name;
    });
}

std::shared_ptr<scene::Environment> read_environment(const std::string& path) {
    const measure::Picture picture = measure::read_picture(path, [&](int width, int height) {
        check(std::size_t(width) * std::size_t(height) <= kMaxEnvironmentTexels, Failure::bad_data,
              path, ": wanted an environment of at most ", kMaxEnvironmentTexels, " texels, found ",
              width, "x", height);
    });
    float brightest = 0;
    for (const vec3& texel : picture.pixels)
        brightest = std::max({brightest, texel.x, texel.y, texel.z});
    // Filters and lossy compression leave values below 0 that are not meant.
    constexpr float kMostOvershoot = 1e-2f;
    const auto is_light = [&](float value) {
        return std::isfinite(value) && value >= -kMostOvershoot * brightest;
    };
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const vec3& texel = picture.pixels[i];
        const auto width = static_cast<std::size_t>(picture.width);
        check(is_light(texel.x) && is_light(texel.y) && is_light(texel.z), Failure::bad_data, path,
              ": texel ", i % width, ",", i / width, ": wanted finite light of at least 0, found ",
              texel.x, ",", texel.y, ",", texel.z);
    }
    auto environment = std::make_shared<scene::Environment>();
    environment->name = std::filesystem::path(path).filename().string();
    environment->size = {static_cast<std::uint32_t>(picture.width),
                         static_cast<std::uint32_t>(picture.height)};
    environment->texels = picture.pixels;
    for (vec3& texel : environment->texels) texel = max(texel, vec3(0));
    return environment;
}

/// Returns the environment that `word` names; null for "none".
std::shared_ptr<scene::Environment> load_environment(const std::string& word) {
    if (word == "none") return nullptr;
    std::error_code ignored;
    if (word != "studio" && !std::filesystem::exists(measure::locate_picture(word).file, ignored))
        fail(Failure::missing_input, "--environment: ", quote(word),
             ": there is no such file; wanted a picture (.exr, .hdr or .png), studio or none",
             suggest_name(word, std::vector<std::string>{"studio", "none"}));
    if (word != "studio") return read_environment(word);
    auto studio = std::make_shared<scene::Environment>();
    studio->name = "studio", studio->studio = true;
    return studio;
}

void record_file(scene::Scene& scene, const std::filesystem::path& real) {
    if (std::ranges::find(scene.files, real) == scene.files.end()) scene.files.push_back(real);
}

/// Throws if overrides change an environment that the scene does not have. `remedy` ends the
/// message.
void check_environment_exists(const scene::SceneOverrides& overrides,
                              const scene::SettingOrigin& scale,
                              const scene::SettingOrigin& rotation, const char* remedy) {
    for (const auto& [is_said, by] :
         {std::pair(overrides.environment_scale.has_value(), &scale),
          std::pair(overrides.environment_rotation.has_value(), &rotation)})
        check(!is_said, by->failure, by->where, ": wanted an environment, found none; ", remedy);
}

/// `said`: overrides of the command line.
void apply_environment(ResolvedScene& wanted, const scene::SceneOverrides& said) {
    scene::Scene& scene = wanted.scene;
    const scene::SceneOverrides& overrides = wanted.overrides;
    std::shared_ptr<scene::Environment> environment;
    if (scene.environment) environment = std::make_shared<scene::Environment>(*scene.environment);
    if (overrides.environment) {
        environment = load_environment(*overrides.environment);
        if (environment && !environment->studio && environment->size.x != 2 * environment->size.y)
            wanted.said.push_back("environment " + quote(environment->name) +
                                  ": wanted a picture "
                                  "twice as wide as high, found " +
                                  std::to_string(environment->size.x) + "x" +
                                  std::to_string(environment->size.y) +
                                  "; it is stretched over the whole sphere, "
                                  "but a square picture may be a mirror ball or an angular map");
        if (environment && !environment->studio)
            record_file(scene, real_path(measure::locate_picture(*overrides.environment).file));
    } else if (wanted.is_file && !environment && scene::list_lights(scene).empty()) {
        environment = load_environment("studio");
        scene::add_unsupported(scene.unsupported, "added-studio", "scene " + quote(scene.name));
        wanted.said.push_back("no light: lit by the environment studio (see --environment)");
    }
    if (environment) {
        if (overrides.environment_scale) environment->scale = *overrides.environment_scale;
        if (overrides.environment_rotation)
            environment->rotation_degrees = *overrides.environment_rotation;
    } else {
        check_environment_exists(said, {"--environment-scale"}, {"--environment-rotate"},
                                 "give --environment");
        // A scene file cannot know that the command line removes the environment. Its settings of
        // the environment are then ignored.
        if (wanted.scene_file && !said.environment) {
            const std::string file = wanted.scene_file->string();
            check_environment_exists(overrides, {file + ": environment_scale", Failure::bad_data},
                                     {file + ": environment_rotate", Failure::bad_data},
                                     "say \"environment\", too");
        }
    }
    scene.environment = std::move(environment);
}

/// Sets the number of points that replace each lamp. Throws `usage` if there would be more lights
/// than the device can hold.
void apply_light_samples(ResolvedScene& wanted) {
    if (!wanted.overrides.light_samples) return;
    scene::Scene& scene = wanted.scene;
    const int samples = *wanted.overrides.light_samples;
    const std::size_t others = scene.punctual.size(),
                      lamps = scene::list_lights(scene).size() - others,
                      most = shared::kMaxLights - std::min<std::size_t>(others, shared::kMaxLights);
    check(lamps * static_cast<std::size_t>(samples) <= most, Failure::usage, "--light-samples ",
          samples, " (light_samples in a scene file): ", lamps, " lamps would become ",
          lamps * static_cast<std::size_t>(samples), " lights; wanted at most ", most,
          ", which are ", most / std::max<std::size_t>(lamps, 1), " for each lamp");
    scene.light_samples = samples;
}

void warn_of_many_mirrors(scene::Scene& scene) {
    // Six faces of 256 texels an edge, kept for the next frame, too. Colour takes half floats. With
    // it come distance and, for one frame, the number of the surface seen.
    constexpr std::size_t kTypicalCaptureTexels = 6 * 256 * 256, kBytesPerMebibyte = 1 << 20,
                          kColourBytes = kTypicalCaptureTexels * 2 * 8,
                          kCaptureBytes = kTypicalCaptureTexels * (2 * (8 + 4) + 8);
    const std::size_t count = scene::mirrors(scene).size();
    if (count <= kManyMirrorsLimit) return;
    const std::string number = std::to_string(count);
    const auto mebibytes = [&](std::size_t bytes) {
        return std::to_string(count * bytes / kBytesPerMebibyte);
    };
    scene.warnings.push_back("scene " + quote(scene.name) + " has " + number +
                             " mirrors: " + number + " captures of six faces a frame, " +
                             mebibytes(kColourBytes) + " to " + mebibytes(kCaptureBytes) +
                             " MiB at face=256; a smaller face=, --plan and --model required "
                             "lessen that");
}

bool is_seeded_camera(const std::string& camera, const scene::Scene& scene) {
    return camera == "seeded" &&
           std::ranges::find(scene.cameras, camera, &scene::Camera::name) == scene.cameras.end();
}

/// Returns the camera that the overrides name. Returns nothing if it is to be drawn from a seed, or
/// is not named.
std::optional<scene::Camera> find_named_camera(const scene::SceneOverrides& overrides,
                                               const scene::Scene& scene,
                                               const scene::SettingOrigin& by) {
    if (!overrides.camera || is_seeded_camera(*overrides.camera, scene)) return std::nullopt;
    return scene::find_camera(*overrides.camera, scene, by);
}

/// Copies exposure and camera of the scene file into the scene, and therefore into its hash. The
/// camera comes first.
void copy_file_settings(ResolvedScene& wanted, const scene::SceneFile& filed,
                        const std::optional<scene::Camera>& camera) {
    scene::Scene& scene = wanted.scene;
    if (filed.overrides.exposure) scene.exposure = filed.overrides.exposure->stops;
    if (camera) {
        std::erase(scene.cameras, *camera);
        scene.cameras.insert(scene.cameras.begin(), *camera);
    }
    for (const std::filesystem::path& file : filed.files) record_file(scene, file);
}

/// `said`: overrides of the command line.
void apply_scene_overrides(ResolvedScene& wanted, const scene::SceneOverrides& said,
                           const std::optional<scene::SceneFile>& filed) {
    scene::Scene& scene = wanted.scene;
    const std::string file = filed ? filed->path.string() : "";
    if (filed) scene::check_patterns(scene, filed->overrides, file);
    scene::apply_overrides(scene, wanted.overrides);
    // Finds the camera before `copy_file_settings` changes the order of cameras, because an
    // index counts in the scene's own order.
    std::optional<scene::Camera> camera;
    if (filed)
        camera = find_named_camera(filed->overrides, scene, {file + ": camera", Failure::bad_data});
    wanted.camera = said.camera ? find_named_camera(said, scene, {"--camera"}) : camera;
    wanted.is_camera_seeded = wanted.overrides.camera &&
                              is_seeded_camera(*wanted.overrides.camera, scene);
    if (filed) copy_file_settings(wanted, *filed, camera);
}

} // namespace

ResolvedScene resolve_scene(const std::string& name, const ResolveOptions& options) {
    ResolvedScene wanted{.overrides = options.overrides, .is_file = !is_built_in(name)};
    std::optional<scene::SceneFile> filed;
    if (wanted.is_file && options.use_scene_file)
        filed = scene::read_scene_file(name, options.load);
    if (filed) {
        wanted.scene_file = filed->path;
        wanted.overrides = scene::combine(options.overrides, filed->overrides);
        wanted.said.push_back("read beside the scene: " + filed->path.string() +
                              " (--no-scene-file leaves it out)");
        const std::optional<double>& limit = filed->overrides.mirror_max_roughness;
        if (limit && !options.overrides.mirror_max_roughness)
            wanted.said.push_back(
                filed->path.string() + ": surfaces rougher than " + scene::format_number(*limit) +
                " are no mirrors (mirror_max_roughness; --mirror-max-roughness sets another limit, " +
                scene::format_number(scene::Scene().mirror_max_roughness) + " by default)");
    }
    scene::FileOptions load = options.load;
    if (wanted.overrides.animation) load.animation = *wanted.overrides.animation;
    if (filed && !options.overrides.animation)
        load.animation_by = {filed->path.string() + ": animation", Failure::bad_data};
    wanted.scene = scene::load_file(name, load);
    apply_scene_overrides(wanted, options.overrides, filed);
    if (wanted.is_file) scene::drop_weakest_lights(wanted.scene, kMaxSceneLights);
    apply_light_samples(wanted);
    wanted.scene.environment_shadows = wanted.overrides.environment_shadows.value_or(0);
    apply_environment(wanted, options.overrides);
    if (wanted.scene.environment_shadows > 0 && !wanted.scene.environment)
        wanted.said.emplace_back(
            "--environment-shadows has no effect: the scene has no environment "
            "(--environment adds one)");
    scene::add_unsupported_lighting(wanted.scene);
    warn_of_many_mirrors(wanted.scene);
    return wanted;
}

double choose_ambient(const ResolvedScene& wanted) {
    return wanted.overrides.ambient.value_or(wanted.scene.environment ? 0 : .05);
}

std::optional<double> find_exposure(const ResolvedScene& wanted) {
    if (wanted.overrides.exposure) return wanted.overrides.exposure->stops;
    if (wanted.scene.exposure) return wanted.scene.exposure;
    return wanted.is_file ? std::nullopt : std::optional(0.0);
}

scene::Camera choose_camera(ResolvedScene& wanted, double aspect) {
    scene::Scene& scene = wanted.scene;
    if (wanted.camera) return *wanted.camera;
    if (!scene.cameras.empty()) return scene.cameras.front();
    const scene::Camera outside = scene::default_camera(scene, aspect);
    const auto inside = scene::find_inside_camera(scene, outside);
    const bool is_room = inside && inside->is_in_room;
    const scene::Camera camera = is_room ? inside->camera : outside;
    if (wanted.is_file)
        scene::add_unsupported(scene.unsupported, "added-camera", "scene " + quote(scene.name));
    wanted.said.push_back(std::string("no camera") + (is_room ? ", a closed room" : "") +
                          ": using --camera " + scene::format_camera(camera) +
                          (is_room ? " (inside)" : ""));
    if (inside && !is_room)
        wanted.said.back() += "; the scene is closed, but no room whose walls face its middle: "
                              "--camera " +
                              scene::format_camera(inside->camera) + " looks from inside";
    return camera;
}

} // namespace catoptric::session
