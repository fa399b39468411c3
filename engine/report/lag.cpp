// Writes the lag of rows with history into reports, as JSON, tables, sentences and plots.
#include "measure/lag.hpp"
#include "report/chart.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/plot.hpp"
#include "report/report_part.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::report {

namespace {

using measure::Difference;
using measure::percentile_over_instants;

constexpr auto kFlipMember = &Difference::flip;

Json to_json(const SettlingAfterCut& settling) {
    return {{"rmse_settled", number_json(settling.rmse_settled)},
            {"max_settled", number_json(settling.max_settled)},
            {"rmse", numbers_json(settling.rmse)},
            {"max", numbers_json(settling.max)}};
}

/// Adds each headline metric of each instant, and its mean. Names begin with `prefix`.
void add_lag_metrics(Json& json, const std::string& prefix, const std::vector<Difference>& errors) {
    for (const auto& [name, figure] :
         {std::pair("flip", &Difference::flip), std::pair("off", &Difference::off),
          std::pair("mae", &Difference::mae), std::pair("rmse", &Difference::rmse)}) {
        json[prefix + name + "_mean"] = number_json(measure::mean_over_instants(errors, figure));
        json[prefix + name] = numbers_json(measure::values_at_instants(errors, figure));
    }
}

Json to_json(const LagAtSpeed& at) {
    Json json{{"speed", number_json(at.speed)}};
    add_lag_metrics(json, "", at.errors);
    for (const auto& [name, figure] :
         {std::pair("flip", &Difference::flip), std::pair("rmse", &Difference::rmse)}) {
        const std::string prefix(name);
        json[prefix + "_median"] = number_json(
            measure::percentile_over_instants(at.errors, figure, .5));
        json[prefix + "_max"] = number_json(
            measure::percentile_over_instants(at.errors, figure, 1));
    }
    add_lag_metrics(json, "reference_", at.reference_errors);
    return json;
}

/// Returns the field "worst" of a row: null, or where the lag is largest, with the names of its
/// pictures.
Json worst_lag_json(const Comparison& comparison, const LagRow& row) {
    if (!row.worst) return nullptr;
    Json json{{"speed", number_json(row.worst->speed)},
              {"seconds", number_json(row.worst->seconds)},
              {"flip", number_json(row.worst->flip)}};
    const std::string name = find_lag_image(comparison, row);
    if (name.empty()) return json;
    for (const std::string_view ending : kLagPictureNames)
        json[std::string(ending.substr(1))] = image_path(comparison,
                                                         name + std::string(ending) + ".exr");
    return json;
}

Json to_json(const Comparison& comparison, const LagRow& row) {
    Json json{{"label", row.label},
              {"still_frames", row.still_frames},
              {"restless_stills", row.restless_stills},
              {"after_black", to_json(row.after_black)},
              {"after_jump", to_json(row.after_jump)}};
    add_lag_metrics(json, "still_reference_", row.still_reference_errors);
    json["worst"] = worst_lag_json(comparison, row);
    json["speeds"] = list_json(row.speeds, [](const LagAtSpeed& at) { return to_json(at); });
    return json;
}

std::string format_speed(double speed) { return fmt::format("{:g}x", speed); }

std::string format_frame_count(const std::optional<int>& frames, int cap) {
    return frames ? std::to_string(*frames) : fmt::format("over {}", cap);
}

std::string describe_lag_limits(const LagResults& lag) {
    std::string note = fmt::format(
        "The scene's time runs at so many times the clock's, 60 frames a second, over a path of "
        "{:.3g} s. Errors over the mirrors between the moving picture and the still one of the "
        "same row and instant (the scene stands until nothing changes any more), mean of {} "
        "instants; s: when FLIP is largest. Right: FLIP against the reference, moving and still.",
        lag.path, lag.seconds.size());
    if (!std::isnan(lag.reference_flip_floor))
        note += fmt::format(" Two references of the first instant with different random rays "
                            "differ by a FLIP of {}. Rows tie whose FLIP against the reference "
                            "differs by less.",
                            format_error(lag.reference_flip_floor));
    if (lag.reference_rays < lag.wanted_reference_rays)
        note += fmt::format(" The reference has {} instead of {} rays for each point of a rough "
                            "surface, which fit into --reference-seconds.",
                            lag.reference_rays, lag.wanted_reference_rays);
    for (const LagRow& row : lag.rows)
        if (row.restless_stills > 0)
            note += fmt::format(" {}: {} stills still changed after {} frames.", row.label,
                                row.restless_stills, lag.frame_cap);
    return note;
}

/// Returns the FLIP of lag over all instants as text: mean, median and largest.
std::array<std::string, 3> format_flip_values(const LagAtSpeed& at) {
    return {format_error(measure::mean_over_instants(at.errors, kFlipMember)),
            format_error(percentile_over_instants(at.errors, kFlipMember, .5)),
            format_error(percentile_over_instants(at.errors, kFlipMember, 1))};
}

std::vector<std::string> lag_cells(const LagResults& lag, const LagRow& row, const LagAtSpeed& at) {
    const auto mean = [&](double Difference::*figure) {
        return measure::mean_over_instants(at.errors, figure);
    };
    const auto flip_to_reference = [](const std::vector<Difference>& errors) {
        return format_error(measure::mean_over_instants(errors, kFlipMember));
    };
    const auto [flip, median, largest] = format_flip_values(at);
    return {row.label,
            format_speed(at.speed),
            flip,
            format_fixed(100 * mean(&Difference::off), 2),
            format_error(mean(&Difference::mae)),
            format_error(mean(&Difference::rmse)),
            median,
            largest,
            format_fixed(measure::find_worst_instant(lag, at), 2),
            flip_to_reference(at.reference_errors),
            flip_to_reference(row.still_reference_errors)};
}

std::string describe_row_lag(const LagRow& row) {
    std::vector<std::string> parts;
    for (const LagAtSpeed& at : row.speeds) {
        const auto [flip, median, largest] = format_flip_values(at);
        parts.push_back(fmt::format("{} (median {}, largest {}) at {}", flip, median, largest,
                                    format_speed(at.speed)));
    }
    return row.label + " is behind its own still picture by a FLIP of " + join_texts(parts, ", ");
}

std::string describe_settling(const LagRow& row, int cap) {
    const auto counts = [&](const SettlingAfterCut& settling) {
        return fmt::format("{} by rmse, {} in every pixel",
                           format_frame_count(settling.rmse_settled, cap),
                           format_frame_count(settling.max_settled, cap));
    };
    return fmt::format("after a cut from black it is within 1/255 from frame {}; after a jump of "
                       "half the path from frame {}",
                       counts(row.after_black), counts(row.after_jump));
}

std::string lag_along_path(const LagResults& lag, const LagRow& row) {
    LineChart chart{.x_name = "instant of the scene, s",
                    .y_name = "FLIP to the still picture",
                    .says = "Lag of " + row.label + " along the path, one line a speed",
                    .x = lag.seconds};
    for (const double share : {0.0, 0.25, 0.5, 0.75})
        chart.x_ticks.push_back(lag.seconds.front() + share * lag.path);
    std::erase_if(chart.x_ticks, [&](double tick) { return tick > lag.seconds.back(); });
    for (const LagAtSpeed& at : row.speeds)
        chart.lines.push_back(
            {format_speed(at.speed), measure::values_at_instants(at.errors, kFlipMember)});
    return html_chart(chart);
}

std::string lag_by_speed(const LagResults& lag) {
    LineChart chart{.x_name = "speed of the scene's time",
                    .y_name = "FLIP to the still picture, mean",
                    .says = "Mean lag against speed, one line a row",
                    .log_x = true};
    for (const LagAtSpeed& at : lag.rows.front().speeds) chart.x.push_back(at.speed);
    chart.x_ticks = chart.x;
    for (const LagRow& row : lag.rows) {
        ChartLine& line = chart.lines.emplace_back(ChartLine{row.label, {}});
        for (const LagAtSpeed& at : row.speeds)
            line.y.push_back(measure::mean_over_instants(at.errors, kFlipMember));
    }
    return html_chart(chart);
}

std::string settling_curves(const LagResults& lag) {
    constexpr std::size_t kMaxShownFrames = 10; // number of frames shown
    LineChart chart{.x_name = "frame after a jump of half the path",
                    .y_name = "rmse to the still picture",
                    .says = "Error of the frames after a jump, one line a row"};
    for (const LagRow& row : lag.rows) {
        ChartLine& line = chart.lines.emplace_back(ChartLine{row.label, row.after_jump.rmse});
        line.y.resize(std::min(kMaxShownFrames, line.y.size()));
        for (std::size_t i = chart.x.size(); i < line.y.size(); ++i)
            chart.x.push_back(static_cast<double>(i + 1));
    }
    chart.x_ticks = chart.x;
    return html_chart(chart);
}

std::string lag_figure(const std::string& drawing, const std::string& caption) {
    if (drawing.empty()) return "";
    return "<figure>" + drawing + "<figcaption>" + escape_html(caption) + "</figcaption></figure>";
}

} // namespace

