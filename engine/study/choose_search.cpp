#include "study/choose_search.hpp"

#include "measure/certificate.hpp"
#include "measure/judge.hpp"
#include "measure/plan_mix.hpp"
#include "measure/proof_order.hpp"
#include "session/plan_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace catoptric::study {

namespace {

/// Returns the text of a plan with one technique per mirror; empty if all mirrors have the same
/// technique.
std::string mix_text(const std::vector<std::string>& texts, const std::vector<std::size_t>& mix) {
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
/// views, as a plan; empty if there is none. Row n of `training` belongs to plan n. Candidates that
/// are plans themselves take no part.
std::string find_fastest_mixed_plan(const ResolvedRequest& request,
                                    const measure::Comparison& training,
                                    const std::vector<JudgedPlan>& plans) {
    if (!request.max_error) return "";
    const bool squares = request.quantity == ErrorQuantity::rmse; // squared errors can be added
                                                                  // over pixels
    std::vector<measure::MixCandidate> candidates;
    std::vector<std::string> texts;
    std::vector<std::vector<double>> pixels;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (!read_plan(plans[i].text).is_technique) continue;
        measure::MixCandidate candidate{plans[i].ms, {}};
        pixels.clear();
        for (const measure::Errors& view : training.rows[i].views) {
            std::vector<double>& sums = candidate.error_sums.emplace_back();
            std::vector<double>& counts = pixels.emplace_back();
            for (const measure::Difference& mirror : view.error_per_mirror) {
                const double error = mirror.pixels > 0 ? error_value(request.quantity, mirror) : 0;
                counts.push_back(static_cast<double>(mirror.pixels));
                sums.push_back(counts.back() * (squares ? error * error : error));
            }
        }
        candidates.push_back(std::move(candidate));
        texts.push_back(plans[i].text);
    }
    const double limit = squares ? *request.max_error * *request.max_error : *request.max_error;
    const std::vector<std::size_t> mix = measure::find_fastest_mix(candidates, pixels, limit);
    return mix_text(texts, mix);
}

/// Measures two plans side by side in the own view, and returns whether the second is faster. Sets
/// its time and error.
bool is_second_faster(const ResolvedRequest& request, const std::string& first,
                      JudgedPlan& second) {
    const std::vector<std::string> texts{first, second.text};
    const measure::Comparison both = request.compare_plans(texts, 0, request.base.seed, 1);
    std::vector<JudgedPlan> plans = judged_plans(request, both, texts);
    const bool is_faster = request.device_costs
                               ? plans[1].ms < plans[0].ms
                               : measure::RowJudge(both.rows).times(both.rows[1], both.rows[0]) ==
                                     measure::Order::less;
    second = std::move(plans[1]);
    return is_faster;
}

/// Returns the most failures among the proof views with which a proof succeeds.
std::size_t max_proof_failures(const ResolvedRequest& request, std::size_t views) {
    std::size_t failures = 0;
    while (failures < views && measure::needed_views(share_to_prove(request), request.confidence,
                                                     failures + 1) <= views)
        ++failures;
    return failures;
}

/// Returns those of the plans that are worth a proof, in the order of their proofs. If a plan's
/// proof fails, the plan before it is chosen.
std::vector<JudgedPlan*> find_best_proofs(const ResolvedRequest& request,
                                          const std::vector<JudgedPlan*>& plans,
                                          std::size_t max_count) {
    // Without it, a few views with similar errors make a proof look certain. Chosen by replaying
    // recorded views of courtyard, room and cornell-mirrors-closed (tests/long/choose_test.cpp).
    constexpr double kAddedDeviation = .5;
    // Having no plan is as bad as a plan that takes this many times as long.
    constexpr double kNoPlanFactor = 10;
    const auto views = static_cast<std::size_t>(count_proof_views(request));
    const std::size_t failures = max_proof_failures(request, views);
    std::vector<measure::ProofCandidate> candidates;
    for (JudgedPlan* plan : plans)
        candidates.push_back({std::max(plan->ms, 1e-9),
                              measure::proof_probability(plan->errors, *request.max_error, views,
                                                         failures, kAddedDeviation)});
    std::vector<JudgedPlan*> chain;
    for (const std::size_t i : measure::find_best_order(candidates, max_count, kNoPlanFactor))
        chain.push_back(plans[i]);
    if (chain.empty()) chain.push_back(plans.front());
    return chain;
}

std::string count_candidates(std::size_t count) {
    return fmt::format("{} candidate{}", count, count == 1 ? "" : "s");
}

std::vector<std::string> plan_texts(const std::vector<JudgedPlan*>& plans) {
    std::vector<std::string> texts;
    for (const JudgedPlan* plan : plans) texts.push_back(plan->text);
    return texts;
}

std::vector<JudgedPlan*> plans_without_reason(std::vector<JudgedPlan>& candidates) {
    std::vector<JudgedPlan*> plans;
    for (JudgedPlan& plan : candidates)
        if (plan.why.empty()) plans.push_back(&plan);
    return plans;
}

/// Draws plans in further views. Adds the errors to those of earlier views, and takes over the new
/// times.
measure::Comparison draw_plans(const ResolvedRequest& request,
                               const std::vector<JudgedPlan*>& plans, int views,
                               std::uint64_t seed) {
    const std::vector<std::string> texts = plan_texts(plans);
    measure::Comparison drawn = request.compare_plans(texts, views, seed,
                                                      request.cameras_per_instant);
    const std::vector<JudgedPlan> judged = judged_plans(request, drawn, texts);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        JudgedPlan& plan = *plans[i];
        plan.ms = judged[i].ms, plan.ms_range = judged[i].ms_range;
        plan.errors.insert(plan.errors.end(), judged[i].errors.begin(), judged[i].errors.end());
        plan.largest_error = std::ranges::max(plan.errors);
    }
    return drawn;
}

