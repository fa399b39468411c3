#include "report/lag_tables.hpp"

#include "report/text.hpp"

#include <fmt/format.h>

namespace catoptric::report {

namespace {

using measure::Difference;
using measure::percentile_of;

std::string speed_text(double speed) { return fmt::format("{:g}x", speed); }

std::string count_text(const std::optional<int>& frames, int cap) {
    return frames ? std::to_string(*frames) : fmt::format("over {}", cap);
}

std::string lag_note(const Lag& lag) {
    std::string note = fmt::format(
        "The scene's time runs at so many times the clock's, 60 frames a second, over a path of "
        "{:.3g} s. "
        "Errors over the mirrors between the moving picture and the still one of the same row and "
        "instant (the scene stands until nothing changes any more), mean of {} instants; s: when "
        "FLIP is largest. Right: FLIP against the reference, moving and still.",
        lag.path, lag.seconds.size());
    for (const LagRow& row : lag.rows)
        if (row.restless_stills > 0)
            note += fmt::format(" {}: {} stills still changed after {} frames.", row.label,
                                row.restless_stills, lag.frame_cap);
    return note;
}

std::vector<std::string> line_of(const Lag& lag, const LagRow& row, const LagAtSpeed& at) {
    const auto mean = [&](double Difference::*figure) {
        return measure::mean_of(at.errors, figure);
    };
    const auto flip_to_reference = [](const std::vector<Difference>& errors) {
        return error_text(measure::mean_of(errors, &Difference::flip));
    };
    return {row.label,
            speed_text(at.speed),
            error_text(mean(&Difference::flip)),
            fixed(100 * mean(&Difference::off), 2),
            error_text(mean(&Difference::mae)),
            error_text(mean(&Difference::rmse)),
            error_text(percentile_of(at.errors, &Difference::flip, .5)),
            error_text(percentile_of(at.errors, &Difference::flip, 1)),
            fixed(measure::worst_instant(lag, at), 2),
            flip_to_reference(at.reference_errors),
            flip_to_reference(row.still_reference_errors)};
}

std::string behind(const LagRow& row) {
    std::vector<std::string> parts;
    for (const LagAtSpeed& at : row.speeds)
        parts.push_back(fmt::format("{} (median {}, largest {}) at {}",
                                    error_text(measure::mean_of(at.errors, &Difference::flip)),
                                    error_text(percentile_of(at.errors, &Difference::flip, .5)),
                                    error_text(percentile_of(at.errors, &Difference::flip, 1)),
                                    speed_text(at.speed)));
    return row.label + " is behind its own still picture by a FLIP of " + joined(parts, ", ");
}

std::string settles(const LagRow& row, int cap) {
    const auto counts = [&](const Settling& settling) {
        return fmt::format("{} by rmse, {} in every pixel", count_text(settling.rmse_settled, cap),
                           count_text(settling.max_settled, cap));
    };
    return fmt::format("after a cut from black it is within 1/255 from frame {}; after a jump of "
                       "half the path from frame {}",
                       counts(row.after_black), counts(row.after_jump));
}

} // namespace

Table lag_table(const Comparison& comparison) {
    Table table{"Lag: the moving scene",
                {{"Row", false},
                 {"Speed"},
                 {"FLIP"},
                 {"off, %"},
                 {"MAE"},
                 {"rmse"},
                 {"FLIP, median"},
                 {"FLIP, largest"},
                 {"s"},
                 {"to reference, moving"},
                 {"to reference, still"}},
                {},
                {},
                ""};
    if (!comparison.lag) return table;
    table.note = lag_note(*comparison.lag);
    for (const LagRow& row : comparison.lag->rows)
        for (const LagAtSpeed& at : row.speeds)
            table.rows.push_back(line_of(*comparison.lag, row, at));
    return table;
}

Table settling_table(const Comparison& comparison) {
    Table table{"Lag: frames after a cut",
                {{"Row", false},
                 {"from black, rmse"},
                 {"from black, every pixel"},
                 {"after a jump, rmse"},
                 {"after a jump, every pixel"}},
                {},
                {},
                ""};
    if (!comparison.lag) return table;
    const Lag& lag = *comparison.lag;
    table.note = fmt::format(
        "The first frame, from 1, from which on the picture is within 1/255 of the still one: by "
        "the rmse over the mirrors, and in the largest channel difference of any mirror pixel. A "
        "jump: from t = {:.3g} s to {:.3g} s. Given {} frames.",
        lag.jump_from, lag.seconds.empty() ? 0 : lag.seconds.front(), lag.frame_cap);
    for (const LagRow& row : lag.rows)
        table.rows.push_back({row.label, count_text(row.after_black.rmse_settled, lag.frame_cap),
                              count_text(row.after_black.max_settled, lag.frame_cap),
                              count_text(row.after_jump.rmse_settled, lag.frame_cap),
                              count_text(row.after_jump.max_settled, lag.frame_cap)});
    return table;
}

std::optional<std::string> lag_in_words(const Comparison& comparison) {
    if (!comparison.lag) return {};
    const Lag& lag = *comparison.lag;
    std::vector<std::string> sentences;
    for (const LagRow& row : lag.rows)
        if (!row.speeds.empty())
            sentences.push_back(behind(row) + "; " + settles(row, lag.frame_cap));
    if (!lag.without_history.empty())
        sentences.push_back("Left out, since their frames read nothing of the frame before and "
                            "have no lag: " +
                            joined(lag.without_history, ", "));
    if (sentences.empty()) return {};
    return "Lag: the report sees no difference between parts one and two; that holds while the "
           "scene stands. " +
           joined(sentences, ". ") + ".";
}

} // namespace catoptric::report
