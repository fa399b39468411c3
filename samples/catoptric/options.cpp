#include "options.hpp"

#include "session/lanes.hpp"

#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "core/text.hpp"
#include "import/file_options.hpp"
#include "import/load.hpp"
#include "parse.hpp"
#include "scene/built_in.hpp"
#include "session/candidates.hpp"
#include "session/folders.hpp"
#include "session/seeded_camera.hpp"
#include "session/technique_choice.hpp"
#include "study/compare_checks.hpp"

#include <algorithm>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kMaxFrameCount = 1'000'000;

/// Reads N, or A..B if the verb takes a range.
void parse_frames(const std::string& text, CommonOptions& common) {
    const auto parse_number = [](const std::string& number, int low) {
        return static_cast<int>(parse_integer("--frames", number, low, kMaxFrameCount));
    };
    const std::size_t dots = text.find("..");
    common.first_frame = 1;
    if (!common.takes_frame_range || dots == std::string::npos) {
        common.frames = parse_number(text, 1);
        return;
    }
    common.first_frame = parse_number(text.substr(0, dots), 1);
    const int last = parse_number(text.substr(dots + 2), common.first_frame);
    common.frames = last - common.first_frame + 1;
}

void add_number_options(Verb& verb, CommonOptions& common) {
    verb.heading(kMeasuringOptions);
    verb.option(
        "--frames", common.takes_frame_range ? "N|A..B" : "N",
        common.takes_frame_range
            ? "number of measured frames, at least 1 (20), or the first and the last of them"
            : "number of measured frames, at least 1 (20)",
        [&](const std::string& text) { parse_frames(text, common); });
    verb.option("--warmup", "N",
                "frames before the measured ones (8; 28 with compare --model required or both)",
                [&](const std::string& text) {
                    common.warmup = static_cast<int>(
                        parse_integer("--warmup", text, 0, kMaxFrameCount));
                });
    verb.flag(
        "--animate",
        "move the scene: frame k shows --time + (k-1)/60 s; without it all frames show --time",
        common.animate);
}

void parse_model(const std::string& text, CommonOptions& common) {
    const std::size_t choice = parse_choice("--model", text, {"everything", "required", "both"});
    common.both_models = choice == 2;
    common.model = choice == 1 ? session::RenderedWork::required
                               : session::RenderedWork::everything;
}

void add_choice_options(Verb& verb, CommonOptions& common) {
    verb.option("--model", "M",
                "everything: draw all captures in each frame; required: draw only what the picture "
                "requires (default of render); both: compare shows both (everything)",
                [&](const std::string& text) { parse_model(text, common); });
    verb.option(
        "--reference", "T",
        "technique of the reference picture of compare (raytrace:depth=16, with rays=64 if a "
        "mirror is rough), or FILE.exr that stores a reference with noise",
        [&](const std::string& text) {
            if (text.ends_with(".exr")) {
                common.reference_file = text;
                return;
            }
            common.reference = parse_reference(text);
        });
    verb.option(
        "--timing", "T",
        "isolated: passes run one after the other, so their times add up; pipelined: passes may "
        "overlap (isolated)",
        [&](const std::string& text) {
            const bool isolated = parse_choice("--timing", text, {"isolated", "pipelined"}) == 0;
            common.timing = isolated ? session::PassTimingMode::isolated
                                     : session::PassTimingMode::pipelined;
        });
}

scene::Camera choose_camera(const CommonOptions& common, session::ResolvedScene& wanted) {
    if (wanted.is_camera_seeded) {
        scene::Camera camera = session::make_seeded_camera(wanted.scene, common.time.value_or(0),
                                                           common.seed);
        print_note(common.output_options,
                   "camera drawn from seed " + std::to_string(common.seed) + ": " + camera.name);
        return camera;
    }
    return session::choose_camera(wanted, double(common.size.x) / double(common.size.y));
}

/// Warns of a scene without a mirror, with options that add one.
void warn_of_no_mirror(const scene::Scene& scene) {
    if (!scene::mirrors(scene).empty()) return;
    const std::vector<std::string> options = session::suggest_mirror_options(scene, 1);
    print_warning("scene " + quote(scene.name) + " has no mirror" +
                  (options.empty() ? "" : "; try " + options.front()));
}

} // namespace

scene::FileOptions scene_file_options(const CommonOptions& common) {
    return {.root = common.root,
            .budget = scene::choose_budget(common.scene, common.budget, scene::read_free_memory())};
}

std::string parse_reference(const std::string& text) {
    const session::ParsedTechnique choice = parse_option(
        "--reference", [&] { return session::parse_technique(text); });
    check(choice.technique != "plan", Failure::usage,
          "--reference: wanted one technique for all mirrors, found '", text, "'");
    return choice.label;
}

double parse_stops(const std::string& text) {
    return parse_real("--exposure", text, -scene::kMaxExposureStops, scene::kMaxExposureStops);
}

void add_output_options(Verb& verb, OutputOptions& output_options) {
    verb.heading("Output");
    verb.flag("--json", "print one JSON document on stdout instead of text", output_options.json);
    verb.flag("-q,--quiet", "print no progress and no information on stderr", output_options.quiet);
    verb.flag("-v,--verbose", "print more information on stderr", output_options.verbose);
    verb.option("--progress", "WHEN",
                "when to show progress: auto (on a terminal), always or never (auto)",
                [&](const std::string& text) {
                    output_options.progress = static_cast<ProgressMode>(
                        parse_choice("--progress", text, {"auto", "always", "never"}));
                });
}

