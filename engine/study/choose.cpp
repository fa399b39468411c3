#include "study/choose.hpp"

#include "compare.hpp"
#include "core/error.hpp"
#include "measure/certificate.hpp"
#include "measure/costs.hpp"
#include "measure/findings.hpp"
#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "measure/plan_mix.hpp"
#include "measure/proof_order.hpp"
#include "report/costs.hpp"
#include "session/plan_file.hpp"
#include "session/watcher.hpp"
#include "study/choose_noise.hpp"
#include "study/compare_checks.hpp"
#include "study/compare_to_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace catoptric::app {

namespace {

/// A request to choose a plan, together with the contents of the files that the request names, and
/// where its comparisons come from.
struct ResolvedChooseRequest : ChooseRequest {
    ResolvedChooseRequest(const ChooseRequest& request, PlanComparer comparer)
        : ChooseRequest(request), compare_plans(std::move(comparer)) {
        if (!costs.empty()) device_costs = report::read_costs_file(costs);
    }
    PlanComparer compare_plans;
    std::optional<measure::DeviceCosts> device_costs; ///< read from `costs`
};

/// Returns the error of the pixels that are finite, including the noise of the reference.
double error_value_of_difference(ErrorQuantity quantity, const measure::Difference& error) {
    return quantity == ErrorQuantity::flip ? measure::find_flip_bound(error)
                                           : measure::find_rmse_bound(error);
}

/// Returns the number of proof views: the least number that can prove the share, and that `compare`
/// accepts.
int count_fewest_proof_views(const ResolvedChooseRequest& request) {
    return static_cast<int>(std::max(measure::count_views_needed_for_certificate(
                                         find_share_to_prove(request), request.confidence, 0),
                                     measure::kMinIntervalSamples));
}

/// Returns the number of fresh views in which plans are proved.
int find_proof_view_count(const ResolvedChooseRequest& request) {
    return request.proof_views > 0 ? request.proof_views : count_fewest_proof_views(request);
}

void check_choose_request(const ResolvedChooseRequest& request) {
    const auto check_part = [](const char* name, double value) {
        check(value > 0 && value < 1, Failure::usage, name,
              ": wanted a number between 0 and 1, found ", value);
    };
    check_part("share", request.share);
    check_part("confidence", request.confidence);
    check(request.max_error || request.max_ms, Failure::usage,
          "a limit is missing: wanted one of error or of time");
    check(!request.max_error || (*request.max_error >= 0 && *request.max_error <= 1),
          Failure::usage, "limit of error: wanted a number from 0 to 1, found ",
          request.max_error.value_or(0));
    check(!request.max_ms || (*request.max_ms >= 0 && std::isfinite(*request.max_ms)),
          Failure::usage, "limit of time: wanted milliseconds of at least 0, found ",
          request.max_ms.value_or(0));
    check(request.training_views >= static_cast<int>(measure::kMinIntervalSamples), Failure::usage,
          "training views: wanted at least ", measure::kMinIntervalSamples, ", found ",
          request.training_views);
    check(request.proof_seed != request.base.seed, Failure::usage,
          "seed of the proof: wanted another than that of the training views, found ",
          request.proof_seed);
    // A share above this value would need more proof views than any run draws.
    constexpr double kMaxPart = .9999;
    check(request.share <= kMaxPart && request.confidence <= kMaxPart, Failure::usage,
          "share and confidence: wanted at most ", kMaxPart, ", found ", request.share, " and ",
          request.confidence);
    const int needed = count_fewest_proof_views(request);
    check(request.proof_views == 0 || request.proof_views >= needed, Failure::usage,
          "views of the proof: wanted at least ", needed, ", since fewer cannot prove a share of ",
          request.share, " with a confidence of ", request.confidence, ", found ",
          request.proof_views);
}

void report_choose_step(const ResolvedChooseRequest& request, const std::string& sentence) {
    if (request.tell) request.tell(sentence);
}

/// Returns a function that compares plans by rendering them. The engine and the request must stay
/// valid as long as the function is used.
PlanComparer make_rendering_comparer(Engine& engine, const ChooseRequest& request) {
    return [&engine, &request](const std::vector<std::string>& plans, int views, std::uint64_t seed,
                               int cameras_per_instant) {
        CompareRequest compared;
        compared.base = request.base;
        compared.base.techniques = plans;
        compared.base.seed = seed;
        compared.reference = request.reference;
        compared.reference_seconds = request.reference_seconds;
        compared.watcher = request.watcher;
        compared.cameras_per_instant = cameras_per_instant;
        if (views > 0) compared.studies.push_back({"views", views});
        if (!request.costs.empty()) compared.studies.push_back({"work"});
        measure::Comparison comparison = compare_to_noise_target(engine, compared,
                                                                 find_noise_target(request));
        if (comparison.stopped) throw Error(*comparison.stopped);
        return comparison;
    };
}

std::vector<JudgedPlan> list_judged_plans(const ResolvedChooseRequest& request,
                                          const measure::Comparison& comparison,
                                          const std::vector<std::string>& texts) {
    std::vector<measure::PredictedTime> predicted;
    if (request.device_costs)
        predicted =
            measure::find_predicted_pareto_front(*request.device_costs, comparison.rows).times;
    std::vector<JudgedPlan> plans;
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const measure::Row& row = comparison.rows[i];
        JudgedPlan plan{.text = texts[i],
                        .ms = row.time_ms().median,
                        .ms_range = row.time_ms().ci95,
                        .errors = {}};
        if (request.device_costs)
            plan.ms = predicted[i].ms, plan.ms_range = {predicted[i].low, predicted[i].high};
        for (const measure::Errors& errors : row.views)
            plan.errors.push_back(mirror_error_of_view(request.quantity, errors.error));
        for (const double error : plan.errors)
            plan.largest_error = std::max(plan.largest_error, error);
        plans.push_back(std::move(plan));
    }
    return plans;
}

