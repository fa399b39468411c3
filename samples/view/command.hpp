#pragma once

#include "state.hpp"

#include <string>
#include <vector>

namespace catoptric::view {

/// Returns the command that renders the same picture without a window, "catoptric render ...",
/// ready to paste into a shell. `words` is the view's own command line without the program's name.
/// Its options for loading the scene are kept. `camera` is text that --camera takes.
std::string render_command(const std::vector<std::string>& words, const ViewState& state,
                           const std::string& camera, uvec2 size);
/// Returns the words of this command, without "catoptric".
std::vector<std::string> render_words(const std::vector<std::string>& words, const ViewState& state,
                                      const std::string& camera, uvec2 size);

/// Returns the word in single quotes if a shell would interpret it.
std::string quote_for_shell(const std::string& word);

} // namespace catoptric::view
