#pragma once

#include "compare.hpp"
#include "measure/comparison.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// Functions that choose the cheapest plan within a limit of error, or the plan with the least error
// within a limit of time. The choice is proved on other views than those on which it was made.
namespace catoptric::study {

using namespace session;

/// Returns "flip" or "rmse".
const char* quantity_name(ErrorQuantity quantity);

/// Returns the error of a view, from the difference of the pictures over the mirrors: 0 if the view
/// shows no mirror, and infinite if any mirror pixel is not finite. Against a reference with noise,
/// it is a bound that includes the noise (measure::flip_bound and rmse_bound).
double mirror_error(ErrorQuantity quantity, const measure::Difference& mirrors);
/// Returns the same error, but against a reference with noise a bound that it is not below.
double lower_mirror_error(ErrorQuantity quantity, const measure::Difference& mirrors);

/// The noise of the references of drawn views: the errors between their halves over the mirrors.
struct ViewNoise {
    double median_floor = 0, largest_floor = 0;
    std::optional<double> wanted_floor; ///< a fifth of the limit of error; none without a limit
    std::size_t views_above = 0;        ///< views whose floor is above the wanted one
};

/// A plan with its cost and its errors over views.
struct JudgedPlan {
    std::string text; ///< text for Request::techniques, such as "secant" or "1=reuse 2,3=secant"
    double ms = 0;    ///< median time of a frame, or the predicted time
    /// 95 % interval of a measured time; of a predicted time, the times by the least and the
    /// largest cost of each kind of work.
    measure::Interval ms_range;
    std::vector<double> errors; ///< mirror_error of each drawn view
    double largest_error = 0;   ///< largest of `errors`; without any, the error in the own view
    /// Of `auto`: the plan that it drew in the comparison's own view, such as "raytrace" or
    /// "1=planar 2,3=secant". Empty for other plans.
    std::string drawn = {};
    /// Why it was not chosen, or "chosen", or that it comes nearest: a clause.
    std::string why = {};
};

/// Returns the time of a plan in milliseconds with its range, such as "3.1 [2.9 - 3.4]".
std::string format_time_range(const JudgedPlan& plan);

/// Whether a time keeps a limit. A predicted time may keep it at best.
enum class TimeVerdict : std::uint8_t { keeps, may_keep, breaks };

/// The result of testing a plan on the proof views.
struct PlanProof {
    JudgedPlan plan;
    std::size_t failures = 0; ///< views above the limit of error; 0 without a limit
    /// measure::passing_share_bound of the failures. With noise, it is lowered for the failures
    /// that the noise may hide (measure::kNoiseMissProbability).
    double share_bound = 0;
    /// Error that the share `share` of all views does not exceed, with confidence `confidence`
    /// (measure::upper_tolerance_limit).
    double error_bound = 0;
    bool keeps_error = false; ///< the share is proved, or there is no limit of error
    /// A measured time keeps the limit if the upper end of its interval does. Without a limit, any
    /// time keeps it.
    TimeVerdict time = TimeVerdict::breaks;
    bool holds() const { return keeps_error && time == TimeVerdict::keeps; }
    /// Returns whether the plan may be chosen.
    bool may_hold() const { return keeps_error && time != TimeVerdict::breaks; }
    std::string device;     ///< whose times decide, with " (predicted)" if costs predict them
    std::string scene_hash; ///< hash of the scene whose views were drawn
    double exposure = 0;    ///< stops
    std::optional<ViewNoise> noise; ///< of the proof views; none: the reference has no noise
};

struct PlanChoice {
    std::vector<JudgedPlan> candidates; ///< all, and the mix of techniques if one was tried
    /// Plans in the order of their test, from the slowest. The order is fixed before the proof's
    /// views are drawn. A plan counts only if all before it keep the limit of error, so none of the
    /// tests lowers the confidence of another (fixed-sequence testing; Maurer, Hothorn, Lehmacher,
    /// Multiple Comparisons in Drug Clinical Trials and Preclinical Assays, 1995). The list ends
    /// with the first plan that does not keep the limit of error.
    std::vector<PlanProof> proofs;
    std::optional<std::size_t> chosen;  ///< index into `proofs`: the last plan that may hold
    std::optional<std::size_t> nearest; ///< index into `proofs` if no plan was chosen
    std::string failure;                ///< why no plan was chosen, a sentence; empty if one was
};

/// Chooses a plan in five steps. First, all candidates are measured in the comparison's own view,
/// and a candidate is dropped if another is faster and errs less by a wide margin. Second, the
/// remaining candidates are drawn in the first training views. Third, a mix of techniques by mirror
/// is computed from their errors (measure::find_fastest_mix). Fourth, the plans that keep
/// the limits, and the mix, are drawn in the other training views. Fifth, up to four plans and the
/// mix are tested on fresh views (measure/proof_order.hpp). If no plan keeps the limits in the
/// training views, the nearest plan is tested alone. Throws `usage` for limits out of range, and
/// what `compare` throws. Each step with drawn views takes one comparison.
PlanChoice choose_plan(Engine& engine, const ChooseRequest& request);

/// Returns a comparison of plans with the reference, in the comparison's own view and in `views`
/// views drawn from `seed`, of which `cameras_per_instant` neighbours share an instant. `views` 0:
/// only the own view.
using PlanComparer = std::function<measure::Comparison(
    const std::vector<std::string>& plans, int views, std::uint64_t seed, int cameras_per_instant)>;

/// Chooses a plan in the same way from the comparisons that a function returns, for example of
/// recorded views, which makes many choices affordable. Throws `usage` if
/// `request.base.techniques` is empty, and as above.
PlanChoice choose_plan(const ChooseRequest& request, const PlanComparer& compare_plans);

/// Proves one plan on fresh views: the last step of choose_plan.
PlanProof prove_plan(Engine& engine, const ChooseRequest& request, const std::string& plan);

} // namespace catoptric::study
