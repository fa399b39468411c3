#include "options.hpp"

#include "session/lanes.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/stopwatch.hpp"
#include "core/text.hpp"
#include "parse.hpp"
#include "scene/built_in.hpp"
#include "scene/file_options.hpp"
#include "scene/load.hpp"
#include "session/candidates.hpp"
#include "session/folders.hpp"
#include "session/seeded_camera.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kMostFrames = 1'000'000;

void add_numbers(Verb& verb, Common& common) {
    verb.heading(kMeasuringOptions);
    verb.option("--frames", "N", "number of measured frames, at least 1 (20)",
                [&](const std::string& text) {
                    common.frames = static_cast<int>(parse_whole("--frames", text, 1, kMostFrames));
                });
    verb.option("--warmup", "N",
                "frames before the measured ones (8; 28 with compare --model required or both)",
                [&](const std::string& text) {
                    common.warmup = static_cast<int>(parse_whole("--warmup", text, 0, kMostFrames));
                });
    verb.flag(
        "--animate",
        "move the scene: frame k shows --time + (k-1)/60 s; without it all frames show --time",
        common.animate);
}

void take_model(const std::string& text, Common& common) {
    const std::size_t choice = parse_choice("--model", text, {"everything", "required", "both"});
    common.both_models = choice == 2;
    common.model = choice == 1 ? app::Modelling::required : app::Modelling::everything;
}

void add_choices(Verb& verb, Common& common) {
    verb.option("--model", "M",
                "everything: draw all captures in each frame; required: draw only what the picture "
                "requires (default of render); both: compare shows both (everything)",
                [&](const std::string& text) { take_model(text, common); });
    verb.option("--reference", "T",
                "technique of the reference picture of compare (raytrace:depth=16)",
                [&](const std::string& text) {
                    const app::TechniqueChoice choice = app::parse_technique(text);
                    check(choice.technique != "plan", Failure::usage,
                          "--reference: wanted one technique for all mirrors, found '", text, "'");
                    common.reference = choice.label;
                });
    verb.option(
        "--timing", "T",
        "isolated: passes run one after the other, so their times add up; pipelined: passes may "
        "overlap (isolated)",
        [&](const std::string& text) {
            const bool isolated = parse_choice("--timing", text, {"isolated", "pipelined"}) == 0;
            common.timing = isolated ? app::Timing::isolated : app::Timing::pipelined;
        });
}

scene::Camera choose_camera(const Common& common, app::ResolvedScene& wanted) {
    if (wanted.is_camera_seeded) {
        scene::Camera camera = app::seeded_camera(wanted.scene, common.time, common.seed);
        note(common.manners,
             "camera drawn from seed " + std::to_string(common.seed) + ": " + camera.name);
        return camera;
    }
    return app::camera_of(wanted, double(common.size.x) / double(common.size.y));
}

/// Warns of a scene without a mirror, with options that add one.
void warn_of_no_mirror(const scene::Scene& scene) {
    if (!scene::mirrors(scene).empty()) return;
    const std::vector<std::string> options = app::mirror_options(scene, 1);
    warn("scene " + in_quotes(scene.name) + " has no mirror" +
         (options.empty() ? "" : "; try " + options.front()));
}

} // namespace

scene::FileOptions load_options(const Common& common) {
    return {.root = common.root,
            .budget = scene::budget_for(common.scene, common.budget, scene::free_memory())};
}

double parse_stops(const std::string& text) {
    return parse_real("--exposure", text, -scene::kMostStops, scene::kMostStops);
}

void add_manners(Verb& verb, Manners& manners) {
    verb.heading("Output");
    verb.flag("--json", "print one JSON document on stdout instead of text", manners.json);
    verb.flag("-q,--quiet", "print no progress and no information on stderr", manners.quiet);
    verb.flag("-v,--verbose", "print more information on stderr", manners.verbose);
    verb.option("--progress", "WHEN",
                "when to show progress: auto (on a terminal), always or never (auto)",
                [&](const std::string& text) {
                    manners.progress = static_cast<ProgressMode>(
                        parse_choice("--progress", text, {"auto", "always", "never"}));
                });
}

void add_device(Verb& verb, DeviceAsked& device) {
    verb.heading(kDeviceOptions);
    verb.option(
        "--device", "D",
        "Vulkan device: index from 0 or part of its name, see 'list devices' (the fastest kind)",
        device.name);
    verb.option(
        "--device-profile", "FILE",
        "file with tuned shader settings, written by 'bench --tune'; none: default settings (the "
        "device's file in the user's configuration)",
        device.profile);
}

void add_validate(Verb& verb, DeviceAsked& device) {
    verb.heading(kDeviceOptions);
    verb.flag("--validate", "run with the Vulkan validation layer; any message fails the run",
              device.validate);
}

