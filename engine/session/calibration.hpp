#pragma once

#include "measure/costs.hpp"
#include "require/unit_costs.hpp"
#include "session/engine.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Calibrations: unit costs that `catoptric bench --calibrate` measured on a device of this
/// machine, in files of schema "catoptric/costs/1".
namespace catoptric::session {

/// Returns the costs by which `auto` compares plans for a device: those of its calibration in
/// `folder`, else those of require::find_unit_costs. Writes to `device` the file, or why an
/// existing file is not used. `folder`: empty for none.
require::DeviceUnitCosts choose_unit_costs(const std::filesystem::path& folder, DeviceInfo& device);

/// Returns the calibration that the engine's `auto` uses; none without one.
std::optional<measure::DeviceCosts> read_calibration(const Engine& engine);

/// Returns the text of measure::describe_balance for the calibration; empty without one.
std::string describe_balance(const Engine& engine);

/// Returns how costs name a device: name and driver.
std::string costs_device_name(const DeviceInfo& device);

} // namespace catoptric::session
