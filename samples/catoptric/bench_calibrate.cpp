// Calibrates the device: unit costs within a minute, by which `auto` then compares plans.
#include "bench_calibrate.hpp"

#include "bench_costs.hpp"
#include "benchmark/calibration.hpp"
#include "core/file.hpp"
#include "measure/calibration.hpp"
#include "measure/trade_map.hpp"
#include "output_checks.hpp"
#include "progress.hpp"
#include "report/costs.hpp"
#include "session/calibration.hpp"
#include "session/folders.hpp"
#include "session/usage.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::cli {

namespace {

/// Returns whether the costs of a card take this kind from measured costs.
bool is_measured_kind(WorkKind kind) {
    return measure::is_ray_work(kind) || kind == WorkKind::invocations;
}

measure::DeviceCosts known_costs(std::string_view name) {
    const auto& all = report::list_known_costs();
    const auto known = std::ranges::find(all, name, &report::KnownCosts::name);
    check(known != all.end(), Failure::internal, "no costs of '", name, "' in docs/costs");
    return report::read_device_costs(std::string(known->text), known->name);
}

/// Returns the costs of a device of this kind, from which a calibration
/// starts: a processor, or a card. Those of cards take rays and invocations from a card that
/// this program measured, and all else from the literature.
measure::DeviceCosts typical_costs(const session::DeviceInfo& device) {
    if (device.type == "cpu") return known_costs("llvmpipe-22.3");
    measure::DeviceCosts costs = known_costs("rtx-2080-ti");
    std::erase_if(costs.units,
                  [](const measure::UnitCost& unit) { return is_measured_kind(unit.kind); });
    for (const measure::UnitCost& unit : known_costs("h200").units)
        if (is_measured_kind(unit.kind)) costs.units.push_back(unit);
    return costs;
}

} // namespace

int calibrate_device(const CommonOptions& common, const std::string& output) {
    // Created before the driver's threads, to count them as well.
    const session::UsageMeter meter(session::UsageMeter::Threads::process);
    session::Engine engine(engine_options(common.device));
    print_device(engine, common.output_options);
    const std::filesystem::path place = choose_device_file(
        output, session::find_calibration_folder(), "calibration", engine.device());
    check_distinct({kStdoutPath, place}, {});
    ProgressPrinter progress(common.output_options);
    const measure::DeviceCosts costs = measure::calibrate_costs(
        session::costs_device_name(engine.device()),
        benchmark::measure_calibration_rows(engine, make_watcher(progress)),
        typical_costs(engine.device()));
    progress.clear();
    const std::string json = report::to_json(costs);
    const measure::Interval ratios = measure::prediction_error(costs);
    print_result(
        common.output_options.json
            ? json
            : costs_table(costs) +
                  fmt::format("a measured time is {:.2f} to {:.2f} times the predicted one "
                              "in 9 of 10 rows; {:.0f} s of processor time\n",
                              ratios.low, ratios.high, meter.read().cpu_ms / 1000));
    write_file(place, json);
    print_note(common.output_options, "written: " + place.string());
    if (common.device.validate) engine.check_validation();
    return 0;
}

} // namespace catoptric::cli
