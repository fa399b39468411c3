#include "session/calibration.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "measure/balance.hpp"
#include "report/costs.hpp"
#include "session/access.hpp"
#include "session/lanes.hpp"
#include "session/profile.hpp"

namespace catoptric::session {

namespace fs = std::filesystem;

namespace {

require::DeviceUnitCosts read_calibration(const fs::path& file, const DeviceInfo& device) {
    const measure::DeviceCosts found = report::read_costs_file(file);
    check(found.device == costs_device_name(device), Failure::bad_data, file.string(),
          ": is another device's or driver's calibration: wanted ",
          quote(costs_device_name(device)), ", found ", quote(found.device));
    require::DeviceUnitCosts costs{
        .costs = {.file = file.filename().string(),
                  .device = found.device,
                  .origin = std::string(measure::cost_origin_name(found.origin)),
                  .ns = {}},
        .note = "calibration of this device"};
    for (const measure::UnitCost& unit : found.units) costs.costs.ns[unit.kind] = unit.ns;
    return costs;
}

} // namespace

std::string costs_device_name(const DeviceInfo& device) {
    return device.name + ", " + device.driver;
}

std::optional<measure::DeviceCosts> read_calibration(const Engine& engine) {
    const require::UnitCosts& found = Access::unit_costs(engine).costs;
    if (engine.device().calibration.empty()) return std::nullopt;
    measure::DeviceCosts costs{.device = found.device, .origin = measure::CostOrigin::fitted};
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        if (found.ns.values[i] > 0)
            costs.units.push_back(
                {static_cast<WorkKind>(i), found.ns.values[i], {}, "calibration"});
    return costs;
}

std::string describe_balance(const Engine& engine) {
    const std::optional<measure::DeviceCosts> costs = read_calibration(engine);
    const std::optional<measure::Balance> balance = costs ? measure::find_balance(
                                                                *costs, count_lanes(engine))
                                                          : std::nullopt;
    return balance ? measure::describe_balance(*balance) : "";
}

require::DeviceUnitCosts choose_unit_costs(const fs::path& folder, DeviceInfo& device) {
    const auto shipped = [&] {
        return require::find_unit_costs(device.name, device.driver, device.type == "cpu");
    };
    if (folder.empty()) return shipped();
    const fs::path file = folder / profile_file_name(device);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(file, error))) return shipped();
    try {
        require::DeviceUnitCosts costs = read_calibration(file, device);
        device.calibration = file.filename().string();
        return costs;
    } catch (const Error& refused) {
        device.warning += std::string(device.warning.empty() ? "" : "; ") + refused.what() +
                          "; 'auto' compares plans by the costs of docs/costs ('bench --calibrate' "
                          "writes a new calibration)";
        return shipped();
    }
}

} // namespace catoptric::session
