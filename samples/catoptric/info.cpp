// catoptric info: describes a scene, or the program's version, device and features.
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/text.hpp"
#include "import/load.hpp"
#include "import/scene_file.hpp"
#include "json.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "scene/built_in.hpp"
#include "scene_text.hpp"
#include "session/calibration.hpp"
#include "session/engine.hpp"
#include "session/exposure.hpp"
#include "session/lanes.hpp"
#include "session/scene_info.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace catoptric::cli {

namespace {

constexpr const char* kInfoExamples = R"(Examples:
  catoptric info --json
  catoptric info room.glb
  catoptric info room.glb --mirror 'wall mirror' --write)";

ProgramInfo gather_info(const DeviceOptions& device) {
    ProgramInfo facts;
    try {
        session::EngineOptions options = engine_options(device);
        options.cache.clear(); // `info` compiles no shaders
        const session::Engine engine(options);
        facts.device = engine.device();
        facts.lanes = session::count_lanes(engine);
        facts.balance = session::describe_balance(engine);
        if (const std::string text = session::vector_width_warning(engine); !text.empty())
            print_warning(text);
        if (!facts.device->warning.empty()) print_warning(facts.device->warning);
    } catch (const Error& error) {
        if (error.failure != Failure::no_device) throw;
        facts.why_no_device = error.what();
    }
    std::vector<std::string> techniques, scenes;
    for (const session::TechniqueInfo& technique : session::techniques())
        techniques.push_back(technique.name);
    for (const scene::BuiltInScene& scene : scene::built_in_scenes()) scenes.push_back(scene.name);
    facts.features = {{"techniques", techniques},
                      {"scenes", scenes},
                      {"scene_files", {"glb", "gltf", "obj"}},
                      {"picture_files", {"exr", "hdr", "png"}},
                      {"models", {"everything", "required"}},
                      {"timings", {"isolated", "pipelined"}}};
    return facts;
}

std::string format_info(const ProgramInfo& facts) {
    std::string text = fmt::format("catoptric {} ({})\n", session::version(), session::commit());
    if (facts.device) {
        const session::DeviceInfo& device = *facts.device;
        const std::string threads = device.threads > 0 ? fmt::format(", {} threads", device.threads)
                                                       : "";
        text += fmt::format("{:<14} {} ({}, Vulkan {}, {}{})\n", "device", device.name, device.type,
                            device.api, device.driver, threads);
        text += fmt::format("{:<14} {} of 32 bits run together\n", "lanes", facts.lanes);
        text += fmt::format("{:<14} {}\n", "profile",
                            device.profile.empty() ? "none" : device.profile);
        text += fmt::format("{:<14} {}\n", "calibration",
                            device.calibration.empty()
                                ? "none: 'bench --calibrate' measures this device"
                                : device.calibration);
        if (!facts.balance.empty()) text += fmt::format("{:<14} {}\n", "balance", facts.balance);
        for (const auto& [name, choice] : device.variants)
            text += fmt::format("{:<14} {}\n", "  " + name, choice);
    } else {
        text += fmt::format("{:<14} none: {}\n", "device", facts.why_no_device);
    }
    for (const auto& [group, names] : facts.features)
        text += fmt::format("{:<14} {}\n", group, join_with_commas(names));
    return text;
}

struct InfoOptions {
    CommonOptions common; ///< without a scene, `info` describes the program
    bool writes = false, replaces = false;
};

/// Returns the exposure that the scene is shown with, in stops; none if no device can measure it.
/// Moves the scene out of the request.
std::optional<double> shown_exposure(session::Request& request, const InfoOptions& options) {
    if (!request.auto_exposure) return request.exposure;
    constexpr std::size_t kMaxExposureTriangles =
        500'000; // building a BVH over more costs as much as a picture
    if (const std::size_t count = scene::triangle_count(request.scene);
        count > kMaxExposureTriangles) {
        print_note(options.common.output_options,
                   fmt::format("exposure not told: wanted at most {} triangles, "
                               "found {}; render chooses it",
                               kMaxExposureTriangles, count));
        return std::nullopt;
    }
    try {
        session::Engine engine(engine_options(options.common.device));
        print_device(engine, options.common.output_options);
        session::Session session(engine, std::move(request.scene));
        return session::measure_exposure(session, request);
    } catch (const Error& error) {
        if (error.failure != Failure::no_device) throw;
        print_note(options.common.output_options,
                   std::string("exposure not told: ") + error.what());
        return std::nullopt;
    }
}

/// Writes the overrides that the user gave, and the values that were added, to the scene's file.
void write_scene_file(const InfoOptions& options, const session::ResolvedScene& wanted,
                      const session::Request& request) {
    const scene::Scene& scene = request.scene;
    check(wanted.is_file, Failure::usage,
          "--write: wanted a scene's file, beside which to write, found the built-in ",
          quote(scene.name));
    const std::filesystem::path path = scene::scene_file_path(options.common.scene);
    std::error_code error;
    check(options.replaces ||
              !std::filesystem::exists(std::filesystem::symlink_status(path, error)),
          Failure::cannot_create, path.string(), ": is there already; --force replaces it");
    scene::SceneOverrides overrides = wanted.overrides;
    if (!overrides.environment)
        overrides.environment = scene.environment && scene.environment->studio ? "studio" : "none";
    if (wanted.is_camera_seeded)
        overrides.camera = request.camera.name; // the name holds the camera's numbers
    write_file(path, scene::scene_file_text(overrides, options.common.scene));
    print_note(options.common.output_options, "written: " + path.string());
}

int print_scene_info(const InfoOptions& options) {
    ResolvedRequest asked = resolve_request(options.common);
    session::Request& request = asked.request;
    if (options.writes) write_scene_file(options, asked.wanted, request);
    SceneInfoFacts words{.info = session::make_scene_info(request)};
    words.warnings = request.scene.warnings;
    words.auto_exposure = request.auto_exposure;
    words.exposure = shown_exposure(request, options); // moves the scene away
    words.ambient = request.ambient;
    if (asked.wanted.scene_file) words.scene_file = asked.wanted.scene_file->string();
    print_result(options.common.output_options.json ? scene_json(words) : format_scene_info(words));
    return 0;
}

int run_info(const InfoOptions& options) {
    check(options.writes || !options.replaces, Failure::usage, "--force: wanted --write beside it");
    if (!options.common.scene.empty()) return print_scene_info(options);
    check(!options.writes, Failure::usage, "--write: wanted a SCENE");
    const ProgramInfo facts = gather_info(options.common.device);
    print_result(options.common.output_options.json ? info_json(facts) : format_info(facts));
    return 0;
}

} // namespace

void add_info_verb(CommandLine& program) {
    const auto options = std::make_shared<InfoOptions>();
    options->common.scene.clear();
    Verb& verb = program.add_verb("info",
                                  "print the contents of a scene, or version, device and features");
    verb.examples(kInfoExamples);
    verb.argument(
        "SCENE",
        "built-in scene or .glb, .gltf or .obj file; without SCENE: information on program and "
        "device",
        options->common.scene, Verb::Need::optional);
    verb.flag("--write", "store the given scene options in SCENE.catoptric.json", options->writes);
    verb.flag("--force", "let --write replace an existing file", options->replaces);
    add_device_options(verb, options->common.device);
    add_view_options(verb, options->common);
    add_override_options(verb, options->common);
    add_output_options(verb, options->common.output_options);
    verb.action([options] { return run_info(*options); });
}

} // namespace catoptric::cli
