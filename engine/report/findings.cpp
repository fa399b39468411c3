#include "report/tables.hpp"

#include "measure/findings.hpp"
#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/lag.hpp"
#include "measure/seed_report.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace catoptric::report {

namespace {

using OptionalSentence = std::optional<std::string>;

std::string format_percent(double share) {
    return format_fixed(100 * share, share < 0.1 ? 1 : 0) + " %";
}

std::string format_rmse(const Row& row) { return format_error(row.error.rmse); }

std::string format_times(const Row& a, const Row& b) {
    return format_ms(a.time_ms().median) + " against " + format_ms(b.time_ms().median) + " ms";
}
/// Says that two times are equal, or that it cannot be told which of them is less.
const char* describe_time_tie(measure::Order order) {
    return order == measure::Order::equal
               ? ": equal within 5 %"
               : ": round by round neither is the faster, they are not told apart";
}

/// Returns " (95 %: 1.10 to 1.25)", for example, or an empty text if the interval is not known.
std::string format_ratio(const measure::Interval& ratio) {
    if (!ratio.is_known()) return "";
    return fmt::format(" (95 %: {:.3g} to {:.3g})", ratio.low, ratio.high);
}

OptionalSentence describe_dielectrics(const Comparison& comparison) {
    const auto finding = measure::find_undrawn_dielectrics(comparison);
    if (!finding) return {};
    const std::string tracing = join_labels(finding->tracing);
    return fmt::format(
        "Not drawn: {} of the pixels show smooth surfaces that are no mirrors, and no row{} draws "
        "what they reflect. Over these pixels the other rows' FLIP is {} at best ({}). "
        "--dielectric-mirrors makes mirrors of such surfaces.",
        format_percent(finding->share), tracing.empty() ? "" : " but " + tracing,
        format_error(finding->best->error_dielectrics.flip), finding->best->label);
}

std::string describe_clear_verdict(const measure::ClearCost& finding) {
    switch (finding.verdict) {
    case measure::ClearCost::Verdict::slower_without:
        return "part one is slower without any clear, so clearing alone does not explain the order "
               "on this device";
    case measure::ClearCost::Verdict::too_little:
        return "added to part one that still leaves it no slower than part two, so clearing alone "
               "does not explain the report's order on this device";
    case measure::ClearCost::Verdict::explains: break;
    }
    return fmt::format(
        "added to part one that would put it {} behind part two (the report: {}), so "
        "clearing alone does explain the order on this device",
        format_percent(finding.gap), format_percent(measure::kSeedReportClearCostShare));
}

OptionalSentence describe_clear_cost(const Comparison& comparison) {
    using measure::kSeedReportNaiveRow, measure::kSeedReportReuseRow;
    const auto finding = measure::find_clear_cost(comparison);
    if (!finding) return {};
    const char* order = finding->one_is_slower ? "slower than" : "not slower than";
    std::string text = fmt::format("Clears: the report's part one without inter-reflections took "
                                   "{:.1f} ms more than its part two ({:.1f} against {:.1f} ms), "
                                   "which it puts down to clearing the cube maps. Here part one, "
                                   "{}, is {} part two ({})",
                                   measure::kSeedReportClearMs, kSeedReportNaiveRow.ms,
                                   kSeedReportReuseRow.ms, finding->one->label, order,
                                   format_ms(finding->one->elapsed_ms().median) + " against " +
                                       format_ms(finding->two->elapsed_ms().median) + " ms");
    if (!finding->clear_ms) return text + "; what a clear costs was not measured.";
    return text + ". Clearing the cubes of all mirrors costs " + format_ms(*finding->clear_ms) +
           " ms: " + describe_clear_verdict(*finding) + ".";
}

OptionalSentence describe_distance_formats(const Comparison& comparison) {
    const auto finding = measure::find_distance_format(comparison);
    if (!finding) return {};
    std::string text = "Stored distance: rmse over the mirrors is " + format_rmse(*finding->plain) +
                       " without correction, " + format_rmse(*finding->full) +
                       " corrected with 32-bit distances";
    if (finding->near != nullptr)
        text += ", " + format_rmse(*finding->near) +
                " with 8 bits up to 200 units as in the report";
    if (finding->far != nullptr)
        text += ", " + format_rmse(*finding->far) + " with 8 bits up to 1000 units";
    if (finding->near == nullptr) return text + ".";
    if (finding->near_is_worse)
        return text +
               ". With the report's range the correction makes the picture worse than none, so "
               "its figure 7 cannot have been made that way in these units.";
    return text +
           ". With the report's range the correction still helps, so its figure 7 may have been "
           "made that way.";
}

OptionalSentence describe_bounces(const Comparison& comparison) {
    const auto finding = measure::find_bounces_result(comparison);
    if (!finding) return {};
    std::vector<std::string> figures;
    for (const Row* row : finding->steps) figures.push_back(format_rmse(*row));
    std::string text = fmt::format(
        "Inter-reflections: with i = 1 to {} the rmse of part one over the mirrors is {}. ",
        finding->steps.size(), join_texts(figures, ", "));
    if (finding->helps)
        return text + "More inter-reflections bring it closer to the reference, by " +
               format_error(finding->fall) + " in all.";
    text +=
        "From i = 1 on, more of them bring it no closer to the reference by as much as one 8-bit "
        "step (1/255)";
    if (finding->dominated_by != nullptr)
        text +=
            ": parallax dominates what is left, and no number of inter-reflections repairs it (" +
            format_rmse(*finding->dominated_by) + " once corrected)";
    return text + ".";
}

OptionalSentence describe_parallax_price(const Comparison& comparison) {
    const auto finding = measure::find_parallax_price(comparison);
    if (!finding) return {};
    std::string text = fmt::format(
        "Price of the correction: in the seed report, part three takes {:.1f} ms instead of {:.1f} ms, "
        "and the complexity of its code is the only drawback that is named. Here part three takes ",
        measure::kSeedReportParallaxRow.ms, measure::kSeedReportReuseRow.ms);
    const std::string times = format_times(*finding->three, *finding->two);
    if (finding->is_tie())
        text += "as long as part two (" + times + describe_time_tie(finding->order) + ")";
    else
        text += format_percent(std::abs(finding->more)) + (finding->more < 0 ? " less" : " more") +
                " time than part two (" + times + "), " + format_ms(1 + finding->more) +
                " times as much" + format_ratio(finding->ratio_ci95);
    if (finding->more_bytes > 0)
        text += fmt::format(" and {} MiB more memory for the distances",
                            format_mebibytes(finding->more_bytes));
    return text + ".";
}

OptionalSentence describe_tracing_time(const Comparison& comparison) {
    using measure::kSeedReportParallaxRow, measure::kSeedReportRayTracingRow;
    const auto finding = measure::find_ray_tracing_time(comparison);
    if (!finding) return {};
    const Row &three = *finding->three, &traced = *finding->traced;
    std::string text = fmt::format("Ray tracing: in the report it takes {:.1f} times as long as "
                                   "part three ({:.1f} against {:.1f} ms); here {} takes ",
                                   measure::kSeedReportRayTracingRatio, kSeedReportRayTracingRow.ms,
                                   kSeedReportParallaxRow.ms, traced.label);
    const std::string times = format_times(traced, three);
    if (finding->is_tie())
        text += "as long as " + three.label + " (" + times + describe_time_tie(finding->order) +
                ")";
    else
        text += format_ms(finding->ratio) + " times as long" + format_ratio(finding->ratio_ci95) +
                " as " + three.label + " (" + times + ")";
    return text + ".";
}

std::string format_metrics(const Row& row) {
    if (!measure::has_known_time(row))
        return fmt::format("{} (FLIP {})", row.label, format_flip(row.error));
    return fmt::format("{} ({} ms, FLIP {})", row.label, format_ms(row.time_ms().median),
                       format_flip(row.error));
}

std::string format_metrics(const std::vector<const Row*>& rows) {
    std::vector<std::string> texts;
    for (const Row* row : rows) texts.push_back(format_metrics(*row));
    return join_texts(texts, "; ");
}

/// Returns the fastest rows in words, or how many rows may be the fastest.
std::string describe_fastest(const measure::FastestRows& fastest) {
    if (fastest.rows.size() == 1) return "fastest is " + fastest.rows.front()->label;
    if (fastest.are_equal)
        return "fastest are " + join_labels(fastest.rows) + ", whose times are equal";
    return fmt::format("{} of {} rows may be fastest", fastest.rows.size(), fastest.candidates);
}

std::string describe_fastest_and_closest(const Comparison& comparison) {
    const measure::FastestRows fastest = measure::find_fastest_rows(comparison);
    if (fastest.rows.empty()) return "no row could be judged";
    std::string text = (fastest.are_equal ? "" : "cannot tell: ") + describe_fastest(fastest);
    if (const Row* closest = measure::find_closest_row(comparison))
        text += ", closest is " + format_metrics(*closest);
    if (const std::vector<const Row*> ties = measure::find_closest_ties(comparison); !ties.empty())
        text += ", with which tie in FLIP: " + join_labels(ties);
    return text;
}

/// Returns a sentence that says which rows ray tracing beats. Empty if all rows are of the same
/// kind.
std::string describe_tracing(const Comparison& comparison) {
    const measure::RayTracingVerdict verdict = measure::find_ray_tracing_verdict(comparison);
    const std::size_t others = verdict.others();
    if (others == 0 || !verdict.any_traced) return "";
    if (verdict.beaten.size() == others)
        return fmt::format("ray tracing beats every other row, {} of {}", others, others);
    if (verdict.unbeaten.size() == others) return "no ray-traced row beats any other row";
    if (verdict.open.size() == others)
        return "cannot tell whether ray tracing beats another row: " +
               describe_fastest(measure::find_fastest_rows(comparison));
    const std::string beaten = fmt::format("beats {} of the {} other rows", verdict.beaten.size(),
                                           others),
                      unbeaten = join_labels(verdict.unbeaten),
                      open = "cannot tell for " + join_labels(verdict.open);
    if (verdict.beaten.empty())
        return fmt::format("ray tracing does not beat {}; {}", unbeaten, open);
    if (verdict.unbeaten.empty()) return fmt::format("ray tracing {}; {}", beaten, open);
    if (verdict.open.empty()) return fmt::format("ray tracing {}: all but {}", beaten, unbeaten);
    return fmt::format("ray tracing {}, and not {}; {}", beaten, unbeaten, open);
}

} // namespace