Json lag_json(const Comparison& comparison) {
    const LagResults& lag = *comparison.lag;
    return {
        {"mask", "mirrors"},
        {"complete", lag.complete},
        {"path_seconds", number_json(lag.path)},
        {"jump_from", number_json(lag.jump_from)},
        {"frame_cap", lag.frame_cap},
        {"reference_flip_floor", number_json(lag.reference_flip_floor)},
        {"reference_rays", lag.reference_rays},
        {"seconds", numbers_json(lag.seconds)},
        {"without_history", lag.without_history},
        {"rows", list_json(lag.rows, [&](const LagRow& row) { return to_json(comparison, row); })}};
}

ReportTable lag_table(const Comparison& comparison) {
    ReportTable table{"Lag: the moving scene",
                      {text_column("Row"), "Speed", "FLIP", "off, %", "MAE", "rmse", "FLIP, median",
                       "FLIP, largest", "s", "to reference, moving", "to reference, still"},
                      ""};
    if (!comparison.lag) return table;
    table.note = describe_lag_limits(*comparison.lag);
    for (const LagRow& row : comparison.lag->rows)
        for (const LagAtSpeed& at : row.speeds)
            table.rows.push_back(lag_cells(*comparison.lag, row, at));
    return table;
}

ReportTable settling_table(const Comparison& comparison) {
    ReportTable table{"Lag: frames after a cut",
                      {text_column("Row"), "from black, rmse", "from black, every pixel",
                       "after a jump, rmse", "after a jump, every pixel"},
                      ""};
    if (!comparison.lag) return table;
    const LagResults& lag = *comparison.lag;
    table.note = fmt::format(
        "The first frame, from 1, from which on the picture is within 1/255 of the still one: by "
        "the rmse over the mirrors, and in the largest channel difference of any mirror pixel. A "
        "jump: from t = {:.3g} s to {:.3g} s. Given {} frames.",
        lag.jump_from, lag.seconds.empty() ? 0 : lag.seconds.front(), lag.frame_cap);
    for (const LagRow& row : lag.rows)
        table.rows.push_back({row.label,
                              format_frame_count(row.after_black.rmse_settled, lag.frame_cap),
                              format_frame_count(row.after_black.max_settled, lag.frame_cap),
                              format_frame_count(row.after_jump.rmse_settled, lag.frame_cap),
                              format_frame_count(row.after_jump.max_settled, lag.frame_cap)});
    return table;
}

