#pragma once

#include "compare.hpp"
#include "measure/comparison.hpp"
#include "measure/costs.hpp"
#include "study/choose.hpp"
#include "study/compare_to_target.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

// Functions that judge the plans of a choice in drawn views.
namespace catoptric::study {

using namespace session;

/// A request to choose a plan, together with the contents of the files that the request names, and
/// where its comparisons come from.
struct ResolvedRequest : ChooseRequest {
    ResolvedRequest(const ChooseRequest& request, PlanComparer comparer);
    /// Tells the caller about the next step, a sentence.
    void tell_step(const std::string& sentence) const {
        if (tell) tell(sentence);
    }
    PlanComparer compare_plans;
    std::optional<measure::DeviceCosts> device_costs; ///< read from `costs`
};

/// Training views that all candidates are drawn in. Only plans that keep the limits there are drawn
/// in the other training views.
inline constexpr int kFirstTrainingViews = 12;

/// By default, a plan that breaks the limit of error in more than the allowed share of views shows
/// it in one of them, with the requested confidence.
int count_training_views(const ChooseRequest& request);
/// Returns the least number of proof views that can prove the share, and that `compare` accepts.
int min_proof_views(const ChooseRequest& request);
int count_proof_views(const ChooseRequest& request);
/// Returns the seed of the training views after the first kFirstTrainingViews.
std::uint64_t further_training_seed(const ChooseRequest& request);

/// Returns the plan of these mirrors as a text for --plan, or the technique that draws them all.
std::string describe_drawn_plan(const std::vector<PlanEntry>& entries);
/// Returns the plans of a comparison's rows, with their times and their errors in drawn views.
std::vector<JudgedPlan> judged_plans(const ResolvedRequest& request,
                                     const measure::Comparison& comparison,
                                     const std::vector<std::string>& texts);
/// Returns the error of the pixels that are finite, including the noise of the reference.
double error_value(ErrorQuantity quantity, const measure::Difference& error);

TimeVerdict judge_time(const ResolvedRequest& request, const JudgedPlan& plan);
/// Returns whether the plan keeps the limit of error in each of its views.
bool keeps_error(const ResolvedRequest& request, const JudgedPlan& plan);
/// Returns the number of the plan's views above the limit of error; 0 without a limit.
std::size_t count_failures(const ResolvedRequest& request, const JudgedPlan& plan);

/// Returns a clause such as "takes 8.1 [7.9 - 8.3] ms, above 4".
std::string describe_broken_time(const ResolvedRequest& request, const JudgedPlan& plan);

/// Marks candidates that another candidate beats by a wide margin in time and error in the
/// comparison's own view, and those that cannot be used: sets their `why`.
void drop_beaten_plans(const ResolvedRequest& request, const measure::Comparison& comparison,
                       std::vector<JudgedPlan>& plans);
/// Returns the plans without `why` that keep the limits and that no other such plan beats, in order
/// from the smallest error to the shortest time. A plan is beaten by a plan that errs less and does
/// not take more time. Sets `why` of all others.
std::vector<JudgedPlan*> unbeaten_plans(const ResolvedRequest& request,
                                        std::vector<JudgedPlan>& plans);
/// Returns the plan that exceeds its limits by the smallest factor, among those with errors in as
/// many views as any; null without plans.
JudgedPlan* find_nearest_plan(const ResolvedRequest& request, std::vector<JudgedPlan>& plans);

// How the noise of a reference enters a certificate (docs/choose.md).

/// Share of the limit of error that the noise floor of a reference should not exceed.
inline constexpr double kNoiseShareOfLimit = .2;

/// Returns the noise floor that the references of drawn views should reach; none without a limit of
/// error.
std::optional<NoiseFloorTarget> find_noise_target(const ChooseRequest& request);

/// Returns the probability with which noise hides that a view is above the limit of error; 0 for
/// references without noise.
double noise_miss_probability(const ChooseRequest& request);

/// Returns the share of views that must be seen to keep the limit, so that the requested share
/// keeps it. If noise hides a share m of the failures, a failing share f is seen as (1 - m) f or
/// more.
double share_to_prove(const ChooseRequest& request);

/// Returns the noise of the drawn views of a comparison; none if its reference has no noise, or if
/// no view shows a mirror.
std::optional<ViewNoise> find_view_noise(const ChooseRequest& request,
                                         const measure::Comparison& comparison);

/// Returns a clause such as "noise floor of the reference: median 0.004, at most 0.007, wanted 0.01
/// (0 views above)".
std::string describe_noise(const ViewNoise& noise);

/// Returns a clause for the reason why no plan was chosen, or nothing if the noise is small.
std::string describe_noise_cause(const std::optional<ViewNoise>& noise);

} // namespace catoptric::study