void add_view(Verb& verb, Common& common) {
    verb.heading(kCommonOptions);
    verb.option("--size", "WxH", "size of the picture in pixels (512x512)",
                [&](const std::string& text) { common.size = parse_size("--size", text); });
    add_camera(verb, common);
    verb.option("--time", "SECONDS", "instant of the scene's motion (0)",
                [&](const std::string& text) { common.time = parse_real("--time", text); });
    verb.option("--seed", "N", "seed of --camera seeded, --views and irregular sample patterns (1)",
                [&](const std::string& text) { common.seed = parse_seed("--seed", text); });
}

void add_budget(Verb& verb, Common& common) {
    verb.heading(kMeasuringOptions);
    verb.option(
        "--budget-ms", "MS",
        "limit for the time of captures per frame, in ms; at least one mirror is drawn, the others "
        "follow in later frames; needs --model required (no limit)",
        [&](const std::string& text) {
            common.budget_ms = parse_real("--budget-ms", text);
            check(common.budget_ms > 0, Failure::usage,
                  "--budget-ms: wanted a number above 0, found '", text, "'");
        });
}

void check_budget(const Common& common) {
    check(common.budget_ms == 0 || common.model != app::Modelling::everything, Failure::usage,
          "--budget-ms and --model everything: wanted --model required, which keeps captures");
}

void add_common_without_scene(Verb& verb, Common& common) {
    add_view(verb, common);
    add_numbers(verb, common);
    add_choices(verb, common);
    add_scene_overrides(verb, common);
    add_device(verb, common.device);
    add_validate(verb, common.device);
    add_manners(verb, common.manners);
}

void add_common(Verb& verb, Common& common) {
    verb.argument(
        "SCENE", "built-in scene (see 'list scenes') or .glb, .gltf or .obj file (cornell-mirrors)",
        common.scene, Verb::Need::optional);
    add_common_without_scene(verb, common);
}

void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what) {
    check(given, Failure::usage, "'", verb, "' needs ", option, ": ", what);
}

void check_no_scene(const std::vector<std::string>& techniques) {
    for (const std::string& text : techniques) {
        bool scene = text.ends_with(".glb") || text.ends_with(".gltf") || text.ends_with(".obj");
        for (const scene::BuiltIn& built_in : scene::built_in_scenes())
            scene |= built_in.name == text;
        check(!scene, Failure::usage, "--techniques: wanted a technique, found the scene '", text,
              "'; SCENE comes before --techniques");
    }
}

Asked make_asked(const Common& common, const std::function<void(const scene::Scene&)>& check) {
    Asked asked;
    app::Request& request = asked.request;
    request.seed = common.seed;
    double load_ms = 0;
    {
        const Stopwatch watch(load_ms);
        asked.wanted = app::resolve_scene(common.scene, {.load = load_options(common),
                                                         .overrides = common.overrides,
                                                         .use_scene_file = common.use_scene_file});
    }
    request.load_ms = load_ms;
    if (check) check(asked.wanted.scene);
    for (const std::string& warning : asked.wanted.scene.warnings) warn(warning);
    request.camera = choose_camera(common, asked.wanted);
    for (const std::string& sentence : asked.wanted.said) note(common.manners, sentence);
    if (!check) warn_of_no_mirror(asked.wanted.scene);
    request.size = common.size;
    request.frames = common.frames.value_or(request.frames);
    request.warmup = common.warmup.value_or(request.warmup);
    request.time = common.time;
    request.animate = common.animate;
    request.ambient = app::ambient_of(asked.wanted);
    const std::optional<double> exposure = app::exposure_of(asked.wanted);
    request.exposure = exposure.value_or(0);
    request.auto_exposure = !exposure;
    request.timing = common.timing;
    request.model = common.model.value_or(request.model);
    request.budget_ms = common.budget_ms;
    request.scene = std::move(asked.wanted.scene);
    return asked;
}

app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check) {
    return make_asked(common, check).request;
}

app::EngineOptions engine_options(const DeviceAsked& device) {
    const bool by_default = device.profile == kNoProfile;
    return {.device = device.name,
            .validate = device.validate,
            .profile = by_default ? "" : device.profile,
            .profiles = by_default ? std::filesystem::path() : app::profile_folder(),
            .cache = app::cache_folder()};
}

void introduce(const app::Engine& engine, const Manners& manners) {
    detail(manners, "device: " + engine.device().name + ", " + engine.device().driver);
    if (!engine.warning().empty()) warn(engine.warning());
    if (const std::string text = app::width_warning(engine); !text.empty()) warn(text);
    if (!engine.device().warning.empty()) warn(engine.device().warning);
}

} // namespace catoptric::cli
