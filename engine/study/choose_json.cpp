#include "study/choose_json.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "report/json.hpp"
#include "session/plan_file.hpp"
#include "study/reference_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace catoptric::study {

namespace {

using report::Json;

/// Returns the rules of a plan. The file of a plan was read before, so it is valid.
Json plan_rules_json(const std::string& text) {
    if (constexpr std::string_view kFile = "plan:"; text.starts_with(kFile)) {
        const std::string file = text.substr(kFile.size());
        const Json document = parse_json<Json>(file, read_file(file));
        return document.is_object() ? document.value("plan", Json()) : document;
    }
    Json rules = Json::array();
    if (text == reflect::kAutoPlanName || read_plan(text).is_technique) {
        rules.push_back({{"mirror", "*"}, {"technique", text}});
        return rules;
    }
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string rule = text.substr(begin, end - begin);
        const std::size_t sign = rule.find('=');
        rules.push_back({{"mirror", rule.substr(0, sign)}, {"technique", rule.substr(sign + 1)}});
        begin = end + 1;
    }
    return rules;
}

Json judged_plan_json(const JudgedPlan& plan) {
    Json json{{"technique", plan.text},
              {"ms", report::number_json(plan.ms)},
              {"ms_range", report::interval_json(plan.ms_range)},
              {"largest_error", report::number_json(plan.largest_error)},
              {"errors", report::numbers_json(plan.errors)}};
    if (!plan.drawn.empty()) json["drawn"] = plan.drawn;
    return json;
}

Json candidate_json(const JudgedPlan& plan) {
    Json json = judged_plan_json(plan);
    json["why"] = plan.why;
    return json;
}

/// Returns true, false, or "may" for a predicted time.
Json verdict_json(TimeVerdict verdict) {
    if (verdict == TimeVerdict::may_keep) return "may";
    return verdict == TimeVerdict::keeps;
}

Json proof_json(const PlanProof& proof) {
    Json json = judged_plan_json(proof.plan);
    json["views"] = proof.plan.errors.size(), json["failures"] = proof.failures;
    json["share_bound"] = report::number_json(proof.share_bound);
    json["error_bound"] = report::number_json(proof.error_bound);
    json["keeps_error"] = proof.keeps_error;
    json["keeps_time"] = verdict_json(proof.time);
    return json;
}

/// Returns the noise of the proof views; null if the reference has no noise.
Json noise_json(const std::optional<ViewNoise>& noise) {
    if (!noise) return nullptr;
    return {{"median_floor", report::number_json(noise->median_floor)},
            {"largest_floor", report::number_json(noise->largest_floor)},
            {"wanted_floor", report::number_json(noise->wanted_floor)},
            {"views_above_wanted", noise->views_above}};
}

/// The limits that a certificate states.
struct StatedLimits {
    std::optional<double> max_error, max_ms;
    std::size_t failures = 0;
};

StatedLimits requested_limits(const ChooseRequest& request, const PlanProof& proof) {
    return {request.max_error, request.max_ms, proof.failures};
}

/// Returns the limits that a plan keeps. A certificate without a limit of error states the error
/// that the share of views does not exceed.
StatedLimits kept_limits(const ChooseRequest& request, const PlanProof& proof) {
    StatedLimits limits = requested_limits(request, proof);
    if (!proof.keeps_error) limits.max_error.reset(), limits.failures = 0;
    if (proof.time == TimeVerdict::breaks) limits.max_ms.reset();
    return limits;
}

Json certificate_json(const ChooseRequest& request, const PlanProof& proof,
                      const StatedLimits& limits, const std::string& scene) {
    return {{"quantity", quantity_name(request.quantity)},
            {"max_error", report::number_json(limits.max_error)},
            {"max_ms", report::number_json(limits.max_ms)},
            {"share", request.share},
            {"confidence", request.confidence},
            {"views", proof.plan.errors.size()},
            {"failures", limits.failures},
            {"share_bound", report::number_json(proof.share_bound)},
            {"error_bound", report::number_json(proof.error_bound)},
            {"ms", report::number_json(proof.plan.ms)},
            {"ms_range", report::interval_json(proof.plan.ms_range)},
            {"device", proof.device},
            {"times", request.costs.empty() ? "measured" : "predicted"},
            {"scene", scene},
            {"scene_hash", proof.scene_hash},
            {"reference",
             choose_reference(request.reference, request.base.scene, ReferencePixelKind::centre)},
            {"reference_noise", noise_json(proof.noise)},
            {"exposure", proof.exposure},
            {"width", request.base.size.x},
            {"height", request.base.size.y},
            {"training_seed", request.base.seed},
            {"proof_seed", request.proof_seed},
            {"views_drawn", "as by compare --views: cameras that see a mirror, instants within one "
                            "period of the scene's motion"},
            {"version", version()},
            {"commit", commit()}};
}

