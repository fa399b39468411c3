#pragma once

#include "study/choose_judge.hpp"

#include <optional>
#include <string>
#include <vector>

// The search of a choice: it finds the plans that are worth a proof.
namespace catoptric::study {

using namespace session;

/// Judges the candidates of the request in the own view and in the training views, and mixes
/// techniques by mirror. Returns the plans to prove, from the slowest to the fastest; none if no
/// plan keeps the limits. Sets `candidates`, with `why` for all that need no proof, and the noise
/// of the last training views.
std::vector<std::string> find_plans_to_prove(const ResolvedRequest& request,
                                             std::vector<JudgedPlan>& candidates,
                                             std::optional<ViewNoise>& noise);

} // namespace catoptric::study
