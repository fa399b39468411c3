#pragma once

#include "command_line.hpp"
#include "output.hpp"
#include "scene/budget_for.hpp"
#include "scene/file_options.hpp"
#include "scene/load.hpp"
#include "session/resolved_scene.hpp"
#include "session/run.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::cli {

/// The device to open, and how to open it.
struct DeviceAsked {
    std::string name;      ///< index or part of a name; empty: the fastest kind of device
    std::string profile;   ///< a file, or kNoProfile; empty: the user's profile, if any
    bool validate = false; ///< opens the device with the validation layer
};
/// Name that selects default settings in place of the user's profile.
inline constexpr const char* kNoProfile = "none";

/// The options that all rendering verbs share. The help states the same defaults.
struct Common {
    Manners manners;
    std::string scene = "cornell-mirrors";
    scene::BudgetOverride budget; ///< limits for loading the scene
    std::string root; ///< folder in which files of the scene may lie as well; empty: none
    uvec2 size{512, 512};
    std::optional<int> frames; ///< default: 20
    std::optional<int> warmup; ///< default: 8
    double time = 0;
    bool animate = false;
    std::uint64_t seed = 1;
    scene::SceneOverrides
        overrides; ///< scene overrides: mirrors, lights, environment, camera, exposure ...
    bool use_scene_file = true;
    std::string reference = "raytrace:depth=16";
    DeviceAsked device;
    std::optional<app::Modelling> model; ///< none: default of the verb
    bool both_models = false;            ///< `compare` only: measures each row with both models
    double budget_ms = 0;                ///< time for captures per frame, milliseconds; 0: no limit
    app::Timing timing = app::Timing::isolated;
};

/// Headings of the help, after kCommonOptions.
inline constexpr const char* kMeasuringOptions = "Frames, times and errors";
inline constexpr const char* kDeviceOptions = "Device";

/// Adds --json, --quiet, -v and --progress.
void add_manners(Verb& verb, Manners& manners);
/// Adds SCENE, all common options, and the options of `add_manners`. `common` must outlive the
/// parsing.
void add_common(Verb& verb, Common& common);
/// Adds all common options without SCENE, and the options of `add_manners`.
void add_common_without_scene(Verb& verb, Common& common);
/// Adds the scene overrides under their own heading: --root to --no-scene-file.
void add_scene_overrides(Verb& verb, Common& common);
/// Adds --device and --device-profile. `device` must outlive the parsing.
void add_device(Verb& verb, DeviceAsked& device);
/// Adds --validate.
void add_validate(Verb& verb, DeviceAsked& device);
/// Adds --size, --camera, --exposure, --time and --seed.
void add_view(Verb& verb, Common& common);
/// Adds --camera and --exposure.
void add_camera(Verb& verb, Common& common);
/// Returns the options for loading the scene.
scene::FileOptions load_options(const Common& common);
/// Returns an exposure in stops, from -64 to 64. Throws `usage` for other text.
double parse_stops(const std::string& text);

/// Adds --budget-ms.
void add_budget(Verb& verb, Common& common);
/// Throws `usage` for a capture budget with --model everything, which draws all captures.
void check_budget(const Common& common);

/// Throws `usage` with the message that `verb` needs `option`, unless `given`.
void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what);

/// Throws `usage` if the list of --techniques contains a scene. The option takes all words that
/// follow it.
void check_no_scene(const std::vector<std::string>& techniques);

/// Returns the request to the engine, without techniques: scene, camera and numbers. Messages of
/// the loader and additions to the scene go to stderr. `check`, if given, may refuse the scene
/// before any other message. Without it, a scene without a mirror causes a warning.
app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check = {});
/// A request, with the resolved scene from which it was made.
struct Asked {
    app::Request request;
    app::ResolvedScene wanted; ///< without its scene, which is in `request`
};
Asked make_asked(const Common& common, const std::function<void(const scene::Scene&)>& check = {});
app::EngineOptions engine_options(const DeviceAsked& device);
/// Prints the device and the engine's warnings to stderr.
void introduce(const app::Engine& engine, const Manners& manners);

} // namespace catoptric::cli
