// The Pareto front in words, by the same rules for all rows.
#include "measure/judge.hpp"
#include "report/findings.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

namespace catoptric::report {

namespace {

std::string figures(const Row& row) {
    return fmt::format("{} ({} ms, FLIP {})", row.label, ms_text(row.time_ms().median),
                       error_text(row.error.flip));
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

/// Returns whether ray tracing beats the other rows. Empty if only one of the two kinds is there.
std::string tracing_in_words(const measure::TracingVerdict& verdict) {
    if (verdict.others == 0 || !verdict.any_traced) return "";
    if (verdict.unbeaten.size() == verdict.others) return "no ray-traced row beats any other row";
    if (!verdict.unbeaten.empty())
        return fmt::format("ray tracing beats {} of the {} other rows: all but {}",
                           verdict.others - verdict.unbeaten.size(), verdict.others,
                           labels_of(verdict.unbeaten, ", "));
    return fmt::format("ray tracing beats every other row, {} of {}", verdict.others,
                       verdict.others);
}

/// Returns the fastest and the closest rows in words.
std::string ends_in_words(const Comparison& comparison) {
    const std::vector<const Row*> fastest = measure::fastest_rows(comparison);
    if (fastest.empty()) return "no row could be judged";
    std::string text = "fastest is " + labels_of(fastest, " or ");
    if (const Row* closest = measure::closest_row(comparison))
        text += ", closest is " + figures(*closest);
    return text;
}

} // namespace

std::string verdict_in_words(const Comparison& comparison) {
    const std::string tracing = tracing_in_words(measure::tracing_verdict(comparison));
    return "On this device, " + comparison.device.name + ", " +
           (tracing.empty() ? ends_in_words(comparison) : tracing) + ".";
}

std::vector<std::string> front_in_words(const Comparison& comparison) {
    const measure::Ranking standing = measure::ranking_of(comparison);
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
    if (!standing.black.empty())
        words.push_back("Not on the front and not beaten, since their mirrors are black: " +
                        figures_of(standing.black) +
                        ". Their time is a lower bound for any "
                        "technique that draws the same scene.");
    if (!standing.not_judged.empty())
        words.push_back("Not judged: " + labels_of(standing.not_judged, "; ") + ".");
    return words;
}

} // namespace catoptric::report
