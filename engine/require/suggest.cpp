#include "require/suggest.hpp"

#include "require/plan_candidates.hpp"
#include "scene/material_facts.hpp"
#include "scene/mirror_shape.hpp"
#include "scene/rough_reflectors.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <utility>

namespace catoptric::require {

namespace {

std::string format_percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

/// Returns the reason that follows the mirror's technique.
std::string explain_choice(const WorkModelInput& input, const CostInputs& known, std::size_t mirror,
                           const scene::Object& object, DrawMethod way) {
    const auto share = [&](std::size_t paths) {
        return format_percent(static_cast<double>(paths) / static_cast<double>(known.paths.count));
    };
    const std::size_t first = known.paths.first[mirror], reached = known.paths.reached[mirror];
    std::string seen = reached == 0 ? "no pixel shows it"
                                    : share(first) + " of the picture, " + share(reached) +
                                          " with what other mirrors show of it";
    if (reached == first && first > 0) seen = share(first) + " of the picture";
    const scene::MirrorShape::Kind kind = scene::classify_shape(input.now, object).kind;
    const char* shape = known.is_glass[mirror]                                ? "glass"
                        : scene::may_reflect_by_lobe(input.now, object)       ? "rough"
                        : input.now.materials[object.material].normal_texture ? "bumpy"
                        : known.is_flat[mirror]
                            ? kind == scene::MirrorShape::Kind::flat ? "flat" : "flat faces"
                        : kind == scene::MirrorShape::Kind::flat   ? "not quite flat"
                        : kind == scene::MirrorShape::Kind::sphere ? "a sphere"
                                                                   : "curved";
    std::string reason = std::string(shape) + ", " + seen;
    const std::size_t hidden = known.paths.hidden[mirror];
    if (known.is_glass[mirror] && (way == DrawMethod::hybrid || way == DrawMethod::traced))
        reason += "; rays pass it";
    else if (way == DrawMethod::march && hidden == 0)
        reason += "; its centre sees all that it shows";
    else if (way == DrawMethod::march || way == DrawMethod::hybrid)
        reason += "; its centre does not see what " + share(hidden) + " of the picture show";
    else if (way == DrawMethod::traced)
        reason += "; rays draw all mirrors";
    if (way == DrawMethod::march && hidden > 0) reason += ", too little to trace";
    return reason;
}

/// Returns a plan such as "1,3=planar *=hybrid". All techniques other than `rest` list their
/// mirrors by number.
std::string write_rules(const std::map<std::string, std::vector<std::size_t>>& mirrors,
                        const std::string& rest) {
    if (mirrors.empty()) return rest;
    if (mirrors.size() == 1) return mirrors.begin()->first;
    std::string plan;
    for (const auto& [technique, numbers] : mirrors) {
        if (technique == rest) continue;
        for (const std::size_t number : numbers)
            plan += (number == numbers.front() ? "" : ",") + std::to_string(number);
        plan += "=" + technique + " ";
    }
    if (mirrors.contains(rest)) return plan + "*=" + rest;
    plan.pop_back();
    return plan;
}

std::string write_plan(const PlanCandidate& candidate) {
    std::map<std::string, std::vector<std::size_t>> of_technique;
    for (std::size_t i = 0; i < candidate.techniques.size(); ++i)
        of_technique[candidate.techniques[i]].push_back(i + 1);
    return write_rules(of_technique, "hybrid");
}

} // namespace

PlanSuggestion suggest_plan(const WorkModelInput& input, const UnitCosts& costs) {
    const std::vector<std::size_t> mirrors = scene::mirrors(input.now);
    PlanSuggestion suggestion;
    if (mirrors.empty()) {
        suggestion.plan = "hybrid";
        return suggestion;
    }
    const CostInputs known = gather_cost_inputs(input);
    std::vector<PlanCandidate>& candidates = suggestion.candidates;
    candidates.push_back(make_captured_candidate(known, costs, true));
    if (PlanCandidate searched = make_captured_candidate(known, costs, false);
        searched.techniques != candidates.front().techniques)
        candidates.push_back(std::move(searched));
    if (known.paths.on_mirrors() > 0)
        std::ranges::move(make_traced_candidates(known, costs), std::back_inserter(candidates));
    std::ranges::stable_sort(candidates, {}, &PlanCandidate::score);
    for (PlanCandidate& candidate : candidates) candidate.plan = write_plan(candidate);
    suggestion.plan = candidates.front().plan;
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        suggestion.reasons.push_back(candidates.front().techniques[i] + ": " +
                                     explain_choice(input, known, i, input.now.objects[mirrors[i]],
                                                    candidates.front().ways[i]));
    }
    return suggestion;
}

std::string format_candidates(const std::vector<PlanCandidate>& candidates,
                              const std::string& costs) {
    std::string text;
    for (const PlanCandidate& candidate : candidates) {
        char figures[160];
        std::snprintf(figures, sizeof figures,
                      ": predicted %.3g ms a frame, FLIP %.2g, score %.3g%s\n", candidate.ms,
                      candidate.error, candidate.score(),
                      &candidate == candidates.data() ? " (chosen)" : "");
        text += "  " + candidate.name + figures;
    }
    char rule[160];
    std::snprintf(rule, sizeof rule,
                  "  why: least score, which is the time times (1 + FLIP / %g); ",
                  kErrorOfDoubleTime);
    return text + rule + "unit costs: " + costs + "\n";
}

} // namespace catoptric::require
