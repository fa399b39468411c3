#include "study/choose_judge.hpp"

#include "core/error.hpp"
#include "measure/certificate.hpp"
#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "measure/statistics.hpp"
#include "report/costs.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "study/reference_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::study {

namespace {

/// Returns the time of a plan that costs predict, with the range of the unit costs, or of a fit's
/// errors. The range is unknown if the file of the costs has neither.
measure::Interval find_predicted_range(const measure::DeviceCosts& costs,
                                       const measure::PredictedTime& time) {
    if (time.low < time.high) return {time.low, time.high};
    const measure::Interval ratios = measure::prediction_error(costs);
    if (!ratios.is_known()) return {};
    return {time.ms * ratios.low, time.ms * ratios.high};
}

/// Returns whether one plan takes less time than another. The interval of a measured time must end
/// before the other interval. Predicted times are compared without their ranges, because both
/// ranges have the same unknown unit costs.
bool takes_less_time(const ResolvedRequest& request, const JudgedPlan& a, const JudgedPlan& b) {
    const bool known = !request.device_costs && a.ms_range.is_known() && b.ms_range.is_known();
    return known ? a.ms_range.high < b.ms_range.low : a.ms < b.ms;
}

std::string describe_broken_error(const ResolvedRequest& request, const JudgedPlan& plan) {
    return fmt::format("{} above {:g} in {} of {} training views", quantity_name(request.quantity),
                       request.max_error.value_or(0), count_failures(request, plan),
                       plan.errors.size());
}

/// Returns whether no further measurement is likely to bring the time below its limit.
bool is_surely_too_slow(const ResolvedRequest& request, const JudgedPlan& plan) {
    const bool known = !request.device_costs && plan.ms_range.is_known();
    return request.max_ms && (known ? plan.ms_range.low : plan.ms) > *request.max_ms;
}

/// Returns the factor by which a value exceeds a limit: infinite above a limit of 0.
double excess(double value, double limit) {
    return limit > 0 ? value / limit : value > 0 ? INFINITY : 0;
}

double find_excess(const ResolvedRequest& request, const JudgedPlan& plan) {
    double factor = 0;
    if (request.max_error) factor = excess(plan.largest_error, *request.max_error);
    if (request.max_ms) factor = std::max(factor, excess(plan.ms, *request.max_ms));
    return factor;
}

} // namespace

ResolvedRequest::ResolvedRequest(const ChooseRequest& request, PlanComparer comparer)
    : ChooseRequest(request), compare_plans(std::move(comparer)) {
    if (!costs.empty()) device_costs = report::read_costs_file(costs);
}

std::string format_time_range(const JudgedPlan& plan) {
    std::string text = fmt::format("{:.3g}", plan.ms);
    if (plan.ms_range.low < plan.ms_range.high)
        text += fmt::format(" [{:.3g} - {:.3g}]", plan.ms_range.low, plan.ms_range.high);
    return text;
}

int min_proof_views(const ChooseRequest& request) {
    return static_cast<int>(
        std::max(measure::needed_views(share_to_prove(request), request.confidence, 0),
                 measure::kMinIntervalSamples));
}

int count_proof_views(const ChooseRequest& request) {
    return request.proof_views > 0 ? request.proof_views : min_proof_views(request);
}

int count_training_views(const ChooseRequest& request) {
    return request.training_views > 0 ? request.training_views : min_proof_views(request);
}

std::uint64_t further_training_seed(const ChooseRequest& request) {
    constexpr std::uint64_t kAboveTypedSeeds = std::uint64_t{1} << 40;
    return request.base.seed + kAboveTypedSeeds;
}

double error_value(ErrorQuantity quantity, const measure::Difference& error) {
    return quantity == ErrorQuantity::flip ? measure::flip_bound(error)
                                           : measure::rmse_bound(error);
}

