#include "options.hpp"

#include "app/seeded_camera.hpp"
#include "core/error.hpp"
#include "core/knob.hpp"
#include "parse.hpp"

#include <algorithm>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kMostFrames = 1'000'000;
constexpr double kMostStops = 64; // 2^64 is far beyond every picture, and finite

const std::string kCommonGroup = "Common options";
const std::string kMannersGroup = "Output";

void add_numbers(CLI::App& verb, Common& common) {
    add_text(verb, "--size", "WxH", "picture size (512x512)",
             [&](const std::string& text) { common.size = parse_size("--size", text); });
    add_text(verb, "--frames", "N", "measured frames, at least 1 (20)",
             [&](const std::string& text) {
                 common.frames = static_cast<int>(parse_whole("--frames", text, 1, kMostFrames));
             });
    add_text(verb, "--warmup", "N", "frames before them, not measured (8)",
             [&](const std::string& text) {
                 common.warmup = static_cast<int>(parse_whole("--warmup", text, 0, kMostFrames));
             });
    add_text(verb, "--time", "SECONDS", "instant of the scene's motion (0)",
             [&](const std::string& text) { common.time = parse_real("--time", text); });
    verb.add_flag("--animate", common.animate,
                  "frame k at --time + (k-1)/60 s; otherwise all frames at --time");
    add_text(verb, "--seed", "N",
             "of --camera seeded and of sample patterns that are no regular grid (1)",
             [&](const std::string& text) { common.seed = parse_seed("--seed", text); });
    add_text(verb, "--ambient", "A", "ambient light, at least 0 (0.05)",
             [&](const std::string& text) { common.ambient = parse_real("--ambient", text, 0); });
    add_exposure(verb, common.exposure);
}

void take_model(const std::string& text) {
    const bool everything = parse_choice("--model", text, {"everything", "required"}) == 0;
    check(everything, Failure::usage,
          "--model required: is not there yet; this version renders 'everything'");
}

void add_choices(CLI::App& verb, Common& common) {
    add_text(verb, "--camera", "C",
             "name, index from 0, EX,EY,EZ:TX,TY,TZ:FOV, or seeded: drawn from --seed, a mirror in "
             "view (the file's first)",
             [&](const std::string& text) { common.camera = text; });
    add_text(verb, "--model", "M",
             "everything: each mirror, six faces, every frame. required: not there yet",
             take_model);
    add_text(verb, "--reference", "T", "technique that compare judges against (raytrace:depth=16)",
             [&](const std::string& text) { common.reference = app::parse_technique(text).label; });
    add_text(verb, "--device", "D",
             "index from 0 or part of a name, see 'list devices' (the fastest kind)",
             [&](const std::string& text) { common.device = text; });
    add_text(
        verb, "--timing", "T",
        "isolated: times of passes add up. pipelined: passes may overlap (isolated)",
        [&](const std::string& text) {
            const bool isolated = parse_choice("--timing", text, {"isolated", "pipelined"}) == 0;
            common.timing = isolated ? app::Timing::isolated : app::Timing::pipelined;
        });
    verb.add_flag("--validate", common.validate,
                  "watched by the Vulkan validation layer; any message fails the run");
}

std::string camera_list(const scene::Scene& scene) {
    std::string list;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        list += (i ? ", " : "") + std::to_string(i) + " '" + scene.cameras[i].name + "'";
    return list.empty() ? "none" : list;
}

dvec3 parse_point(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    check(parts.size() == 3, Failure::usage, "--camera: wanted a point X,Y,Z, found '", text, "'");
    return {parse_real("--camera", parts[0]), parse_real("--camera", parts[1]),
            parse_real("--camera", parts[2])};
}

/// "EX,EY,EZ:TX,TY,TZ:FOV".
scene::Camera placed_camera(const std::string& text) {
    const std::vector<std::string> parts = split(text, ':');
    check(parts.size() == 3, Failure::usage,
          "--camera: wanted EX,EY,EZ:TX,TY,TZ:FOV (eye, target, degrees), found '", text, "'");
    scene::Camera camera{
        .name = text, .eye = parse_point(parts[0]), .target = parse_point(parts[1])};
    camera.vertical_fov_degrees = parse_real("--camera", parts[2], 0.001, 179);
    check(camera.eye != camera.target, Failure::usage,
          "--camera: wanted a target away from the eye, found both at ", parts[0]);
    const dvec3 along = camera.target - camera.eye;
    if (along.x == 0 && along.z == 0) camera.up = dvec3(0, 0, 1); // straight up or down
    return camera;
}

