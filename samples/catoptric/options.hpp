#pragma once

#include "command_line.hpp"
#include "import/budget.hpp"
#include "import/file_options.hpp"
#include "import/load.hpp"
#include "output.hpp"
#include "session/resolved_scene.hpp"
#include "session/run.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::cli {

/// The device to open, and how to open it.
struct DeviceOptions {
    std::string name;      ///< index or part of a name; empty: the fastest kind of device
    std::string profile;   ///< a file, or kNoProfileName; empty: the user's profile, if any
    bool validate = false; ///< opens the device with the validation layer
};
/// Name that selects default settings in place of the user's profile.
inline constexpr const char* kNoProfileName = "none";

/// The options that all rendering verbs share. The help states the same defaults.
struct CommonOptions {
    OutputOptions output_options;
    std::string scene = "cornell-mirrors";
    scene::BudgetOverride budget; ///< limits for loading the scene
    std::string root; ///< folder in which files of the scene may lie as well; empty: none
    uvec2 size{512, 512};
    bool is_size_given = false;
    std::optional<int> frames;      ///< default: 20
    bool takes_frame_range = false; ///< whether --frames also takes A..B
    int first_frame = 1;            ///< A of --frames A..B; `frames` is then the number of them
    std::optional<int> warmup;      ///< default: 8
    std::optional<double> time;     ///< instant of the motion, seconds; none: 0
    bool animate = false;
    std::uint64_t seed = 1;
    scene::SceneOverrides
        overrides; ///< scene overrides: mirrors, lights, environment, camera, exposure ...
    bool use_scene_file = true;
    std::string reference_file; ///< file of the reference's halves; empty: none
    std::string reference;      ///< empty: study::choose_reference chooses
    DeviceOptions device;
    /// Model of the required work; none: default of the verb.
    std::optional<session::RenderedWork> model;
    bool both_models = false; ///< `compare` only: measures each row with both models
    double budget_ms = 0;     ///< time for captures per frame, milliseconds; 0: no limit
    session::PassTimingMode timing = session::PassTimingMode::isolated;
};

/// Headings of the help, after kCommonOptions.
inline constexpr const char* kMeasuringOptions = "Frames, times and errors";
inline constexpr const char* kDeviceOptions = "Device";

/// Adds --json, --quiet, -v and --progress.
void add_output_options(Verb& verb, OutputOptions& output_options);
/// Adds SCENE, all common options, and the options of `add_output_options`. `common` must outlive
/// the parsing.
void add_common_options(Verb& verb, CommonOptions& common);
/// Adds all common options without SCENE, and the options of `add_output_options`.
void add_sceneless_options(Verb& verb, CommonOptions& common);
/// Adds the scene overrides under their own heading: --root to --no-scene-file.
void add_override_options(Verb& verb, CommonOptions& common);
/// Adds --device and --device-profile. `device` must outlive the parsing.
void add_device_options(Verb& verb, DeviceOptions& device);
/// Adds --validate.
void add_validate_option(Verb& verb, DeviceOptions& device);
/// Adds --size, --camera, --exposure, --time and --seed.
void add_view_options(Verb& verb, CommonOptions& common);
/// Adds --camera and --exposure.
void add_camera_options(Verb& verb, CommonOptions& common);
/// Returns the options for loading the scene.
scene::FileOptions scene_file_options(const CommonOptions& common);
/// Returns the label of a technique that can be the reference. Throws `usage` for plans and unknown
/// techniques.
std::string parse_reference(const std::string& text);
/// Returns an exposure in stops, from -64 to 64. Throws `usage` for other text.
double parse_stops(const std::string& text);

/// Adds --budget-ms.
void add_budget_option(Verb& verb, CommonOptions& common);
/// Throws `usage` for a capture budget with --model everything, which draws all captures.
void check_budget_option(const CommonOptions& common);

/// Throws `usage` with the message that `verb` needs `option`, unless `given`.
void require_option(bool given, const std::string& verb, const std::string& option,
                    const std::string& what);

/// Throws `usage` if the list of --techniques contains a scene, because the option takes all words
/// that follow it. Also throws as study::check_techniques does.
void check_techniques(const std::vector<std::string>& techniques);

/// Returns the request to the engine, without techniques: scene, camera and numbers. Prints
/// messages of the loader, and parts that were added to the scene, to stderr. `check`, if given,
/// may refuse the scene before any other message. Without it, a scene without a mirror causes a
/// warning.
session::Request make_request(const CommonOptions& common,
                              const std::function<void(const scene::Scene&)>& check = {});
/// A request, with the resolved scene from which it was made.
struct ResolvedRequest {
    session::Request request;
    session::ResolvedScene wanted; ///< without its scene, which is in `request`
};
ResolvedRequest resolve_request(const CommonOptions& common,
                                const std::function<void(const scene::Scene&)>& check = {});
session::EngineOptions engine_options(const DeviceOptions& device);
/// Prints the device and the engine's warnings to stderr.
void print_device(const session::Engine& engine, const OutputOptions& output_options);

} // namespace catoptric::cli
