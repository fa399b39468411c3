// The part "Time by pass" of reports.
#include "report/pass_times.hpp"

#include "report/report_part.hpp"
#include "report/text.hpp"

#include <algorithm>

namespace catoptric::report {

namespace {

std::string find_pass_kind(const std::string& pass) { return pass.substr(0, pass.find('/')); }

std::vector<ReportTable> pass_time_tables(const Comparison& comparison) {
    const StackedBars bars = pass_time_bars(comparison);
    ReportTable table{"Time by pass, ms",
                      {text_column("Row")},
                      "Medians of the device's time. Passes of one kind are summed, such as those "
                      "that draw captures."};
    for (const BarPartKind& kind : bars.kinds) table.columns.emplace_back(kind.name);
    for (const StackedBar& bar : bars.bars) {
        std::vector<std::string>& cells = table.rows.emplace_back();
        cells.push_back(bar.label);
        for (const double ms : bar.lengths)
            cells.push_back(ms > 0 ? format_ms(ms) : std::string(kEmptyCell));
    }
    return {table};
}

std::string pass_time_plot(const Comparison& comparison) {
    const std::string svg = draw_bars(pass_time_bars(comparison));
    if (svg.empty()) return "";
    return "<div class=\"plot scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Time by pass\">" +
           svg + "</div>";
}

const RegisteredPart kPassTimesPart{
    {.name = "pass times", .order = 60, .tables = pass_time_tables, .plots = pass_time_plot}};

} // namespace

StackedBars pass_time_bars(const Comparison& comparison) {
    StackedBars chart{.x_name = "Device time of the passes of a frame, medians, ms",
                      .says = "Bars of each row's time by kind of pass; the figures are in the "
                              "table of times by pass"};
    for (const Row& row : comparison.rows)
        for (const PassFacts& pass : row.passes) {
            const std::string kind = find_pass_kind(pass.name);
            if (std::ranges::find(chart.kinds, kind, &BarPartKind::name) == chart.kinds.end())
                chart.kinds.push_back({kind, bar_colour(chart.kinds.size())});
        }
    for (const Row& row : comparison.rows) {
        if (row.passes.empty()) continue;
        StackedBar& bar = chart.bars.emplace_back();
        bar.label = row.label;
        bar.lengths.resize(chart.kinds.size());
        for (const PassFacts& pass : row.passes) {
            const auto kind = std::ranges::find(chart.kinds, find_pass_kind(pass.name),
                                                &BarPartKind::name);
            bar.lengths[static_cast<std::size_t>(kind - chart.kinds.begin())] += pass.gpu_ms.median;
        }
    }
    return chart;
}

} // namespace catoptric::report