std::string describe_proof(const ChooseRequest& request, const PlanProof& proof,
                           const StatedLimits& limits) {
    const char* quantity = quantity_name(request.quantity);
    // The certificate claims no larger share than requested, because only the requested share was
    // tested.
    const double share = std::min(proof.share_bound, request.share);
    const std::string statement = limits.max_error
                                      ? fmt::format("at least {:.4g} % of views have {} <= {:g}",
                                                    100 * share, quantity, *limits.max_error)
                                      : fmt::format("at least {:g} % of views have {} <= {:.4g}",
                                                    100 * request.share, quantity,
                                                    proof.error_bound);
    return fmt::format(
        "{}: {} ms on {}; {}, with {:g} % confidence ({} views of {}x{}, {} failures){}",
        proof.plan.text, format_time_range(proof.plan), proof.device, statement,
        100 * request.confidence, proof.plan.errors.size(), request.base.size.x,
        request.base.size.y, limits.failures,
        proof.noise ? "; " + describe_noise(*proof.noise) : "");
}

} // namespace

std::string describe_proof(const ChooseRequest& request, const PlanProof& proof) {
    return describe_proof(request, proof, requested_limits(request, proof));
}

std::string describe_nearest_proof(const ChooseRequest& request, const PlanProof& proof) {
    return describe_proof(request, proof, kept_limits(request, proof));
}

std::string describe_verdict(const ChooseRequest& request, const PlanProof& proof) {
    const bool is_unsure = request.max_ms && proof.time == TimeVerdict::may_keep;
    if (!proof.may_hold()) return "does not hold";
    if (!is_unsure) return "holds";
    const measure::Interval& range = proof.plan.ms_range;
    return range.is_known()
               ? fmt::format("may hold, {:.3g} to {:.3g} ms", range.low, range.high)
               : fmt::format("may hold, {:.3g} ms with an unknown error", proof.plan.ms);
}

Json choice_json(const ChooseRequest& request, const PlanChoice& choice, const std::string& scene) {
    Json document{{"schema", "catoptric/plan/1"}};
    if (choice.chosen) {
        const PlanProof& proof = choice.proofs[*choice.chosen];
        document["plan"] = plan_rules_json(proof.plan.text);
        document["certificate"] = certificate_json(request, proof, requested_limits(request, proof),
                                                   scene);
    } else {
        const PlanProof& proof = choice.proofs.at(choice.nearest.value());
        document["plan"] = plan_rules_json(proof.plan.text);
        document["nearest"] = {{"why", choice.failure},
                               {"max_error", report::number_json(request.max_error)},
                               {"max_ms", report::number_json(request.max_ms)}};
        document["certificate"] = certificate_json(request, proof, kept_limits(request, proof),
                                                   scene);
    }
    document["proofs"] = report::list_json(choice.proofs, proof_json);
    document["candidates"] = report::list_json(choice.candidates, candidate_json);
    return document;
}

Json proved_plan_json(const ChooseRequest& request, const std::string& plan, const PlanProof& proof,
                      const std::string& scene) {
    Json document{{"schema", "catoptric/plan/1"}, {"plan", plan_rules_json(plan)}};
    // The figures of a plan that is not proved are written under another name, without a statement.
    document[proof.may_hold() ? "certificate" : "not_proved"] = certificate_json(
        request, proof, requested_limits(request, proof), scene);
    document["proofs"] = Json::array({proof_json(proof)});
    return document;
}

ChosenPlan choose(Engine& engine, const ChooseRequest& request) {
    scene::check_scene(request.base.scene);
    const PlanChoice choice = choose_plan(engine, request);
    return {.plan = choice.chosen ? choice.proofs[*choice.chosen].plan.text : "",
            .failure = choice.failure,
            .json = report::serialise(choice_json(request, choice, request.base.scene.name))};
}

ChosenPlan certify(Engine& engine, const ChooseRequest& request, const std::string& plan) {
    scene::check_scene(request.base.scene);
    const PlanProof proof = prove_plan(engine, request, plan);
    return {
        .plan = proof.may_hold() ? plan : "",
        .failure = proof.may_hold() ? "" : "does not hold: " + describe_proof(request, proof),
        .json = report::serialise(proved_plan_json(request, plan, proof, request.base.scene.name))};
}

} // namespace catoptric::study
