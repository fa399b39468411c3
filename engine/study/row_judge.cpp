#include "study/row_judge.hpp"

#include "measure/light_edges.hpp"
#include "measure/lookup.hpp"
#include "report/comparison.hpp"
#include "session/technique_choice.hpp"
#include "study/compare_row.hpp"
#include "study/light_edges.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace catoptric::study {

namespace {

bool has_knob_value(const report::Row& row, std::string_view knob, std::string_view text) {
    return std::ranges::any_of(row.settings, [&](const report::Setting& setting) {
        return setting.name == knob && setting.text == text;
    });
}

} // namespace

/// Returns a request for a still picture of the scene at the instant of frame `number`.
Request RowErrorJudge::still_request(int number) const {
    Request request = base_;
    request.time = base_.instant(number);
    request.animate = false;
    return request;
}

/// Renders a frame that records where the row's mirrors looked, and how many texels of captures are
/// clamped. This frame is rendered separately, because recording takes time. The result has no
/// look-ups for rows that do not look into captures.
TechniqueResult RowErrorJudge::render_lookups(const std::string& text, int number) {
    Request request = still_request(number);
    request.techniques = {text};
    request.frames = 1;
    request.warmup = 1;
    request.with_lookup = true;
    TechniqueResult part = std::move(run(session_, request, watcher_).parts.front());
    const bool looks = std::ranges::any_of(part.lookup,
                                           [](const vec4& pixel) { return pixel.w > 0; });
    if (!looks) part.lookup.clear();
    return part;
}

const TrueHitFinder& RowErrorJudge::hit_finder(int number) {
    if (!finder_ || (base_.animate && number != finder_frame_))
        finder_.emplace(still_request(number));
    finder_frame_ = number;
    return *finder_;
}

std::vector<std::string> RowErrorJudge::fill(report::Row& row, const std::string& text,
                                             const TechniqueResult& part, int number) {
    const ComparedReference truth =
        truths_.get(sample_count(parse_technique(text)), number).compared();
    const std::vector<std::uint32_t>& hits = truths_.hits(number);
    row.pictured = number;
    fill_row_errors(row, part, truth, hits, scene::mirrors(base_.scene).size(), base_.exposure);
    const TechniqueResult looked = !part.rays || part.traced_fraction ? render_lookups(text, number)
                                                                      : TechniqueResult();
    row.saturated_texels = looked.saturated;
    if (!looked.lookup.empty()) {
        const TrueHitFinder& finder = hit_finder(number);
        row.lookup = std::make_shared<measure::LookupSummary>(measure::summarise_lookups(
            finder.judge_lookups(looked.lookup, has_knob_value(row, "mirrors", "left_out"))));
        row.light_edges = std::make_shared<measure::LightEdgeErrors>(
            split_at_light_edges(row, truth, hits, looked.lookup, finder, base_.exposure));
    }
    std::vector<std::string> warnings;
    if (looked.saturated.value_or(0) > 0)
        warnings.push_back(
            "'" + text + "': " + std::to_string(*looked.saturated) +
            " texels of its captures are brighter than 65504, where colour=half ends");
    for (const std::string& note : part.notes) warnings.push_back("'" + text + "': " + note);
    return warnings;
}

} // namespace catoptric::study
