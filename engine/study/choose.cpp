#include "study/choose.hpp"

#include "compare.hpp"
#include "core/error.hpp"
#include "measure/certificate.hpp"
#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "session/watcher.hpp"
#include "study/choose_judge.hpp"
#include "study/choose_search.hpp"
#include "study/compare_checks.hpp"
#include "study/compare_to_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::study {

namespace {

void check_choose_request(const ResolvedRequest& request) {
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
    check(request.training_views == 0 ||
              request.training_views >= static_cast<int>(measure::kMinIntervalSamples),
          Failure::usage, "training views: wanted at least ", measure::kMinIntervalSamples,
          ", found ", request.training_views);
    check(request.proof_seed != request.base.seed &&
              request.proof_seed != further_training_seed(request),
          Failure::usage,
          "seed of the proof: wanted another than that of the training views, found ",
          request.proof_seed);
    // A share above this value would need more proof views than any run draws.
    constexpr double kMaxPart = .9999;
    check(request.share <= kMaxPart && request.confidence <= kMaxPart, Failure::usage,
          "share and confidence: wanted at most ", kMaxPart, ", found ", request.share, " and ",
          request.confidence);
    const int needed = min_proof_views(request);
    check(request.proof_views == 0 || request.proof_views >= needed, Failure::usage,
          "views of the proof: wanted at least ", needed, ", since fewer cannot prove a share of ",
          request.share, " with a confidence of ", request.confidence, ", found ",
          request.proof_views);
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

std::vector<PlanProof> prove_plans(const ResolvedRequest& request,
                                   const std::vector<std::string>& texts) {
    const int views = count_proof_views(request);
    request.tell_step(fmt::format(
        "proving {} on {} fresh views",
        texts.size() == 1 ? texts.front() : fmt::format("{} plans", texts.size()), views));
    const measure::Comparison comparison = request.compare_plans(texts, views, request.proof_seed,
                                                                 1);
    std::vector<PlanProof> proofs;
    for (JudgedPlan& plan : judged_plans(request, comparison, texts)) {
        PlanProof proof{.plan = std::move(plan),
                        .device = request.device_costs
                                      ? request.device_costs->device + " (predicted)"
                                      : comparison.device.name,
                        .scene_hash = comparison.scene.hash,
                        .exposure = comparison.exposure};
        const std::vector<double>& errors = proof.plan.errors;
        proof.failures = count_failures(request, proof.plan);
        const double seen_share = measure::passing_share_bound(proof.failures, errors.size(),
                                                               request.confidence);
        proof.share_bound = std::max(0.0,
                                     1 - (1 - seen_share) / (1 - noise_miss_probability(request)));
        proof.error_bound = measure::upper_tolerance_limit(errors, share_to_prove(request),
                                                           request.confidence);
        proof.noise = find_view_noise(request, comparison);
        proof.keeps_error = request.max_error ? proof.share_bound >= request.share
                                              : std::isfinite(proof.error_bound);
        proof.time = judge_time(request, proof.plan);
        proofs.push_back(std::move(proof));
        if (!proofs.back().keeps_error) break; // no cheaper plan may be chosen after a failure
    }
    return proofs;
}

std::string format_limit(const ResolvedRequest& request) {
    return fmt::format("{} <= {:g}", quantity_name(request.quantity), *request.max_error);
}

/// Returns the reason why no plan keeps the limits in the training views, and the nearest plan.
std::string describe_nearest_plan(const ResolvedRequest& request, const PlanChoice& choice,
                                  const JudgedPlan& nearest,
                                  const std::optional<ViewNoise>& noise) {
    const bool has_time = std::ranges::any_of(choice.candidates, [&](const JudgedPlan& plan) {
        return judge_time(request, plan) != TimeVerdict::breaks;
    });
    if (!has_time)
        return fmt::format("no candidate takes at most {:g} ms; the best that is reachable is {} "
                           "with {:.3g} ms",
                           *request.max_ms, nearest.text, nearest.ms);
    return fmt::format("no candidate keeps {} in the {} training views{}; the best that is "
                       "reachable is {}, at most {:.4g}{}",
                       format_limit(request), nearest.errors.size(),
                       request.max_ms ? " within the time" : "", nearest.text,
                       nearest.largest_error, describe_noise_cause(noise));
}

/// Returns the reason why no plan keeps its limits in the proof views.
std::string describe_failed_proof(const ResolvedRequest& request,
                                  const std::vector<PlanProof>& proofs) {
    const PlanProof& first = proofs.front();
    if (first.keeps_error)
        return fmt::format("no plan takes at most {:g} ms when it is measured again; {} takes "
                           "{:.3g} ms",
                           *request.max_ms, proofs.back().plan.text, proofs.back().plan.ms);
    return fmt::format("{} keeps the limits in the training views, but not in enough of the fresh "
                       "ones ({} of {} fail); the best that is reachable is {} <= {:.4g}{}",
                       first.plan.text, first.failures, first.plan.errors.size(),
                       quantity_name(request.quantity), first.error_bound,
                       describe_noise_cause(first.noise));
}

/// Returns the index of the plan that comes nearest to the limits among proved plans: the last that
/// keeps the limit of error, or else the first, which errs least.
std::size_t find_nearest_proof(const std::vector<PlanProof>& proofs) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < proofs.size(); ++i)
        if (proofs[i].keeps_error) nearest = i;
    return nearest;
}

