#pragma once

#include "require/unit_costs.hpp"
#include "session/run.hpp"

#include <string>

/// Functions that report which captures and shadow maps a request's picture requires, what is left
/// out and why, and which plan suits the picture (require/). Only `measure_capture_budget` needs a
/// device.
namespace catoptric::session {

/// `costs`: of the device for which a plan is suggested. `capture_budget`: only if there is a
/// budget.
std::string culling_to_text(const Request& request, const require::DeviceUnitCosts& costs,
                            const std::optional<CaptureBudget>& capture_budget = {});
/// Returns the report as JSON with a final newline: {"schema": "catoptric/why/1", "mirrors": [...],
/// "lights": [...], "left_out": [...], "not_drawn": [...], "suggested": PLAN, "candidates": [...],
/// "unit_costs": TEXT, "captures": CAPTURE_BUDGET or null}.
std::string culling_to_json(const Request& request, const require::DeviceUnitCosts& costs,
                            const std::optional<CaptureBudget>& capture_budget = {});
/// Renders a few frames and returns how many captures fit into the request's budget. Returns
/// nothing if no captures are kept.
std::optional<CaptureBudget> measure_capture_budget(Engine& engine, const Request& request);

} // namespace catoptric::session
