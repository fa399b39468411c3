#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace catoptric::app {

/// Options that make mirrors of a scene's smoothest surfaces, ready for a shell: "--mirror 'NAME'".
/// At most `most`, the smoothest first, of these the largest; each gives others than those before
/// it.
std::vector<std::string> mirror_options(const scene::Scene& scene, std::size_t most = 5);

/// A word for a POSIX shell, in single quotes.
std::string shell_word(const std::string& text);

} // namespace catoptric::app