std::string describe_drawn_plan(const std::vector<PlanEntry>& entries) {
    std::vector<std::pair<std::string, std::string>> parts; // technique, numbers of its mirrors
    for (const PlanEntry& entry : entries) {
        const std::string technique = report::format_technique(entry);
        const auto known = std::ranges::find(parts, technique,
                                             [](auto& part) { return part.first; });
        if (known == parts.end())
            parts.emplace_back(technique, std::to_string(entry.mirror));
        else
            known->second += "," + std::to_string(entry.mirror);
    }
    if (parts.size() == 1) return parts.front().first;
    std::vector<std::string> texts;
    for (const auto& [technique, mirrors] : parts) texts.push_back(mirrors + "=" + technique);
    return report::join_texts(texts, " ");
}

std::vector<JudgedPlan> judged_plans(const ResolvedRequest& request,
                                     const measure::Comparison& comparison,
                                     const std::vector<std::string>& texts) {
    std::vector<measure::PredictedTime> predicted;
    if (request.device_costs)
        predicted = measure::predict_front(*request.device_costs, comparison.rows).times;
    std::vector<JudgedPlan> plans;
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const measure::Row& row = comparison.rows[i];
        JudgedPlan plan{.text = texts[i],
                        .ms = row.time_ms().median,
                        .ms_range = row.time_ms().ci95,
                        .errors = {}};
        if (request.device_costs) {
            plan.ms = predicted[i].ms;
            plan.ms_range = find_predicted_range(*request.device_costs, predicted[i]);
        }
        if (plan.text == "auto") plan.drawn = describe_drawn_plan(row.plan);
        for (const measure::Errors& errors : row.views)
            plan.errors.push_back(mirror_error(request.quantity, errors.error));
        plan.largest_error = plan.errors.empty() ? error_value(request.quantity, row.error)
                                                 : std::ranges::max(plan.errors);
        plans.push_back(std::move(plan));
    }
    return plans;
}

TimeVerdict judge_time(const ResolvedRequest& request, const JudgedPlan& plan) {
    if (!request.max_ms) return TimeVerdict::keeps;
    if (request.device_costs)
        return plan.ms <= *request.max_ms ? TimeVerdict::may_keep : TimeVerdict::breaks;
    const double ms = plan.ms_range.is_known() ? plan.ms_range.high : plan.ms;
    return ms <= *request.max_ms ? TimeVerdict::keeps : TimeVerdict::breaks;
}

std::size_t count_failures(const ResolvedRequest& request, const JudgedPlan& plan) {
    if (!request.max_error) return 0;
    return static_cast<std::size_t>(std::ranges::count_if(
        plan.errors, [&](double error) { return !(error <= *request.max_error); }));
}

bool keeps_error(const ResolvedRequest& request, const JudgedPlan& plan) {
    return count_failures(request, plan) == 0;
}

std::string describe_broken_time(const ResolvedRequest& request, const JudgedPlan& plan) {
    return fmt::format("{} {} ms, above {:g}", request.device_costs ? "predicted" : "takes",
                       format_time_range(plan), request.max_ms.value_or(0));
}

void drop_beaten_plans(const ResolvedRequest& request, const measure::Comparison& comparison,
                       std::vector<JudgedPlan>& plans) {
    constexpr double kMargin = 1.5; // ratio of times and errors in the own view that counts as a
                                    // wide margin
    for (std::size_t i = 0; i < plans.size(); ++i)
        if (!measure::is_rankable(comparison.rows[i]) || std::isnan(plans[i].largest_error)) {
            plans[i].largest_error = NAN;
            plans[i].why = "shows no reflections that can be judged";
        }
    for (JudgedPlan& plan : plans) {
        if (!plan.why.empty()) continue;
        const auto better = std::ranges::find_if(plans, [&](const JudgedPlan& other) {
            return plan.ms > kMargin * other.ms &&
                   plan.largest_error > kMargin * other.largest_error;
        });
        if (better != plans.end())
            plan.why = fmt::format(
                "{} is {:.3g} times as fast and has a smaller {} in the own view", better->text,
                plan.ms / better->ms, quantity_name(request.quantity));
        // With a limit of error, a technique that is too slow alone may still draw a mirror of a
        // mix.
        else if (!request.max_error && is_surely_too_slow(request, plan))
            plan.why = describe_broken_time(request, plan);
    }
}

