#pragma once

#include "../core/export.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Techniques that a program adds. All of it while the program starts, or before it makes its first
/// Engine: the tables are not guarded.
namespace catoptric::app {

/// One build of a shader as SPIR-V: "NAME", or "NAME#BUILD". What catoptric_shader() of the CMake
/// package writes; names and words must live as long as the program.
struct Shader {
    std::string_view name;
    std::span<const std::uint32_t> words;
};
/// A namespace-scope object makes the builds known. Throws `usage` for a name that is taken; at
/// namespace scope, where nobody can catch it, that ends the program, so give files names of their
/// own.
struct RegisteredShaders {
    CATOPTRIC_API explicit RegisteredShaders(std::span<const Shader> builds);
};

/// One number of a search, which its shader reads as the specialisation constant of the same name.
struct SearchKnob {
    std::string name, help;
    double low = 0, high = 1, value = 0; ///< value: the default
    bool is_real = false;                ///< the constant is a float, else a uint
};

/// A technique that looks reflections up in the mirrors' captures, colour and distance, with a
/// fragment shader of its own (docs/library.md has what that defines and may call). It has
/// `secant`'s knobs beside its own: face, colour, distance, range, lookup, show, shadow and
/// shadow_map. In captures, mirrors are drawn as `parallax` has it.
struct Search {
    std::string name;    ///< small letters, digits and '_', as it is asked for
    std::string summary; ///< one sentence for lists and reports
    int order = 1000;    ///< place in these; then by name
    std::string shader;  ///< as catoptric_shader() has named it
    std::vector<SearchKnob> knobs;
    /// The shader defines CONTINUE: the search has the knobs continue, captures and mirrors, too,
    /// which without that would do nothing.
    bool continues = false;
    std::vector<std::string> compared; ///< its rows where nobody says which; empty: its name alone
};

/// Puts the search into the table of techniques: wherever one may be named it may be from then on.
/// Throws `usage` for a name that is no such word or is taken, for knobs that are not within their
/// range, not whole where they must be or have a name that is taken, and for rows of others.
CATOPTRIC_API void add_search(Search search);
/// The same as a namespace-scope object.
struct RegisteredSearch {
    explicit RegisteredSearch(Search search) { add_search(std::move(search)); }
};

} // namespace catoptric::app
