#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

// Plain-text sentences that the metrics support. A sentence is left out if the comparison lacks the
// rows it needs.
namespace catoptric::report {

/// Returns the findings of a run. For the seed report's scene they include its statements about its
/// Table 1 and figures 5 and 7.
std::vector<std::string> findings(const Comparison& comparison);
std::string findings_title(const Comparison& comparison);

/// Returns one sentence that names the device and says whether ray tracing beats the other rows on
/// it. If all rows are of one kind, it names the fastest and the closest row.
std::string verdict_in_words(const Comparison& comparison);

/// Returns the Pareto front in words: the rows on it, and which row beats each of the others.
std::vector<std::string> front_in_words(const Comparison& comparison);

} // namespace catoptric::report