std::optional<std::string> describe_lag(const Comparison& comparison) {
    if (!comparison.lag) return {};
    const LagResults& lag = *comparison.lag;
    std::vector<std::string> sentences;
    for (const LagRow& row : lag.rows)
        if (!row.speeds.empty())
            sentences.push_back(describe_row_lag(row) + "; " +
                                describe_settling(row, lag.frame_cap));
    if (!lag.without_history.empty())
        sentences.push_back("Left out, since their frames read nothing of the frame before and "
                            "have no lag: " +
                            join_texts(lag.without_history, ", "));
    if (sentences.empty()) return {};
    return "Lag: the seed report sees no difference between parts one and two; that holds while the "
           "scene stands. " +
           join_texts(sentences, ". ") + ".";
}

std::string lag_plots(const Comparison& comparison) {
    if (!comparison.lag || comparison.lag->rows.empty()) return "";
    const LagResults& lag = *comparison.lag;
    std::string html = "<section><h2>Lag</h2><div class=\"panels\">";
    for (const LagRow& row : lag.rows)
        html += lag_figure(lag_along_path(lag, row),
                           row.label + " along the path, one line a speed");
    html += lag_figure(lag_by_speed(lag), "Mean over the path against speed");
    html += lag_figure(settling_curves(lag), "Frames after a cut");
    return html + "</div><p class=\"note\">All against the still picture of the same row and "
                  "instant, over the mirrors. The lane below is 0.</p></section>\n";
}

const RegisteredPart kLagPart{
    {.name = "lag",
     .order = 500,
     .tables =
         [](const Comparison& comparison) {
             return std::vector{lag_table(comparison), settling_table(comparison)};
         },
     .look = "lag",
     .plots = lag_plots}};

} // namespace catoptric::report