/// Returns whether the upper end of the plan's time, or its median without an interval, keeps the
/// limit of time.
bool keeps_time(const ResolvedChooseRequest& request, const JudgedPlan& plan) {
    if (!request.max_ms) return true;
    return (plan.ms_range.is_known() ? plan.ms_range.high : plan.ms) <= *request.max_ms;
}

bool keeps_error(const ResolvedChooseRequest& request, const JudgedPlan& plan) {
    return !request.max_error || plan.largest_error <= *request.max_error;
}

/// Returns the candidates to draw in the training views. A candidate is left out, and listed in
/// `dropped`, if another candidate beats it by a wide margin in time and error in the comparison's
/// own view.
std::vector<std::string> keep_plans_not_clearly_beaten(const ResolvedChooseRequest& request,
                                                       const measure::Comparison& comparison,
                                                       const std::vector<std::string>& texts,
                                                       std::vector<std::string>& dropped) {
    constexpr double kMargin = 1.5; // ratio of times and errors in the own view that counts as a
                                    // wide margin
    const std::vector<JudgedPlan> plans = list_judged_plans(request, comparison, texts);
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const double error = error_value_of_difference(request.quantity, comparison.rows[i].error);
        bool beaten = !measure::is_row_eligible_for_ranking(comparison.rows[i]) ||
                      std::isnan(error);
        for (std::size_t k = 0; k < plans.size() && !beaten; ++k)
            beaten = measure::is_row_eligible_for_ranking(comparison.rows[k]) &&
                     plans[i].ms > kMargin * plans[k].ms &&
                     error > kMargin * error_value_of_difference(request.quantity,
                                                                 comparison.rows[k].error);
        (beaten ? dropped : kept).push_back(texts[i]);
    }
    return kept;
}

/// Returns the text of a plan with one technique per mirror; empty if all mirrors have the same
/// technique.
std::string make_plan_text_from_technique_mix(const std::vector<std::string>& texts,
                                              const std::vector<std::size_t>& mix) {
    std::map<std::size_t, std::string> mirrors; // numbers of the mirrors of each technique
    for (std::size_t mirror = 0; mirror < mix.size(); ++mirror) {
        std::string& list = mirrors[mix[mirror]];
        list += (list.empty() ? "" : ",") + std::to_string(mirror + 1);
    }
    if (mirrors.size() < 2) return "";
    std::string text;
    for (const auto& [technique, list] : mirrors)
        text += (text.empty() ? "" : " ") + list + "=" + texts[technique];
    return text;
}

