#pragma once

#include "study/choose_judge.hpp"

#include <string>
#include <vector>

// Functions that mix techniques by mirror (measure/plan_mix.hpp).
namespace catoptric::study {

using namespace session;

/// Returns the cheapest mix of several techniques that keeps the limit of error in the training
/// views, as a plan; empty if there is none. Row n of `training` belongs to plan n. Candidates that
/// are plans themselves take no part.
std::string find_fastest_mixed_plan(const ResolvedRequest& request,
                                    const measure::Comparison& training,
                                    const std::vector<JudgedPlan>& plans);
/// Measures two plans side by side in the own view, and returns whether the second is faster. Sets
/// its time and error.
bool is_second_faster(const ResolvedRequest& request, const std::string& first, JudgedPlan& second);

} // namespace catoptric::study