std::string describe_result(const ResolvedRequest& request, const PlanChoice& choice,
                            std::size_t index) {
    const PlanProof& proof = choice.proofs[index];
    if (choice.chosen == index)
        return proof.holds() ? "chosen" : "chosen, if its predicted time is right";
    if (!proof.keeps_error)
        return request.max_error
                   ? fmt::format("proof failed: {} above {:g} in {} of {} fresh views",
                                 quantity_name(request.quantity), *request.max_error,
                                 proof.failures, proof.plan.errors.size())
                   : "proof failed: some pixels of fresh views are not finite";
    if (proof.time == TimeVerdict::breaks) return describe_broken_time(request, proof.plan);
    return fmt::format("holds, but {} is faster", choice.proofs[*choice.chosen].plan.text);
}

/// Sets why each plan of the proofs was chosen or fell.
void explain_proofs(const ResolvedRequest& request, const std::vector<std::string>& chain,
                    PlanChoice& choice) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
        JudgedPlan& plan = *std::ranges::find(choice.candidates, chain[i], &JudgedPlan::text);
        if (i >= choice.proofs.size())
            plan.why = fmt::format("not proved, because the proof of {} failed",
                                   choice.proofs.back().plan.text);
        else if (plan.why.empty() || choice.chosen)
            plan.why = describe_result(request, choice, i);
        if (choice.nearest == i) plan.why += "; comes nearest";
    }
}

} // namespace

const char* quantity_name(ErrorQuantity quantity) {
    return quantity == ErrorQuantity::flip ? "flip" : "rmse";
}

double mirror_error(ErrorQuantity quantity, const measure::Difference& mirrors) {
    if (mirrors.nonfinite > 0) return INFINITY;
    return mirrors.pixels == 0 ? 0 : error_value(quantity, mirrors);
}

double lower_mirror_error(ErrorQuantity quantity, const measure::Difference& mirrors) {
    if (mirrors.nonfinite > 0) return INFINITY;
    if (mirrors.pixels == 0) return 0;
    return quantity == ErrorQuantity::flip ? measure::lower_flip_bound(mirrors)
                                           : measure::lower_rmse_bound(mirrors);
}

PlanProof prove_plan(Engine& engine, const ChooseRequest& asked, const std::string& plan) {
    const WatchedWork watched(asked.watcher);
    const ResolvedRequest request(asked, make_rendering_comparer(engine, asked));
    check_choose_request(request);
    return prove_plans(request, {plan}).front();
}

PlanChoice choose_plan(Engine& engine, const ChooseRequest& asked) {
    const WatchedWork watched(asked.watcher);
    ChooseRequest request = asked;
    if (request.base.techniques.empty()) request.base.techniques = default_techniques(request.base);
    return choose_plan(request, make_rendering_comparer(engine, request));
}

PlanChoice choose_plan(const ChooseRequest& asked, const PlanComparer& compare_plans) {
    const ResolvedRequest request(asked, compare_plans);
    check_choose_request(request);
    check(!request.base.techniques.empty(), Failure::usage,
          "candidates: wanted at least one, found none");
    PlanChoice choice;
    std::optional<ViewNoise> noise;
    std::vector<std::string> chain = find_plans_to_prove(request, choice.candidates, noise);
    const bool has_failed = chain.empty();
    if (has_failed) {
        const JudgedPlan* nearest = find_nearest_plan(request, choice.candidates);
        check(nearest != nullptr, Failure::usage,
              "candidates: wanted one that shows reflections, found none");
        choice.failure = describe_nearest_plan(request, choice, *nearest, noise);
        request.tell_step("no candidate keeps the limits in the training views");
        chain = {nearest->text};
    }
    choice.proofs = prove_plans(request, chain);
    for (std::size_t i = 0; i < choice.proofs.size(); ++i)
        if (choice.proofs[i].may_hold()) choice.chosen = i;
    if (!choice.chosen) choice.nearest = find_nearest_proof(choice.proofs);
    if (choice.chosen)
        choice.failure.clear(); // fresh views decide, not the training views
    else if (!has_failed)
        choice.failure = describe_failed_proof(request, choice.proofs);
    explain_proofs(request, chain, choice);
    return choice;
}

} // namespace catoptric::study