/// Returns the cheapest mix of several techniques that keeps the limit of error in the training
/// views, as a plan; empty if there is none. Candidates that are plans themselves take no part.
std::string find_fastest_mixed_plan(const ResolvedChooseRequest& request,
                                    const measure::Comparison& training,
                                    const std::vector<JudgedPlan>& plans) {
    if (!request.max_error) return "";
    const bool squares = request.quantity == ErrorQuantity::rmse; // squared errors can be added
                                                                  // over pixels
    std::vector<measure::TechniqueCandidateForMix> candidates;
    std::vector<std::string> texts;
    std::vector<std::vector<double>> pixels;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (!read_technique_plan(plans[i].text).is_technique) continue;
        measure::TechniqueCandidateForMix candidate{plans[i].ms, {}};
        pixels.clear();
        for (const measure::Errors& view : training.rows[i].views) {
            std::vector<double>& sums = candidate.error_sums.emplace_back();
            std::vector<double>& counts = pixels.emplace_back();
            for (const measure::Difference& mirror : view.error_per_mirror) {
                const double error = mirror.pixels > 0
                                         ? error_value_of_difference(request.quantity, mirror)
                                         : 0;
                counts.push_back(static_cast<double>(mirror.pixels));
                sums.push_back(counts.back() * (squares ? error * error : error));
            }
        }
        candidates.push_back(std::move(candidate));
        texts.push_back(plans[i].text);
    }
    const double limit = squares ? *request.max_error * *request.max_error : *request.max_error;
    const std::vector<std::size_t> mix = measure::find_fastest_technique_mix(candidates, pixels,
                                                                             limit);
    return make_plan_text_from_technique_mix(texts, mix);
}

/// Returns whether the second of two plans is faster when both are measured side by side.
bool is_second_plan_faster(const ResolvedChooseRequest& request, const std::string& first,
                           const std::string& second) {
    const std::vector<std::string> texts{first, second};
    const measure::Comparison both = request.compare_plans(texts, 0, request.base.seed, 1);
    if (!request.device_costs)
        return measure::RowJudge(both.rows).times(both.rows[1], both.rows[0]) ==
               measure::Order::less;
    const std::vector<JudgedPlan> plans = list_judged_plans(request, both, texts);
    return plans[1].ms < plans[0].ms;
}

/// Returns whether one plan takes less time than another. The interval of a measured time must end
/// before the other interval. Predicted times are compared without their ranges, because both
/// ranges have the same unknown unit costs.
bool does_plan_take_less_time(const ResolvedChooseRequest& request, const JudgedPlan& a,
                              const JudgedPlan& b) {
    const bool known = !request.device_costs && a.ms_range.is_known() && b.ms_range.is_known();
    return known ? a.ms_range.high < b.ms_range.low : a.ms < b.ms;
}

/// Returns the plans within the limits that no other such plan beats, in order from the smallest
/// error to the shortest time. A plan is beaten by a plan that errs less and does not take more
/// time.
std::vector<const JudgedPlan*> list_unbeaten_plans(const ResolvedChooseRequest& request,
                                                   const std::vector<JudgedPlan>& plans) {
    std::vector<const JudgedPlan*> kept;
    for (const JudgedPlan& plan : plans)
        if (keeps_time(request, plan) && keeps_error(request, plan)) kept.push_back(&plan);
    std::ranges::stable_sort(kept, [](const JudgedPlan* a, const JudgedPlan* b) {
        return a->largest_error != b->largest_error ? a->largest_error < b->largest_error
                                                    : a->ms < b->ms;
    });
    std::vector<const JudgedPlan*> unbeaten;
    for (const JudgedPlan* plan : kept) // plans earlier in the list err less
        if (std::ranges::all_of(unbeaten, [&](const JudgedPlan* surer) {
                return does_plan_take_less_time(request, *plan, *surer);
            }))
            unbeaten.push_back(plan);
    return unbeaten;
}

/// Returns the most failures among the proof views with which a proof succeeds.
std::size_t find_most_failures_of_proof(const ResolvedChooseRequest& request, std::size_t views) {
    std::size_t failures = 0;
    while (failures < views &&
           measure::count_views_needed_for_certificate(find_share_to_prove(request),
                                                       request.confidence, failures + 1) <= views)
        ++failures;
    return failures;
}

