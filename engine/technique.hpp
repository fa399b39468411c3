#pragma once

#include "core/export.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Adds a program's own techniques. Add them while the program starts, or before it makes its first
/// Engine, because no lock protects the tables.
namespace catoptric::session {

/// One build of a shader as SPIR-V: "NAME", or "NAME#BUILD". catoptric_shader() of the CMake
/// package writes these. Names and words must live as long as the program.
struct Shader {
    std::string_view name;
    std::span<const std::uint32_t> words;
};
/// Meant as a namespace-scope object. Throws `usage` for a name that is taken. Nobody can catch
/// this at namespace scope, and the program ends. Therefore give files names of their own.
struct RegisteredShaders {
    CATOPTRIC_API explicit RegisteredShaders(std::span<const Shader> builds);
};

/// A numeric knob of a search. Its shader reads the value as the specialisation constant of the
/// same name.
struct SearchKnob {
    std::string name, help;
    double low = 0, high = 1, value = 0; ///< value: the default
    bool is_real = false;                ///< the constant is a float; false: a uint
};

/// A technique that looks reflections up in the mirrors' captures (colour and distance), with its
/// own fragment shader. docs/library.md lists what the shader defines and may call. The technique
/// has the knobs of `secant` in addition to its own: face, colour, distance, range, lookup, show,
/// shadow and shadow_map. In captures, mirrors are drawn as `parallax` draws them.
struct Search {
    std::string name;    ///< name that users type: small letters, digits and '_'
    std::string summary; ///< one sentence for lists and reports
    int order = 1000;    ///< place in lists and reports; between equals by name
    std::string shader;  ///< name that catoptric_shader() gave it
    std::vector<SearchKnob> knobs;
    /// Whether the shader defines CONTINUE. If so, the search also has the knobs continue, captures
    /// and mirrors, which do nothing otherwise.
    bool continues = false;
    /// Its rows in a comparison without named rows; empty: its name alone.
    std::vector<std::string> compared;
};

/// Adds the search to the table of techniques. From then on it can be named like any technique.
/// Throws `usage` for an invalid or taken name, and for rows of other techniques. Throws `usage`
/// for knobs that are out of their range, not whole where they must be, or whose name is taken.
CATOPTRIC_API void add_search(Search search);
/// Meant as a namespace-scope object.
struct RegisteredSearch {
    explicit RegisteredSearch(Search search) { add_search(std::move(search)); }
};

} // namespace catoptric::session