/// Adds the mix of techniques to the candidates if it is faster than all plans that keep the
/// limits. `first`: the comparison in the first training views of `judged`.
void add_mixed_plan(const ResolvedRequest& request, const measure::Comparison& first,
                    const std::vector<JudgedPlan>& judged, const std::vector<JudgedPlan*>& unbeaten,
                    std::vector<JudgedPlan>& candidates) {
    const std::string mixed = find_fastest_mixed_plan(request, first, judged);
    if (mixed.empty()) return;
    const JudgedPlan& cheapest = **std::ranges::min_element(
        unbeaten, {}, [](const JudgedPlan* plan) { return plan->ms; });
    request.tell_step("measuring the mix " + mixed + " beside " + cheapest.text);
    JudgedPlan mix{.text = mixed, .errors = {}};
    if (!is_second_faster(request, cheapest.text, mix))
        mix.why = fmt::format("the mix is not faster than {}", cheapest.text);
    candidates.push_back(std::move(mix));
}

/// Returns the plans to prove among those that no other plan beats, the mix of techniques last.
std::vector<std::string> order_proofs(const ResolvedRequest& request,
                                      std::vector<JudgedPlan*> unbeaten, JudgedPlan* mix) {
    constexpr std::size_t kMaxProvedPlans = 4; // without the mix of techniques
    if (mix != nullptr) std::erase(unbeaten, mix);
    std::vector<JudgedPlan*> chain;
    if (!request.max_error) // with a limit of time alone, the plan with the least error is wanted
        chain = {unbeaten.front()};
    else if (!unbeaten.empty())
        chain = find_best_proofs(request, unbeaten, kMaxProvedPlans);
    for (JudgedPlan* plan : unbeaten)
        if (std::ranges::find(chain, plan) == chain.end())
            plan->why = request.max_error ? "not proved: other proofs promise more"
                                          : fmt::format("{} has a smaller {}", chain.front()->text,
                                                        quantity_name(request.quantity));
    if (mix != nullptr) chain.push_back(mix);
    return plan_texts(chain);
}

} // namespace

std::vector<std::string> find_plans_to_prove(const ResolvedRequest& request,
                                             std::vector<JudgedPlan>& candidates,
                                             std::optional<ViewNoise>& noise) {
    const std::vector<std::string>& texts = request.base.techniques;
    request.tell_step(fmt::format("measuring {} in one view", count_candidates(texts.size())));
    const measure::Comparison own = request.compare_plans(texts, 0, request.base.seed, 1);
    candidates = judged_plans(request, own, texts);
    candidates.reserve(candidates.size() + 1); // for the mix; pointers stay valid
    drop_beaten_plans(request, own, candidates);
    const std::vector<JudgedPlan*> kept = plans_without_reason(candidates);
    if (kept.empty()) return {};
    const int views = count_training_views(request),
              first_views = std::min(views, kFirstTrainingViews);
    request.tell_step(
        fmt::format("judging {} in {} training views", count_candidates(kept.size()), first_views));
    const measure::Comparison first = draw_plans(request, kept, first_views, request.base.seed);
    noise = find_view_noise(request, first);
    std::vector<JudgedPlan> judged;
    for (const JudgedPlan* plan : kept) judged.push_back(*plan);
    std::vector<JudgedPlan*> unbeaten = unbeaten_plans(request, candidates);
    if (unbeaten.empty()) return {};
    const JudgedPlan* last = &candidates.back();
    add_mixed_plan(request, first, judged, unbeaten, candidates);
    JudgedPlan* mix = &candidates.back() != last && candidates.back().why.empty()
                          ? &candidates.back()
                          : nullptr;
    if (views > first_views) {
        request.tell_step(fmt::format("judging {} in {} more training views",
                                      count_candidates(unbeaten.size() + (mix != nullptr ? 1 : 0)),
                                      views - first_views));
        noise = find_view_noise(request,
                                draw_plans(request, plans_without_reason(candidates),
                                           views - first_views, further_training_seed(request)));
        unbeaten = unbeaten_plans(request, candidates);
        if (unbeaten.empty()) return {};
        if (mix != nullptr && !mix->why.empty()) mix = nullptr;
    }
    return order_proofs(request, std::move(unbeaten), mix);
}

} // namespace catoptric::study
