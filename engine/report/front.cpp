// The Pareto front in words, without favour.
#include "measure/judge.hpp"
#include "report/findings.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

namespace catoptric::report {

namespace {

std::string figures(const Row& row) {
    return fmt::format("{} ({} ms, FLIP {}{})", row.label, ms_text(row.time_ms().median),
                       error_text(row.error.flip), row.mirrors_black ? ", its mirrors black" : "");
}

std::string figures_of(const std::vector<const Row*>& rows) {
    std::vector<std::string> texts;
    for (const Row* row : rows) texts.push_back(figures(*row));
    return joined(texts, "; ");
}

std::string labels_of(const std::vector<const Row*>& rows, std::string_view between) {
    std::vector<std::string> labels;
    for (const Row* row : rows) labels.push_back(row->label);
    return joined(labels, between);
}

/// Whether tracing rays beats everything else; nothing where that is no question.
std::string tracing_in_words(const measure::TracingVerdict& verdict) {
    if (verdict.others == 0 || !verdict.any_traced) return "";
    if (verdict.unbeaten.size() == verdict.others)
        return "No ray-traced row beats any of the others on this device.";
    if (!verdict.unbeaten.empty())
        return fmt::format("Ray tracing beats {} of the {} other rows on this device: all but {}.",
                           verdict.others - verdict.unbeaten.size(), verdict.others,
                           labels_of(verdict.unbeaten, ", "));
    return fmt::format("Ray tracing wins on this device: each of the {} other rows is beaten by a "
                       "ray-traced one.",
                       verdict.others);
}

} // namespace

std::vector<std::string> front_in_words(const Comparison& comparison) {
    const measure::Standing standing = measure::standing(comparison);
    if (standing.front.empty()) return {"No row could be judged, so there is no front."};
    std::vector<std::string> words{
        "On the front, by median time: " + figures_of(standing.front) +
        ". A row beats another where it is faster (the ratio of their times, round by round, is "
        "below 1 with 95 % confidence) and no farther off, or closer and not slower. Where that "
        "interval holds 1, or is not known, times are a tie."};
    for (const auto& [winner, losers] : standing.wins)
        words.push_back(winner->label + " beats " + figures_of(losers) + ".");
    if (!standing.beaten_by_beaten.empty())
        words.push_back("Beaten only by rows that are beaten themselves: " +
                        figures_of(standing.beaten_by_beaten) + ".");
    if (!standing.not_judged.empty())
        words.push_back("Not judged: " + labels_of(standing.not_judged, "; ") + ".");
    const std::string who = tracing_in_words(measure::tracing_verdict(comparison));
    if (!who.empty()) words.push_back(who);
    return words;
}

} // namespace catoptric::report