void add_device_options(Verb& verb, DeviceOptions& device) {
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

void add_validate_option(Verb& verb, DeviceOptions& device) {
    verb.heading(kDeviceOptions);
    verb.flag("--validate", "run with the Vulkan validation layer; any message fails the run",
              device.validate);
}

void add_view_options(Verb& verb, CommonOptions& common) {
    verb.heading(kCommonOptions);
    verb.option("--size", "WxH", "size of the picture in pixels (512x512)",
                [&](const std::string& text) {
                    common.size = parse_size("--size", text);
                    common.is_size_given = true;
                });
    add_camera_options(verb, common);
    verb.option("--time", "SECONDS", "instant of the scene's motion (0)",
                [&](const std::string& text) { common.time = parse_real("--time", text); });
    verb.option("--seed", "N", "seed of --camera seeded, --views and irregular sample patterns (1)",
                [&](const std::string& text) { common.seed = parse_seed("--seed", text); });
}

void add_budget_option(Verb& verb, CommonOptions& common) {
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

void check_budget_option(const CommonOptions& common) {
    check(common.budget_ms == 0 || common.model != session::RenderedWork::everything,
          Failure::usage,
          "--budget-ms and --model everything: wanted --model required, which keeps captures");
}

void add_sceneless_options(Verb& verb, CommonOptions& common) {
    add_view_options(verb, common);
    add_number_options(verb, common);
    add_choice_options(verb, common);
    add_override_options(verb, common);
    add_device_options(verb, common.device);
    add_validate_option(verb, common.device);
    add_output_options(verb, common.output_options);
}

void add_common_options(Verb& verb, CommonOptions& common) {
    verb.argument(
        "SCENE", "built-in scene (see 'list scenes') or .glb, .gltf or .obj file (cornell-mirrors)",
        common.scene, Verb::Need::optional);
    add_sceneless_options(verb, common);
}

void require_option(bool given, const std::string& verb, const std::string& option,
                    const std::string& what) {
    check(given, Failure::usage, "'", verb, "' needs ", option, ": ", what);
}

void check_techniques(const std::vector<std::string>& techniques) {
    for (const std::string& text : techniques) {
        bool scene = text.ends_with(".glb") || text.ends_with(".gltf") || text.ends_with(".obj");
        for (const scene::BuiltInScene& built_in : scene::built_in_scenes())
            scene |= built_in.name == text;
        check(!scene, Failure::usage, "--techniques: wanted a technique, found the scene '", text,
              "'; SCENE comes before --techniques");
    }
    parse_option("--techniques", [&] { study::check_techniques(techniques); });
}

ResolvedRequest resolve_request(const CommonOptions& common,
                                const std::function<void(const scene::Scene&)>& check) {
    ResolvedRequest asked;
    session::Request& request = asked.request;
    request.seed = common.seed;
    double load_ms = 0;
    {
        const Stopwatch watch(load_ms);
        asked.wanted = session::resolve_scene(common.scene,
                                              {.load = scene_file_options(common),
                                               .overrides = common.overrides,
                                               .use_scene_file = common.use_scene_file});
    }
    request.load_ms = load_ms;
    if (check) check(asked.wanted.scene);
    for (const std::string& warning : asked.wanted.scene.warnings) print_warning(warning);
    request.camera = choose_camera(common, asked.wanted);
    for (const std::string& sentence : asked.wanted.said)
        print_note(common.output_options, sentence);
    if (!check) warn_of_no_mirror(asked.wanted.scene);
    request.size = common.size;
    request.frames = common.frames.value_or(request.frames);
    request.warmup = common.warmup.value_or(request.warmup);
    request.time = common.time.value_or(0);
    request.animate = common.animate;
    request.ambient = session::choose_ambient(asked.wanted);
    const std::optional<double> exposure = session::find_exposure(asked.wanted);
    request.exposure = exposure.value_or(0);
    request.auto_exposure = !exposure;
    request.timing = common.timing;
    request.model = common.model.value_or(request.model);
    request.budget_ms = common.budget_ms;
    request.scene = std::move(asked.wanted.scene);
    return asked;
}

session::Request make_request(const CommonOptions& common,
                              const std::function<void(const scene::Scene&)>& check) {
    return resolve_request(common, check).request;
}

session::EngineOptions engine_options(const DeviceOptions& device) {
    const bool by_default = device.profile == kNoProfileName;
    return {.device = device.name,
            .validate = device.validate,
            .profile = by_default ? "" : device.profile,
            .profiles = by_default ? std::filesystem::path() : session::find_profile_folder(),
            .calibrations = by_default ? std::filesystem::path()
                                       : session::find_calibration_folder(),
            .cache = session::find_cache_folder()};
}

void print_device(const session::Engine& engine, const OutputOptions& output_options) {
    print_detail(output_options, "device: " + engine.device().name + ", " + engine.device().driver);
    if (!engine.warning().empty()) print_warning(engine.warning());
    if (const std::string text = session::vector_width_warning(engine); !text.empty())
        print_warning(text);
    if (!engine.device().warning.empty()) print_warning(engine.device().warning);
}

} // namespace catoptric::cli