/// Returns those of the plans that are worth a proof, in the order of their proofs. If a plan's
/// proof fails, the plan before it is chosen.
std::vector<const JudgedPlan*> find_best_proofs(const ResolvedChooseRequest& request,
                                                const std::vector<const JudgedPlan*>& plans) {
    constexpr std::size_t kMaxProvedPlans = 4; // without the mix of techniques
    // Without it, a few views with similar errors make a proof look certain. Chosen by replaying
    // recorded views of courtyard, room and cornell-mirrors-closed (tests/long/choose_test.cpp).
    constexpr double kAddedDeviation = .5;
    // Having no plan is as bad as a plan that takes this many times as long.
    constexpr double kNoPlanFactor = 10;
    const auto views = static_cast<std::size_t>(find_proof_view_count(request));
    const std::size_t failures = find_most_failures_of_proof(request, views);
    std::vector<measure::ProofCandidate> candidates;
    for (const JudgedPlan* plan : plans)
        candidates.push_back({std::max(plan->ms, 1e-9), measure::estimate_probability_of_proof(
                                                            plan->errors, *request.max_error, views,
                                                            failures, kAddedDeviation)});
    std::vector<const JudgedPlan*> chain;
    for (const std::size_t i :
         measure::find_best_proof_order(candidates, kMaxProvedPlans, kNoPlanFactor))
        chain.push_back(plans[i]);
    if (chain.empty()) chain.push_back(plans.front());
    return chain;
}

/// Returns the plans to prove, in order from the slowest to the fastest.
std::vector<std::string> list_plans_to_prove(const ResolvedChooseRequest& request,
                                             const measure::Comparison& training,
                                             const std::vector<JudgedPlan>& plans) {
    std::vector<const JudgedPlan*> unbeaten = list_unbeaten_plans(request, plans);
    if (unbeaten.empty()) return {};
    if (!request.max_error) // with a limit of time alone, the plan with the least error is wanted
        return {unbeaten.front()->text};
    unbeaten = find_best_proofs(request, unbeaten);
    std::vector<std::string> chain;
    for (const JudgedPlan* plan : unbeaten) chain.push_back(plan->text);
    const std::string mixed = find_fastest_mixed_plan(request, training, plans),
                      cheapest = chain.back();
    if (mixed.empty()) return chain;
    report_choose_step(request, "measuring the mix " + mixed + " beside " + cheapest);
    if (is_second_plan_faster(request, cheapest, mixed)) chain.push_back(mixed);
    return chain;
}

std::vector<PlanProof> prove_plans(const ResolvedChooseRequest& request,
                                   const std::vector<std::string>& texts) {
    const int views = find_proof_view_count(request);
    report_choose_step(
        request,
        fmt::format("proving {} on {} fresh views",
                    texts.size() == 1 ? texts.front() : fmt::format("{} plans", texts.size()),
                    views));
    const measure::Comparison comparison = request.compare_plans(texts, views, request.proof_seed,
                                                                 1);
    std::vector<PlanProof> proofs;
    for (JudgedPlan& plan : list_judged_plans(request, comparison, texts)) {
        PlanProof proof{.plan = std::move(plan),
                        .device = request.device_costs
                                      ? request.device_costs->device + " (predicted)"
                                      : comparison.device.name,
                        .scene_hash = comparison.scene.hash,
                        .exposure = comparison.exposure};
        const std::vector<double>& errors = proof.plan.errors;
        if (request.max_error)
            proof.failures = static_cast<std::size_t>(std::ranges::count_if(
                errors, [&](double error) { return !(error <= *request.max_error); }));
        const double seen_share = measure::lower_bound_of_passing_view_share(
            proof.failures, errors.size(), request.confidence);
        proof.share_bound = std::max(0.0, 1 - (1 - seen_share) /
                                                  (1 - find_noise_miss_probability(request)));
        proof.error_bound = measure::upper_tolerance_limit(errors, find_share_to_prove(request),
                                                           request.confidence);
        proof.noise = find_reference_noise_of_views(request, comparison);
        proof.keeps_error = request.max_error ? proof.share_bound >= request.share
                                              : std::isfinite(proof.error_bound);
        proof.keeps_time = keeps_time(request, proof.plan);
        proofs.push_back(std::move(proof));
        if (!proofs.back().keeps_error) break; // no cheaper plan may be chosen after a failure
    }
    return proofs;
}

std::string format_limit_of_error(const ResolvedChooseRequest& request) {
    return fmt::format("{} <= {:g}", error_quantity_name(request.quantity), *request.max_error);
}

/// Returns the reason why no plan keeps the limits in the training views, and the plan that comes
/// nearest.
std::string describe_nearest_plan(const ResolvedChooseRequest& request,
                                  const std::vector<JudgedPlan>& plans,
                                  const std::optional<NoiseOfViews>& noise) {
    const JudgedPlan *closest = nullptr, *fastest = nullptr;
    for (const JudgedPlan& plan : plans) {
        if (fastest == nullptr || plan.ms < fastest->ms) fastest = &plan;
        if (keeps_time(request, plan) &&
            (closest == nullptr || plan.largest_error < closest->largest_error))
            closest = &plan;
    }
    if (fastest == nullptr) return "no candidate could be judged";
    if (closest == nullptr)
        return fmt::format("no candidate takes at most {:g} ms; the best that is reachable is {} "
                           "with {:.3g} ms",
                           *request.max_ms, fastest->text, fastest->ms);
    return fmt::format("no candidate keeps {} in the {} training views{}; the best that is "
                       "reachable is {}, at most {:.4g}{}",
                       format_limit_of_error(request), closest->errors.size(),
                       request.max_ms ? " within the time" : "", closest->text,
                       closest->largest_error, describe_noise_as_cause(noise));
}

