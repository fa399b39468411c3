// The study `map`: the fastest row on any device, at any size of the picture, and at any number of
// frames between two drawings of the captures, computed from counted work and unit costs.
#include "measure/judge.hpp"
#include "measure/rows.hpp"
#include "measure/trade_map.hpp"
#include "measure/work.hpp"
#include "report/chart.hpp"
#include "report/costs.hpp"
#include "report/html.hpp"
#include "report/text.hpp"
#include "session/calibration.hpp"
#include "session/watcher.hpp"
#include "session/work.hpp"
#include "study/study.hpp"
#include "study/work.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::study {

namespace {

using report::Json;
using report::ReportTable;

constexpr const char* kWorkAtRestName = "work_at_rest";
constexpr double kUsualMaxFlip = .05;
/// Frames after which nothing changes at rest: as many as `compare --model required` warms up.
constexpr int kFramesToRest = 28;

/// Frames between two drawings of the captures for which the table states the fastest row.
constexpr double kStatedPeriods[] = {1, 8, std::numeric_limits<double>::infinity()};

/// Returns the costs of this device's calibration and of the files that the user names.
std::vector<measure::DeviceCosts> find_own_costs(const StudyInput& input) {
    std::vector<measure::DeviceCosts> devices;
    if (auto calibration = session::read_calibration(input.engine)) {
        calibration->device += ", calibrated";
        devices.push_back(std::move(*calibration));
    }
    for (const StudyChoice& choice : input.request.studies)
        if (choice.name == "costs")
            for (const std::string& file : choice.texts)
                devices.push_back(report::read_costs_file(file));
    return devices;
}

void count_rest(const StudyInput& input) {
    input.comparison.own_costs = std::make_shared<std::vector<measure::DeviceCosts>>(
        find_own_costs(input));
    count_work(input);
    std::vector<report::Row>& rows = input.comparison.rows;
    for (std::size_t i = 0; i < input.request.base.techniques.size(); ++i) {
        report_row(input.request.watcher, rows[i].label + ": work at rest", i, rows.size());
        Request request = input.request.base;
        request.techniques = {input.request.base.techniques[i]};
        request.model = RenderedWork::required;
        request.animate = false;
        request.warmup = kFramesToRest;
        const WorkCounts rest = sum_work(
            count_frame_work(input.session, request, input.request.watcher));
        measure::MetricParts parts{"frame", "at rest", {}};
        for (std::size_t kind = 0; kind < kWorkKindCount; ++kind)
            if (rest.values[kind].value_or(0) > 0)
                parts.values.emplace_back(kWorkKinds[kind].name,
                                          static_cast<double>(*rest.values[kind]));
        measure::set_study_metric(rows[i], kWorkAtRestName, std::vector{std::move(parts)});
        input.tell();
    }
}

/// Returns the counts that `count_rest` set; none for a row without them.
std::optional<measure::MapWork> read_work(const report::Row& row) {
    const measure::MetricValue value = measure::study_metric(row, kWorkAtRestName);
    const auto* list = std::get_if<std::vector<measure::MetricParts>>(&value);
    if (list == nullptr || list->empty() || !measure::has_counted_work(row)) return std::nullopt;
    measure::MapWork work{measure::total_work(row), {}};
    for (const auto& [name, count] : list->front().values)
        for (std::size_t kind = 0; kind < kWorkKindCount; ++kind)
            if (kWorkKinds[kind].name == name)
                work.rest.values[kind] = static_cast<std::uint64_t>(std::get<double>(count));
    return work;
}

std::vector<std::optional<measure::MapWork>> list_work(const report::Comparison& comparison) {
    std::vector<std::optional<measure::MapWork>> work;
    for (const report::Row& row : comparison.rows) work.push_back(read_work(row));
    return work;
}

/// Returns the devices of the map: those of this comparison, then all others of docs/costs.
std::vector<measure::DeviceCosts> list_devices(const report::Comparison& comparison) {
    std::vector<measure::DeviceCosts> devices;
    if (comparison.own_costs) devices = *comparison.own_costs;
    for (const report::KnownCosts& known : report::list_known_costs()) {
        measure::DeviceCosts costs = report::read_device_costs(std::string(known.text), known.name);
        if (std::ranges::find(devices, costs.device, &measure::DeviceCosts::device) ==
            devices.end())
            devices.push_back(std::move(costs));
    }
    return devices;
}

double max_flip_of(const report::Comparison& comparison) {
    return std::isnan(comparison.max_flip) ? kUsualMaxFlip : comparison.max_flip;
}

std::string describe_best(const report::Comparison& comparison,
                          const std::vector<std::optional<measure::MapWork>>& work,
                          const measure::DeviceCosts& costs, double period) {
    const measure::MapPoint point{.period = period};
    const std::optional<std::size_t> best = measure::map_best(costs, comparison.rows, work, point,
                                                              max_flip_of(comparison));
    if (!best) return std::string(report::kEmptyCell);
    return comparison.rows[*best].label + ", " +
           report::format_ms(measure::map_time(costs, *work[*best], point).ms) + " ms";
}

std::vector<ReportTable> make_map_tables(const report::Comparison& comparison) {
    ReportTable table{
        fmt::format("Fastest row with FLIP of at most {} by device", max_flip_of(comparison)),
        {report::text_column("device"), report::text_column("captures in each frame"),
         report::text_column("each 8th frame"), report::text_column("at rest")},
        "Counted work of a frame that draws all captures, and of a frame at rest, times the costs "
        "of each device. report.html has the map: any device, size and number of frames between "
        "captures.",
        {},
        {}};
    const std::vector<std::optional<measure::MapWork>> work = list_work(comparison);
    if (std::ranges::none_of(work, [](const auto& one) { return one.has_value(); })) return {table};
    for (const measure::DeviceCosts& costs : list_devices(comparison)) {
        table.rows.push_back(
            {costs.device + " (" + std::string(measure::cost_origin_name(costs.origin)) + ")"});
        for (const double period : kStatedPeriods)
            table.rows.back().push_back(describe_best(comparison, work, costs, period));
    }
    return {table};
}

Json kinds_json() {
    Json kinds = Json::array();
    for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) {
        const auto id = static_cast<WorkKind>(kind);
        kinds.push_back({{"name", kWorkKinds[kind].name},
                         {"is_ray", measure::is_ray_work(id)},
                         {"is_raster", measure::is_raster_work(id)},
                         {"grows", measure::grows_with_pixels(id)}});
    }
    return kinds;
}

