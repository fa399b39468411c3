#pragma once

#include "app/engine.hpp"
#include "output.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace catoptric::cli {

/// The options that the verbs which render share; their defaults are here and in the help.
struct Common {
    Manners manners;
    std::string scene = "cornell-mirrors";
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
void add_manners(CLI::App& verb, Manners& manners);
/// SCENE, every common option, and `add_manners`. `common` must outlive the parsing.
void add_common(CLI::App& verb, Common& common);
void add_exposure(CLI::App& verb, double& exposure);

/// Adds an option whose text goes through `take` while parsing.
CLI::Option* add_text(CLI::App& verb, const std::string& name, const std::string& type,
                      const std::string& help, std::function<void(const std::string&)> take);

/// Throws `usage` for an option or argument that the verb does not have, naming the nearest.
void refuse_extras(const CLI::App& verb);
/// Throws `usage` saying that `verb` needs `option`, unless it was given.
void require_given(bool given, const std::string& verb, const std::string& option,
                   const std::string& what);

/// Scene, camera and numbers as the engine takes them, without techniques. What the loader had to
/// say and which camera stands in for a missing one goes to stderr.
/// `check`, where given, refuses the scene before anything else is said of it.
app::Request make_request(const Common& common,
                          const std::function<void(const scene::Scene&)>& check = {});
app::EngineOptions engine_options(const Common& common);

/// The camera that the user named: a name, an index from 0, or "EX,EY,EZ:TX,TY,TZ:FOV".
scene::Camera parse_camera(const std::string& text, const scene::Scene& scene);

} // namespace catoptric::cli