/// Returns the reason why no plan keeps its limits in the proof views.
std::string describe_failed_proof(const ResolvedChooseRequest& request,
                                  const std::vector<PlanProof>& proofs) {
    const PlanProof& first = proofs.front();
    if (first.keeps_error)
        return fmt::format("no plan takes at most {:g} ms when it is measured again; {} takes "
                           "{:.3g} ms",
                           *request.max_ms, proofs.back().plan.text, proofs.back().plan.ms);
    return fmt::format("{} keeps the limits in the training views, but not in enough of the fresh "
                       "ones ({} of {} fail); the best that is reachable is {} <= {:.4g}{}",
                       first.plan.text, first.failures, first.plan.errors.size(),
                       error_quantity_name(request.quantity), first.error_bound,
                       describe_noise_as_cause(first.noise));
}

} // namespace

const char* error_quantity_name(ErrorQuantity quantity) {
    return quantity == ErrorQuantity::flip ? "flip" : "rmse";
}

double mirror_error_of_view(ErrorQuantity quantity, const measure::Difference& mirrors) {
    if (mirrors.nonfinite > 0) return INFINITY;
    return mirrors.pixels == 0 ? 0 : error_value_of_difference(quantity, mirrors);
}

double lower_mirror_error_of_view(ErrorQuantity quantity, const measure::Difference& mirrors) {
    if (mirrors.nonfinite > 0) return INFINITY;
    if (mirrors.pixels == 0) return 0;
    return quantity == ErrorQuantity::flip ? measure::find_lower_flip_bound(mirrors)
                                           : measure::find_lower_rmse_bound(mirrors);
}

PlanProof prove_plan(Engine& engine, const ChooseRequest& asked, const std::string& plan) {
    const WatchedWork watched(asked.watcher);
    const ResolvedChooseRequest request(asked, make_rendering_comparer(engine, asked));
    check_choose_request(request);
    return prove_plans(request, {plan}).front();
}

PlanChoice choose_plan(Engine& engine, const ChooseRequest& asked) {
    const WatchedWork watched(asked.watcher);
    ChooseRequest request = asked;
    if (request.base.techniques.empty())
        request.base.techniques = list_default_techniques(request.base);
    return choose_plan(request, make_rendering_comparer(engine, request));
}

PlanChoice choose_plan(const ChooseRequest& asked, const PlanComparer& compare_plans) {
    const ResolvedChooseRequest request(asked, compare_plans);
    check_choose_request(request);
    PlanChoice choice;
    std::vector<std::string> texts = request.base.techniques;
    check(!texts.empty(), Failure::usage, "candidates: wanted at least one, found none");
    report_choose_step(request, fmt::format("measuring {} candidates in one view", texts.size()));
    texts = keep_plans_not_clearly_beaten(
        request, request.compare_plans(texts, 0, request.base.seed, 1), texts, choice.dropped);
    check(!texts.empty(), Failure::usage,
          "candidates: wanted one that shows reflections, found none");
    report_choose_step(request, fmt::format("judging {} candidates in {} training views",
                                            texts.size(), request.training_views));
    const measure::Comparison training = request.compare_plans(
        texts, request.training_views, request.base.seed, request.cameras_per_instant);
    choice.candidates = list_judged_plans(request, training, texts);
    const std::vector<std::string> chain = list_plans_to_prove(request, training,
                                                               choice.candidates);
    if (chain.empty()) {
        choice.failure = describe_nearest_plan(request, choice.candidates,
                                               find_reference_noise_of_views(request, training));
        return choice;
    }
    choice.proofs = prove_plans(request, chain);
    for (std::size_t i = 0; i < choice.proofs.size(); ++i)
        if (choice.proofs[i].holds()) choice.chosen = i;
    if (!choice.chosen) choice.failure = describe_failed_proof(request, choice.proofs);
    return choice;
}

} // namespace catoptric::app