std::string findings_title(const Comparison& comparison) {
    return comparison.scene.is_seed ? "What this says of the seed report" : "What this says";
}

std::vector<std::string> list_findings(const Comparison& comparison) {
    struct ReportFinding {
        OptionalSentence (*say)(const Comparison&);
        /// Compares with the seed report's numbers, so it applies to that report's scene only.
        bool beside_the_report;
    };
    std::vector<std::string> list;
    for (const auto& [say, beside_the_report] : {ReportFinding{describe_dielectrics, false},
                                                 {describe_clear_cost, true},
                                                 {describe_bounces, false},
                                                 {describe_distance_formats, true},
                                                 {describe_parallax_price, true},
                                                 {describe_tracing_time, true},
                                                 {describe_lag, false}}) {
        if (beside_the_report && !comparison.scene.is_seed) continue;
        if (const OptionalSentence sentence = say(comparison)) list.push_back(*sentence);
    }
    return list;
}

std::string summarise_verdict(const Comparison& comparison, const std::string& where) {
    const std::string tracing = describe_tracing(comparison);
    return where + describe_judged_time(comparison) + ", " +
           (tracing.empty() ? describe_fastest_and_closest(comparison) : tracing) + ".";
}

std::string summarise_verdict(const Comparison& comparison) {
    return summarise_verdict(comparison, "On this device, " + comparison.device.name);
}

