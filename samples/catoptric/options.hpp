#pragma once

#include "app/resolved_scene.hpp"
#include "app/run.hpp"
#include "command_line.hpp"
#include "output.hpp"
#include "scene/budget_for.hpp"
#include "scene/load.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::cli {

/// Which device, and how it is opened.
struct DeviceAsked {
    std::string name;      ///< index or part of a name; empty: the fastest kind
    std::string profile;   ///< a file, or kNoProfile; empty: the user's own, if any
    bool validate = false; ///< watched by the validation layer
};
/// All as by default, whatever the user's profile says.
inline constexpr const char* kNoProfile = "none";

/// The options that the verbs which render share; their defaults are here and in the help.
struct Common {
    Manners manners;
    std::string scene = "cornell-mirrors";
    scene::BudgetOverride budget; ///< of the scene
    std::string root;             ///< files of the scene may lie below it too; empty: none
    uvec2 size{512, 512};
    std::optional<int> frames; ///< 20 unless the user says otherwise
    std::optional<int> warmup; ///< 8
    double time = 0;
    bool animate = false;
    std::uint64_t seed = 1;
    scene::SceneOverrides
        overrides; ///< of the scene: mirrors, lights, environment, camera, exposure ...
    bool use_scene_file = true;
    std::string reference = "raytrace:depth=16";
    DeviceAsked device;
    std::optional<app::Modelling> model; ///< none: the verb's own
    bool both_models = false;            ///< of compare: each row with both
    double budget_ms = 0;                ///< of captures in a frame; 0: no limit
    app::Timing timing = app::Timing::isolated;
};

/// Headings of the help, beside kCommonOptions.
inline constexpr const char* kMeasuringOptions = "Frames, times and errors";
inline constexpr const char* kDeviceOptions = "Device";

/// --json --quiet -v --progress.
void add_manners(Verb& verb, Manners& manners);
/// SCENE, every common option, and `add_manners`. `common` must outlive the parsing.
void add_common(Verb& verb, Common& common);
/// Every common option but SCENE, and `add_manners`.
void add_common_without_scene(Verb& verb, Common& common);
/// The options that say what the scene is, under a heading: --root to --no-scene-file.
void add_scene_overrides(Verb& verb, Common& common);
/// --device and --device-profile; `device` must outlive the parsing.
void add_device(Verb& verb, DeviceAsked& device);
/// --validate.
void add_validate(Verb& verb, DeviceAsked& device);
/// --size, --camera, --exposure, --time and --seed.
void add_view(Verb& verb, Common& common);
/// --camera and --exposure.
void add_camera(Verb& verb, Common& common);
/// How the scene is loaded.
scene::LoadOptions load_options(const Common& common);
/// -64 to 64.
double parse_stops(const std::string& text);

/// --budget-ms.
void add_budget(Verb& verb, Common& common);
/// Throws `usage` for a budget with --model everything, which draws all.
void check_budget(const Common& common);

/// Throws `usage` saying that `verb` needs `option`, unless it was given.
void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what);

/// Throws `usage` for a scene in the list of --techniques, which takes every word that follows it.
void check_no_scene(const std::vector<std::string>& techniques);

/// Scene, camera and numbers as the engine takes them, without techniques. What the loader had to
/// say and what was added goes to stderr.
/// `check`, where given, refuses the scene before anything else is said of it; else one without a
/// mirror is warned of.
app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check = {});
/// The same with what it was made from.
struct Asked {
    app::Request request;
    app::ResolvedScene wanted; ///< without its scene, which the request has
};
Asked make_asked(const Common& common, const std::function<void(const scene::Scene&)>& check = {});
app::EngineOptions engine_options(const DeviceAsked& device);
/// The device, and what the engine warns of, on stderr.
void introduce(const app::Engine& engine, const Manners& manners);

} // namespace catoptric::cli
