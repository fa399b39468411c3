#pragma once

#include "compare.hpp"
#include "options.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

struct CompareWords {
    study::CompareRequest request; ///< names its rows, also if the words name none
    DeviceOptions device;
};

/// Parses the words of a `catoptric compare` command, which are a scene and options, and loads the
/// scene. Returns the request that the command would run. Throws the same errors as `compare`.
/// Throws `usage` for several scenes, and for options such as --help that end the program.
CompareWords parse_compare_words(std::vector<std::string> words);

std::vector<CompletionOption> compare_options();

} // namespace catoptric::cli