Json device_json(const measure::DeviceCosts& costs) {
    Json units = Json::array();
    for (const measure::UnitCost& unit : costs.units)
        units.push_back({{"kind", static_cast<std::size_t>(unit.kind)},
                         {"ns", unit.ns},
                         {"low", unit.range.is_known() ? unit.range.low : unit.ns},
                         {"high", unit.range.is_known() ? unit.range.high : unit.ns}});
    return {{"name", costs.device},
            {"origin", measure::cost_origin_name(costs.origin)},
            {"note", costs.note},
            {"units", std::move(units)}};
}

Json counts_json(const WorkCounts& counts) {
    Json list = Json::array();
    for (const std::optional<std::uint64_t>& count : counts.values)
        list.push_back(count.value_or(0));
    return list;
}

/// Returns HTML of the map. The page's script fills it (report/page/map.js).
std::string html_map(const report::Comparison& comparison) {
    Json rows = Json::array(), devices = Json::array();
    for (const report::Row& row : comparison.rows)
        if (const std::optional<measure::MapWork> work = read_work(row);
            work && measure::is_rankable(row))
            rows.push_back({{"label", row.label},
                            {"flip", row.error.flip},
                            {"is_traced", measure::is_ray_traced(row)},
                            {"drawn", counts_json(work->drawn)},
                            {"rest", counts_json(work->rest)}});
    if (rows.empty()) return "";
    for (const measure::DeviceCosts& costs : list_devices(comparison))
        devices.push_back(device_json(costs));
    const Json data{{"width", comparison.width},     {"height", comparison.height},
                    {"kinds", kinds_json()},         {"rows", std::move(rows)},
                    {"devices", std::move(devices)}, {"max_flip", max_flip_of(comparison)}};
    return report::titled_section("Which row on which device", std::string(report::kMapOpening) +
                                                                   report::data_script(data) +
                                                                   "</div>");
}

const RegisteredStudy kMapStudy{
    {.name = "map",
     .help = "also map the fastest row over devices, sizes of the picture and frames between "
             "captures, computed from counted work",
     .order = 60,
     .prepare = show_work,
     .run = count_rest,
     .metrics = {{.name = kWorkAtRestName,
                  .help = "counted work of one frame at rest, which keeps its captures",
                  .better = measure::BetterDirection::less,
                  .order = 780,
                  .get = measure::Metric::FromStudy{}}},
     .part = {.order = 710, .tables = make_map_tables, .plots = html_map}}};

} // namespace

} // namespace catoptric::study