std::vector<std::string> describe_front(const Comparison& comparison) {
    const measure::RowRanking standing = measure::rank_rows(comparison);
    if (standing.front.empty()) return {"No row could be judged, so there is no front."};
    std::vector<std::string> words{
        std::string("On the front, by median ") +
        (measure::judged_time(comparison) == "cpu_ms" ? "processor " : "") +
        "time: " + format_metrics(standing.front) +
        ". A row beats another if it is better in time or in FLIP, and in the other better as well "
        "or equal. Times are equal if the 95 % interval of their ratio, round by round, lies within "
        "5 %, and one is better if that interval excludes 1. FLIP is equal within .002. Where an "
        "interval is too wide for either, there is no verdict."};
    if (comparison.noise)
        words.push_back("The reference has noise. FLIP is also equal within " +
                        format_error(comparison.noise->flip_floor) +
                        ", the FLIP between its halves.");
    if (!standing.open.empty())
        words.push_back("On the front, but whether another row beats them cannot be told: " +
                        join_labels(standing.open) + ".");
    for (const auto& [winner, losers] : standing.wins)
        words.push_back(winner->label + " beats " + format_metrics(losers) + ".");
    if (!standing.beaten_by_beaten.empty())
        words.push_back("Beaten only by rows that are beaten themselves: " +
                        format_metrics(standing.beaten_by_beaten) + ".");
    if (!standing.black.empty())
        words.push_back(
            "Not on the front and not beaten, since their mirrors are black: " +
            format_metrics(standing.black) +
            ". Their time is a lower bound for any technique that draws the same scene.");
    if (!standing.untimed.empty())
        words.push_back("Not on the front, since their time is not known: " +
                        format_metrics(standing.untimed) + ".");
    if (!standing.not_judged.empty())
        words.push_back("Not judged: " + join_labels(standing.not_judged, "; ") + ".");
    return words;
}

} // namespace catoptric::report
