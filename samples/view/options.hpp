#pragma once

#include "catoptric/drawn.hpp"
#include "catoptric/options.hpp"

#include <string>
#include <vector>

namespace catoptric::view {

/// What the command line says.
struct Options {
    cli::Common common;
    cli::Drawn drawn;
    std::string technique; ///< as app::FrameSpec::techniques takes it
    std::string screenshot;
    std::vector<std::string> words; ///< all of it, without the program's name
};

/// `catoptric-view WORDS...`: what is to be done, which may be printing help. Throws `usage`, and
/// `cannot_create` for a screenshot that cannot be written.
std::function<int()> parse(const std::vector<std::string>& words,
                           const std::function<int(const Options&)>& run);

/// The scene and its first frame.
cli::Asked ask(const Options& options);

} // namespace catoptric::view
