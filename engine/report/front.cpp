// The Pareto front in words, without favour.
#include "report/findings.hpp"
#include "report/rows.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::report {

namespace {

std::string figures(const Row& row) {
    return fmt::format("{} ({} ms, FLIP {}{})", row.label, ms_text(row.gpu_ms.median),
                       error_text(row.error.flip), row.mirrors_black ? ", its mirrors black" : "");
}

std::vector<const Row*> front_rows(const Comparison& comparison) {
    std::vector<const Row*> rows;
    for (const std::size_t index : comparison.pareto)
        if (index < comparison.rows.size()) rows.push_back(&comparison.rows[index]);
    return rows;
}

/// The first row on the front that beats this one; null when none does.
const Row* winner_over(const std::vector<const Row*>& front, const Row& loser) {
    const auto found = std::ranges::find_if(front,
                                            [&](const Row* row) { return beats(*row, loser); });
    return found == front.end() ? nullptr : *found;
}

/// One sentence for each row on the front that is the first to beat others; rows that were not
/// judged, and those that only rows beat that are beaten themselves.
std::vector<std::string> losers(const Comparison& comparison,
                                const std::vector<const Row*>& front) {
    std::vector<std::string> sentences;
    for (const Row* winner : front) {
        std::vector<std::string> names;
        for (const Row& row : comparison.rows)
            if (!on_front(comparison, row) && winner_over(front, row) == winner)
                names.push_back(figures(row));
        if (!names.empty())
            sentences.push_back(winner->label + " beats " + joined(names, "; ") + ".");
    }
    std::vector<std::string> beaten, not_judged;
    for (const Row& row : comparison.rows) {
        if (!judged(&row))
            not_judged.push_back(row.label);
        else if (!on_front(comparison, row) && winner_over(front, row) == nullptr)
            beaten.push_back(figures(row));
    }
    if (!beaten.empty())
        sentences.push_back(
            "Beaten only by rows that are beaten themselves: " + joined(beaten, "; ") + ".");
    if (!not_judged.empty()) sentences.push_back("Not judged: " + joined(not_judged, "; ") + ".");
    return sentences;
}

/// Whether tracing rays beats everything else.
std::string verdict(const Comparison& comparison) {
    std::size_t others = 0;
    std::vector<std::string> unbeaten;
    for (const Row& row : comparison.rows) {
        if (is_ray_traced(row) || !judged(&row) || row.mirrors_black) continue;
        ++others;
        if (std::ranges::none_of(comparison.rows, [&](const Row& other) {
                return is_ray_traced(other) && beats(other, row);
            }))
            unbeaten.push_back(row.label);
    }
    if (others == 0 || std::ranges::none_of(comparison.rows, is_ray_traced)) return "";
    if (unbeaten.size() == others)
        return "No ray-traced row beats any of the others on this device.";
    if (!unbeaten.empty())
        return fmt::format("Ray tracing beats {} of the {} other rows on this device: all but {}.",
                           others - unbeaten.size(), others, joined(unbeaten, ", "));
    return fmt::format("Ray tracing wins on this device: each of the {} other rows is beaten by a "
                       "ray-traced one.",
                       others);
}

} // namespace

std::vector<std::string> front_in_words(const Comparison& comparison) {
    const std::vector<const Row*> front = front_rows(comparison);
    if (front.empty()) return {"No row could be judged, so there is no front."};
    std::vector<std::string> names;
    for (const Row* row : front) names.push_back(figures(*row));
    std::vector<std::string> words{
        "On the front, by median time: " + joined(names, "; ") +
        ". A row beats another where it is faster (their bands from the 5th to the 95th percentile "
        "do not "
        "overlap) and no farther off, or closer and not slower; bands that overlap are a tie."};
    const std::vector<std::string> beaten = losers(comparison, front);
    words.insert(words.end(), beaten.begin(), beaten.end());
    const std::string who = verdict(comparison);
    if (!who.empty()) words.push_back(who);
    return words;
}

} // namespace catoptric::report
