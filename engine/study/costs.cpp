// The study `costs`: the time that each row would take on another device, predicted from the row's
// counted work and the costs of that device.
#include "measure/costs.hpp"
#include "measure/rows.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "report/costs.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"
#include "study/row_times.hpp"
#include "study/study.hpp"
#include "study/work.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::study {

namespace {

using report::ReportTable;

constexpr const char* kCostsMetricName = "costs";

/// Returns "NAME (literature)". The name stands for a device's costs in all outputs.
std::string describe_costs(const measure::DeviceCosts& costs) {
    return costs.device + " (" + std::string(measure::cost_origin_name(costs.origin)) + ")";
}

bool contains(const std::vector<std::size_t>& list, std::size_t index) {
    return std::ranges::find(list, index) != list.end();
}

void set_costs(std::vector<report::Row>& rows, const std::vector<measure::DeviceCosts>& all) {
    std::vector<std::vector<measure::MetricParts>> lists(rows.size());
    for (const measure::DeviceCosts& costs : all) {
        const measure::PredictedFront front = measure::predict_front(
            costs, rows, find_row_times(rows, costs.device));
        for (std::size_t i = 0; i < rows.size(); ++i)
            lists[i].push_back(
                {"device",
                 describe_costs(costs),
                 {{"ms", front.times[i].ms},
                  {"low_ms", front.times[i].low},
                  {"high_ms", front.times[i].high},
                  {"on_front", contains(front.rows, i)},
                  {"on_front_if_rays_are_cheap", contains(front.rows_cheap_rays, i)},
                  {"on_front_if_rays_are_dear", contains(front.rows_dear_rays, i)}}});
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
        measure::set_study_metric(rows[i], kCostsMetricName, std::move(lists[i]));
}

void predict_row_times(const StudyInput& input) {
    std::vector<measure::DeviceCosts> all;
    for (const std::string& file : input.texts) {
        all.push_back(report::read_costs_file(file));
        const std::string name = describe_costs(all.back());
        check(std::ranges::count(all, name, describe_costs) == 1, Failure::usage, "--costs: '",
              name, "' is given twice");
    }
    count_work(input);
    set_costs(input.comparison.rows, all);
    input.tell();
}

/// Predicted times of a row on another device, as read back from the row's results.
struct CostCells {
    std::string device;
    double ms = 0, low = 0, high = 0;
    bool front = false, cheap = false, dear = false;
};

std::vector<CostCells> cost_cells(const report::Row& row) {
    std::vector<CostCells> cells;
    const measure::MetricValue value = measure::study_metric(row, kCostsMetricName);
    if (const auto* list = std::get_if<std::vector<measure::MetricParts>>(&value))
        for (const measure::MetricParts& parts : *list)
            cells.push_back(
                {parts.name, std::get<double>(parts.values[0].second),
                 std::get<double>(parts.values[1].second), std::get<double>(parts.values[2].second),
                 std::get<bool>(parts.values[3].second), std::get<bool>(parts.values[4].second),
                 std::get<bool>(parts.values[5].second)});
    return cells;
}

std::string format_cell(const CostCells& cells) {
    std::string text = report::format_ms(cells.ms);
    if (cells.low != cells.high)
        text += " [" + report::format_ms(cells.low) + "–" + report::format_ms(cells.high) + "]";
    return cells.front ? text + " *" : text;
}

std::vector<ReportTable> make_cost_tables(const report::Comparison& comparison) {
    ReportTable table{"Predicted time on other devices, ms",
                      {report::text_column("row"), "FLIP"},
                      "Counted work times the costs of each device, with the smallest and the "
                      "largest cost of its range; of another renderer's row, its own time "
                      "(--row-times). *: on the device's front of time and FLIP.",
                      {},
                      {}};
    for (const report::Row& row : comparison.rows) {
        const std::vector<CostCells> cells = cost_cells(row);
        if (cells.empty()) continue;
        if (table.rows.empty())
            for (const CostCells& device : cells) table.columns.emplace_back(device.device);
        table.rows.push_back({row.label, report::format_flip(row.error)});
        for (const CostCells& device : cells) table.rows.back().push_back(format_cell(device));
    }
    return {table};
}

/// Returns a sentence with the labels of the rows on the front (`is_on`), the fastest first, and
/// with the number of these rows that read captures or mirrored views.
std::string describe_front(const report::Comparison& comparison, std::size_t device,
                           bool CostCells::*is_on) {
    std::vector<std::pair<double, const report::Row*>> front;
    std::size_t captured = 0;
    for (const report::Row& row : comparison.rows) {
        const std::vector<CostCells> cells = cost_cells(row);
        if (device >= cells.size() || !(cells[device].*is_on)) continue;
        front.emplace_back(cells[device].ms, &row);
        captured += !measure::is_ray_traced(row);
    }
    std::ranges::stable_sort(front, {}, [](const auto& one) { return one.first; });
    std::vector<const report::Row*> rows;
    for (const auto& [ms, row] : front) rows.push_back(row);
    return fmt::format("{} ({} of {} not ray traced alone)", report::join_labels(rows), captured,
                       rows.size());
}

std::vector<std::string> describe_fronts(const report::Comparison& comparison) {
    std::vector<std::string> sentences;
    if (comparison.rows.empty()) return sentences;
    const std::vector<CostCells> devices = cost_cells(comparison.rows.front());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const std::string front = describe_front(comparison, i, &CostCells::front);
        const std::string cheap = describe_front(comparison, i, &CostCells::cheap);
        const std::string dear = describe_front(comparison, i, &CostCells::dear);
        std::string text = fmt::format("Front on {}: {}.", devices[i].device, front);
        if (cheap != front || dear != front)
            text += fmt::format(" If rays are cheap and other work is dear: {}. If rays are dear "
                                "and other work is cheap: {}.",
                                cheap, dear);
        sentences.push_back(std::move(text));
    }
    return sentences;
}

/// Returns a summary of a time that was not measured here. Two such times differ if their medians
/// differ, because the ends of both ranges depend on the same unknown unit costs.
measure::SampleSummary stated_time(const CostCells& time) {
    measure::SampleSummary summary{.median = time.ms, .p05 = time.low, .p95 = time.high};
    if (time.low < time.high) summary.ci95 = {time.low, time.high};
    summary.rounds.assign(measure::kMinIntervalSamples, time.ms);
    return summary;
}

std::vector<report::ComparisonOnDevice>
comparisons_elsewhere(const report::Comparison& comparison) {
    std::vector<report::ComparisonOnDevice> devices;
    if (comparison.rows.empty()) return devices;
    const std::vector<std::string> fronts = describe_fronts(comparison);
    for (std::size_t device = 0; device < fronts.size(); ++device) {
        report::ComparisonOnDevice& other = devices.emplace_back(report::ComparisonOnDevice{
            report::without_pictures(comparison), "predicted from counted work", fronts[device]});
        other.comparison.device = {};
        other.comparison.reference_gpu_ms.median = NAN;
        other.comparison.pareto.clear();
        for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
            const CostCells time = cost_cells(comparison.rows[i])[device];
            report::Row& row = other.comparison.rows[i];
            other.comparison.device.name = time.device;
            // These facts describe measured times only.
            row.moves = row.on_processor = row.noisy = false;
            row.gpu_ms = row.frame_ms = stated_time(time);
            if (time.front) other.comparison.pareto.push_back(i);
        }
        std::ranges::stable_sort(other.comparison.pareto, {}, [&](std::size_t i) {
            return other.comparison.rows[i].gpu_ms.median;
        });
    }
    return devices;
}

const RegisteredStudy kCostsStudy{
    {.name = "costs",
     .help = "also predict each row's time on another device from its counted work and the "
             "device's costs: a file, or a name of 'list costs'; may be repeated",
     .order = 50,
     .words = "COSTS",
     .check_words =
         [](const std::vector<std::string>& files) {
             for (const std::string& file : files) report::read_costs_file(file);
         },
     .prepare = show_work,
     .run = predict_row_times,
     .metrics = {{.name = kCostsMetricName,
                  .unit = "ms",
                  .help = "predicted time on each device of --costs, with the ends of its range",
                  .better = measure::BetterDirection::less,
                  .order = 790,
                  .get = measure::Metric::FromStudy{}}},
     .part = {.order = 700,
              .tables = make_cost_tables,
              .sentences = describe_fronts,
              .title = "Front of each device",
              .other_devices = comparisons_elsewhere}}};

} // namespace

} // namespace catoptric::study