std::vector<JudgedPlan*> unbeaten_plans(const ResolvedRequest& request,
                                        std::vector<JudgedPlan>& plans) {
    std::vector<JudgedPlan*> kept;
    for (JudgedPlan& plan : plans) {
        if (!plan.why.empty()) continue;
        if (!keeps_error(request, plan))
            plan.why = describe_broken_error(request, plan);
        else if (judge_time(request, plan) == TimeVerdict::breaks)
            plan.why = describe_broken_time(request, plan);
        else
            kept.push_back(&plan);
    }
    std::ranges::stable_sort(kept, [](const JudgedPlan* a, const JudgedPlan* b) {
        return a->largest_error != b->largest_error ? a->largest_error < b->largest_error
                                                    : a->ms < b->ms;
    });
    std::vector<JudgedPlan*> unbeaten;
    for (JudgedPlan* plan : kept) { // plans earlier in the list err less
        const auto surer = std::ranges::find_if(unbeaten, [&](const JudgedPlan* other) {
            return !takes_less_time(request, *plan, *other);
        });
        if (surer == unbeaten.end())
            unbeaten.push_back(plan);
        else
            plan->why = fmt::format("{} errs no more and takes no more time", (*surer)->text);
    }
    return unbeaten;
}

JudgedPlan* find_nearest_plan(const ResolvedRequest& request, std::vector<JudgedPlan>& plans) {
    std::size_t views = 0;
    for (const JudgedPlan& plan : plans) views = std::max(views, plan.errors.size());
    const auto measure_distance = [&](const JudgedPlan& plan) {
        return std::pair(find_excess(request, plan),
                         request.max_error ? plan.largest_error : plan.ms);
    };
    JudgedPlan* nearest = nullptr;
    for (JudgedPlan& plan : plans)
        if (plan.errors.size() == views && !std::isnan(plan.largest_error) &&
            (nearest == nullptr || measure_distance(plan) < measure_distance(*nearest)))
            nearest = &plan;
    return nearest;
}

double noise_miss_probability(const ChooseRequest& request) {
    const scene::Scene& scene = request.base.scene;
    return is_noisy(choose_reference(request.reference, scene), scene)
               ? measure::kNoiseMissProbability
               : 0;
}

double share_to_prove(const ChooseRequest& request) {
    return 1 - (1 - request.share) * (1 - noise_miss_probability(request));
}

std::optional<NoiseFloorTarget> find_noise_target(const ChooseRequest& request) {
    if (!request.max_error) return {};
    return NoiseFloorTarget{request.quantity, kNoiseShareOfLimit * *request.max_error};
}

std::optional<ViewNoise> find_view_noise(const ChooseRequest& request,
                                         const measure::Comparison& comparison) {
    if (!comparison.noise) return {};
    std::vector<double> floors = comparison.noise->view_floors;
    std::erase_if(floors, [](double floor) { return std::isnan(floor); }); // no mirror is seen
    if (floors.empty()) return {};
    ViewNoise noise{.median_floor = measure::percentile(floors, .5),
                    .largest_floor = std::ranges::max(floors),
                    .wanted_floor = {}};
    if (const std::optional<NoiseFloorTarget> target = find_noise_target(request)) {
        noise.wanted_floor = target->floor;
        noise.views_above = static_cast<std::size_t>(
            std::ranges::count_if(floors, [&](double floor) { return floor > target->floor; }));
    }
    return noise;
}

std::string describe_noise_cause(const std::optional<ViewNoise>& noise) {
    if (!noise || noise->views_above == 0) return "";
    return fmt::format("; errors include the {}, which more --reference-seconds lower",
                       describe_noise(*noise));
}

std::string describe_noise(const ViewNoise& noise) {
    std::string text = fmt::format("noise floor of the reference: median {:.3g}, at most {:.3g}",
                                   noise.median_floor, noise.largest_floor);
    if (noise.wanted_floor)
        text += fmt::format(", wanted {:.3g} ({} views above)", *noise.wanted_floor,
                            noise.views_above);
    return text;
}

} // namespace catoptric::study
