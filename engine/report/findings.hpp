#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

// Sentences drawn from the figures; plain text. Each is there only when the rows it speaks of are.
namespace catoptric::report {

/// What the run says; of the seed report's statements about its Table 1 and figures 5 and 7 where
/// it is of that report's scene.
std::vector<std::string> findings(const Comparison& comparison);
std::string findings_title(const Comparison& comparison);

/// Returns one sentence that names the device and says whether ray tracing beats the other rows on
/// it; of rows of one kind alone, which is the fastest and which the closest.
std::string verdict_in_words(const Comparison& comparison);

/// The Pareto front in words: the rows on it, and who beats each of the others.
std::vector<std::string> front_in_words(const Comparison& comparison);

} // namespace catoptric::report
