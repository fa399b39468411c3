#pragma once

#include "report/json.hpp"
#include "study/choose.hpp"

#include <string>

// Functions that write the file of a chosen plan, schema "catoptric/plan/1" (docs/choose.md).
namespace catoptric::study {

using namespace session;

/// Returns the file of a choice. Without a chosen plan, the file has the nearest plan with a
/// certificate of what it proves, and `nearest` has the limits that it breaks, and the reason.
/// `scene` is how the user names the scene.
report::Json choice_json(const ChooseRequest& request, const PlanChoice& choice,
                         const std::string& scene);
/// Returns the file of a plan that was tested alone. Its `certificate` is named `not_proved` if the
/// plan does not hold. `plan`: its text in Request::techniques; a file that it names must exist.
report::Json proved_plan_json(const ChooseRequest& request, const std::string& plan,
                              const PlanProof& proof, const std::string& scene);
/// Returns one sentence with the result of testing a plan on the proof views.
std::string describe_proof(const ChooseRequest& request, const PlanProof& proof);
/// Returns one sentence with what the nearest plan proves instead of the requested limits.
std::string describe_nearest_proof(const ChooseRequest& request, const PlanProof& proof);
/// Returns "holds", "does not hold", or "may hold" with the range of a predicted time.
std::string describe_verdict(const ChooseRequest& request, const PlanProof& proof);

} // namespace catoptric::study
