#pragma once

#include "app/run.hpp"
#include "command_line.hpp"
#include "output.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace catoptric::cli {

/// The options that the verbs which render share; their defaults are here and in the help.
struct Common {
    Manners manners;
    std::string scene = "cornell-mirrors";
    std::string root; ///< files of the scene may lie below it too; empty: none
    uvec2 size{512, 512};
    std::optional<int> frames; ///< 20 unless the user says otherwise
    std::optional<int> warmup; ///< 8
    double time = 0;
    bool animate = false;
    std::string camera; ///< resolved when the scene is there; empty = its first
    std::uint64_t seed = 1;
    double ambient = 0.05;
    double exposure = 0;
    std::string reference = "raytrace:depth=16";
    std::string device;
    app::Timing timing = app::Timing::isolated;
    bool validate = false;
};

/// --json --quiet -v --progress.
void add_manners(Verb& verb, Manners& manners);
/// SCENE, every common option, and `add_manners`. `common` must outlive the parsing.
void add_common(Verb& verb, Common& common);
void add_exposure(Verb& verb, double& exposure);

/// Throws `usage` saying that `verb` needs `option`, unless it was given.
void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what);

/// Scene, camera and numbers as the engine takes them, without techniques. What the loader had to
/// say and which camera stands in for a missing one goes to stderr.
/// `check`, where given, refuses the scene before anything else is said of it.
app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check = {});
app::EngineOptions engine_options(const std::string& device, bool validate);
/// The device, and what the engine warns of, on stderr.
void introduce(const app::Engine& engine, const Manners& manners);

/// The camera that the user named: a name, an index from 0, or "EX,EY,EZ:TX,TY,TZ:FOV".
scene::Camera parse_camera(const std::string& text, const scene::Scene& scene);

} // namespace catoptric::cli