scene::Camera choose_camera(const Common& common, const scene::Scene& scene) {
    const auto is_called_so = [&](const scene::Camera& camera) {
        return camera.name == common.camera;
    };
    if (common.camera == "seeded" && std::ranges::none_of(scene.cameras, is_called_so)) {
        scene::Camera camera = app::seeded_camera(scene, common.time, common.seed);
        note(common.manners,
             "camera drawn from seed " + std::to_string(common.seed) + ": " + camera.name);
        return camera;
    }
    if (!common.camera.empty()) return parse_camera(common.camera, scene);
    if (!scene.cameras.empty()) return scene.cameras.front();
    const scene::Camera camera = scene::default_camera(scene);
    std::ostringstream text;
    text << "no camera in file: using eye " << camera.eye.x << ',' << camera.eye.y << ','
         << camera.eye.z << ", target " << camera.target.x << ',' << camera.target.y << ','
         << camera.target.z << ", " << camera.vertical_fov_degrees << " degrees";
    note(common.manners, text.str());
    return camera;
}

} // namespace

CLI::Option* add_text(CLI::App& verb, const std::string& name, const std::string& type,
                      const std::string& help, std::function<void(const std::string&)> take) {
    return verb.add_option_function<std::string>(name, take, help)->type_name(type);
}

void add_exposure(CLI::App& verb, double& exposure) {
    add_text(verb, "--exposure", "STOPS", "brightness of PNG, HTML and FLIP: times 2^STOPS (0)",
             [&](const std::string& text) {
                 exposure = parse_real("--exposure", text, -kMostStops, kMostStops);
             });
}

void add_manners(CLI::App& verb, Manners& manners) {
    verb.option_defaults()->group(kMannersGroup);
    verb.add_flag("--json", manners.json, "one JSON document on stdout instead of text");
    verb.add_flag("-q,--quiet", manners.quiet, "no progress and no information on stderr");
    verb.add_flag("-v,--verbose", manners.verbose, "more information on stderr");
    add_text(verb, "--progress", "WHEN", "auto: on a terminal; always; never (auto)",
             [&](const std::string& text) {
                 manners.progress = static_cast<ProgressMode>(
                     parse_choice("--progress", text, {"auto", "always", "never"}));
             });
    verb.allow_extras(); // so that refuse_extras can suggest
}

void add_common(CLI::App& verb, Common& common) {
    verb.add_option(
            "SCENE", common.scene,
            "built-in name (see 'list scenes') or .glb, .gltf or .obj file (cornell-mirrors)")
        ->type_name("");
    verb.option_defaults()->group(kCommonGroup);
    add_numbers(verb, common);
    add_choices(verb, common);
    add_manners(verb, common.manners);
}

void refuse_extras(const CLI::App& verb) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string> extras = verb.remaining();
    for (const std::string& extra : extras) {
        if (!extra.starts_with('-') || extra == "--") continue;
        const std::string name = extra.substr(0, extra.find('='));
        fail(Failure::usage, "'", verb.get_name(), "' has no option '", name, "'",
             did_you_mean(name, names));
    }
    check(extras.empty(), Failure::usage, "'", verb.get_name(),
          "' wanted no further argument, found '", extras.empty() ? "" : extras.front(), "'");
}

void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what) {
    check(given, Failure::usage, "'", verb, "' needs ", option, ": ", what);
}

app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check) {
    app::Request request;
    request.seed = common.seed;
    request.scene = scene::load(common.scene);
    if (check) check(request.scene);
    for (const std::string& warning : request.scene.warnings) warn(warning);
    request.camera = choose_camera(common, request.scene);
    request.size = common.size;
    request.frames = common.frames.value_or(request.frames);
    request.warmup = common.warmup.value_or(request.warmup);
    request.time = common.time;
    request.animate = common.animate;
    request.ambient = common.ambient;
    request.exposure = common.exposure;
    request.timing = common.timing;
    return request;
}

app::EngineOptions engine_options(const Common& common) {
    return {.device = common.device, .validate = common.validate};
}

scene::Camera parse_camera(const std::string& text, const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const scene::Camera& camera : scene.cameras) {
        if (camera.name == text) return camera;
        names.push_back(camera.name);
    }
    if (text.find(':') != std::string::npos) return placed_camera(text);
    const bool is_index = text.find_first_not_of("0123456789") == std::string::npos &&
                          text.size() < 10;
    if (is_index && !text.empty() && std::stoul(text) < scene.cameras.size())
        return scene.cameras[std::stoul(text)];
    names.emplace_back("seeded");
    fail(Failure::usage, "--camera: scene '", scene.name, "' has no camera '", text,
         "'; it has: ", camera_list(scene), "; or seeded, or EX,EY,EZ:TX,TY,TZ:FOV",
         did_you_mean(text, names));
}

} // namespace catoptric::cli
