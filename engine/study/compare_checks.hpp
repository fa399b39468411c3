#pragma once

#include "compare.hpp"

#include <string>
#include <vector>

// The rows that a comparison measures if none are named, and the checks of a request.
namespace catoptric::study {

using namespace session;

/// Returns the rows that each technique of the table proposes (reflect::Technique::compared), and
/// `auto`. Leaves out rows that fit no mirror of the scene as `base` shows it.
std::vector<std::string> default_techniques(const Request& base);
/// Throws `bad_data` if the scene has no mirror. The message says how to make one.
void check_has_mirror(const scene::Scene& scene);

/// Throws `usage` if the rounds are too few for a confidence interval of the median.
void check_round_limit(int rounds);
/// Throws `usage` for unknown rows, and for two rows with the same settings.
void check_techniques(const std::vector<std::string>& techniques);

/// Applies all checks above. Also refuses plans that do not fit the mirrors, and rows that are
/// asked for in both models and in one frame.
void check_compare_request(const CompareRequest& request);
/// Reads every file that the comparison reads, and runs all checks that it makes before its first
/// frame: check_compare_request, certificates of plans, the file of the reference, and the checks
/// of the studies. `request` names its rows and its reference.
void check_inputs(const CompareRequest& request);

} // namespace catoptric::study
