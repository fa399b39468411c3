#pragma once

#include "state.hpp"

#include <string>
#include <vector>

namespace catoptric::view {

/// The command that renders the same picture without a window: "catoptric render ...", to be pasted
/// into a shell. `words`: of the view's own command line without the program's name, of which what
/// says how the scene is read stays; `camera`: as --camera takes it.
std::string render_command(const std::vector<std::string>& words, const State& state,
                           const std::string& camera, uvec2 size);
/// Its words, without "catoptric".
std::vector<std::string> render_words(const std::vector<std::string>& words, const State& state,
                                      const std::string& camera, uvec2 size);

/// In single quotes where a shell would read more into it.
std::string quoted(const std::string& word);

} // namespace catoptric::view
