#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace catoptric::session {

/// Returns options that make mirrors of a scene's smoothest surfaces, ready for a shell: "--mirror
/// 'NAME'". Returns at most `most` options, the smoothest surface first and, between equals, the
/// largest first. Each option names other surfaces than those before it.
std::vector<std::string> suggest_mirror_options(const scene::Scene& scene, std::size_t most = 5);

/// Returns the text as a word for a POSIX shell, in single quotes.
std::string quote_for_shell(const std::string& text);

} // namespace catoptric::session
