#include "study/row_judge.hpp"

#include "measure/lookup.hpp"
#include "report/comparison.hpp"
#include "session/technique_choice.hpp"
#include "study/compare_row.hpp"
#include "study/light_edges.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::app {

namespace {

bool is_set(const report::Row& row, std::string_view knob, std::string_view text) {
    return std::ranges::any_of(row.settings, [&](const report::Setting& setting) {
        return setting.name == knob && setting.text == text;
    });
}

} // namespace

/// Returns a request for what frame `number` shows, with the scene still.
Request RowJudge::still(int number) const {
    Request request = base_;
    request.time = base_.instant(number);
    request.animate = false;
    return request;
}

/// Renders where the row's mirrors looked, and what its captures cut off. This is a run of its own,
/// because recording costs time. The lookup is empty for rows that do not look into captures.
Part RowJudge::looked_up(const std::string& text, int number) {
    Request request = still(number);
    request.techniques = {text};
    request.frames = 1;
    request.warmup = 1;
    request.with_lookup = true;
    Part part = std::move(run(session_, request, watcher_).parts.front());
    const bool looks = std::ranges::any_of(part.lookup,
                                           [](const vec4& pixel) { return pixel.w > 0; });
    if (!looks) part.lookup.clear();
    return part;
}

const Oracle& RowJudge::oracle_of(int number) {
    if (!oracle_ || (base_.animate && number != oracle_frame_)) oracle_.emplace(still(number));
    oracle_frame_ = number;
    return *oracle_;
}

std::vector<std::string> RowJudge::judge(report::Row& row, const std::string& text,
                                         const Part& part, int number) {
    const Part& truth = truths_.at(sample_count(parse_technique(text)), number).part;
    const std::vector<std::uint32_t>& hits = truths_.hits(number);
    row.pictured = number;
    fill_errors(row, part, truth, hits, scene::mirrors(base_.scene).size(), base_.exposure);
    const Part looked = !part.rays || part.traced_fraction ? looked_up(text, number) : Part();
    row.saturated_texels = looked.saturated;
    if (!looked.lookup.empty()) {
        const Oracle& oracle = oracle_of(number);
        row.lookup = measure::lookup_error(
            oracle.judge(looked.lookup, is_set(row, "mirrors", "left_out")));
        row.light_edges = light_edges_of(row, truth, hits, looked.lookup, oracle, base_.exposure);
    }
    std::vector<std::string> warnings;
    if (looked.saturated.value_or(0) > 0)
        warnings.push_back(
            "'" + text + "': " + std::to_string(*looked.saturated) +
            " texels of its captures are brighter than 65504, where colour=half ends");
    for (const std::string& note : part.notes) warnings.push_back("'" + text + "': " + note);
    return warnings;
}

} // namespace catoptric::app
