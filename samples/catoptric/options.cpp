#include "options.hpp"

#include "app/seeded_camera.hpp"
#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/stopwatch.hpp"
#include "core/text.hpp"
#include "parse.hpp"
#include "scene/load.hpp"

#include <algorithm>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kMostFrames = 1'000'000;
constexpr double kMostStops = 64; // 2^64 is far beyond every picture, and finite

const std::string kCommonGroup = "Common options";
const std::string kMannersGroup = "Output";

void add_numbers(Verb& verb, Common& common) {
    verb.option("--size", "WxH", "picture size (512x512)",
                [&](const std::string& text) { common.size = parse_size("--size", text); });
    verb.option("--frames", "N", "measured frames, at least 1 (20)", [&](const std::string& text) {
        common.frames = static_cast<int>(parse_whole("--frames", text, 1, kMostFrames));
    });
    verb.option("--warmup", "N", "frames before them, not measured (8)",
                [&](const std::string& text) {
                    common.warmup = static_cast<int>(parse_whole("--warmup", text, 0, kMostFrames));
                });
    verb.option("--time", "SECONDS", "instant of the scene's motion (0)",
                [&](const std::string& text) { common.time = parse_real("--time", text); });
    verb.flag("--animate", "frame k at --time + (k-1)/60 s; otherwise all frames at --time",
              common.animate);
    verb.option("--seed", "N",
                "of --camera seeded and of sample patterns that are no regular grid (1)",
                [&](const std::string& text) { common.seed = parse_seed("--seed", text); });
    verb.option("--ambient", "A", "ambient light, at least 0 (0.05)", [&](const std::string& text) {
        common.ambient = parse_real("--ambient", text, 0);
    });
    add_exposure(verb, common.exposure);
}

void take_model(const std::string& text) {
    const bool everything = parse_choice("--model", text, {"everything", "required"}) == 0;
    check(everything, Failure::usage,
          "--model required: is not there yet; this version renders 'everything'");
}

void add_choices(Verb& verb, Common& common) {
    verb.option("--root", "DIR",
                "the files that SCENE names may lie below DIR too (below the scene's own folder)",
                [&](const std::string& text) {
                    check(!text.empty(), Failure::usage, "--root: wanted a folder, found ''");
                    common.root = text;
                });
    verb.option(
        "--camera", "C",
        "name, index from 0, EX,EY,EZ:TX,TY,TZ:FOV, or seeded: drawn from --seed, a mirror in "
        "view (the file's first)",
        [&](const std::string& text) { common.camera = text; });
    verb.option("--model", "M",
                "everything: each mirror, six faces, every frame. required: not there yet",
                take_model);
    verb.option("--reference", "T", "technique that compare judges against (raytrace:depth=16)",
                [&](const std::string& text) {
                    const app::TechniqueChoice choice = app::parse_technique(text);
                    check(choice.technique != "plan", Failure::usage,
                          "--reference: wanted one technique for all mirrors, found '", text, "'");
                    common.reference = choice.label;
                });
    verb.option("--device", "D",
                "index from 0 or part of a name, see 'list devices' (the fastest kind)",
                [&](const std::string& text) { common.device = text; });
    verb.option(
        "--timing", "T",
        "isolated: times of passes add up. pipelined: passes may overlap (isolated)",
        [&](const std::string& text) {
            const bool isolated = parse_choice("--timing", text, {"isolated", "pipelined"}) == 0;
            common.timing = isolated ? app::Timing::isolated : app::Timing::pipelined;
        });
    verb.flag("--validate", "watched by the Vulkan validation layer; any message fails the run",
              common.validate);
}

std::string camera_list(const scene::Scene& scene) {
    constexpr std::size_t kMostListed = 20;
    const std::size_t count = scene.cameras.size();
    std::string list;
    for (std::size_t i = 0; i < std::min(count, kMostListed); ++i)
        list += (i ? ", " : "") + std::to_string(i) + " " + in_quotes(scene.cameras[i].name);
    if (count > kMostListed) list += " and " + std::to_string(count - kMostListed) + " more";
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

void add_exposure(Verb& verb, double& exposure) {
    verb.option("--exposure", "STOPS", "brightness of PNG, HTML and FLIP: times 2^STOPS (0)",
                [&](const std::string& text) {
                    exposure = parse_real("--exposure", text, -kMostStops, kMostStops);
                });
}

void add_manners(Verb& verb, Manners& manners) {
    verb.heading(kMannersGroup);
    verb.flag("--json", "one JSON document on stdout instead of text", manners.json);
    verb.flag("-q,--quiet", "no progress and no information on stderr", manners.quiet);
    verb.flag("-v,--verbose", "more information on stderr", manners.verbose);
    verb.option("--progress", "WHEN", "auto: on a terminal; always; never (auto)",
                [&](const std::string& text) {
                    manners.progress = static_cast<ProgressMode>(
                        parse_choice("--progress", text, {"auto", "always", "never"}));
                });
}

void add_common(Verb& verb, Common& common) {
    verb.argument("SCENE",
                  "built-in name (see 'list scenes') or .glb, .gltf or .obj file (cornell-mirrors)",
                  common.scene, Verb::Need::optional);
    verb.heading(kCommonGroup);
    add_numbers(verb, common);
    add_choices(verb, common);
    add_manners(verb, common.manners);
}

void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what) {
    check(given, Failure::usage, "'", verb, "' needs ", option, ": ", what);
}

app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check) {
    app::Request request;
    request.seed = common.seed;
    double load_ms = 0;
    {
        const Stopwatch watch(load_ms);
        request.scene = scene::load(common.scene, {.root = common.root});
    }
    request.load_ms = load_ms;
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

app::EngineOptions engine_options(const std::string& device, bool validate) {
    return {.device = device, .validate = validate, .cache = app::cache_folder()};
}

void introduce(const app::Engine& engine, const Manners& manners) {
    detail(manners, "device: " + engine.device().name + ", " + engine.device().driver);
    if (!engine.warning().empty()) warn(engine.warning());
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
