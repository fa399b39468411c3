#pragma once

#include "app/run.hpp"

#include <string>

/// What a request's picture requires of mirrors and lights, what is left out and why, and which
/// plan suits it (require/), at its instant. No device is asked, but for `measured_slices`.
namespace catoptric::app {

/// For the user to read. `slices`: where there is a budget.
std::string why_text(const Request& request, const std::optional<CaptureBudget>& slices = {});
/// The same as {"schema": "catoptric/why/1", "mirrors": [...], "lights": [...], "left_out": [...],
/// "not_drawn": [...], "suggested": PLAN, "captures": what `slices` say or null}, with a newline.
std::string why_json(const Request& request, const std::optional<CaptureBudget>& slices = {});
/// How many captures fit into the request's budget, by a few frames that are rendered for it; none
/// where no captures are kept.
std::optional<CaptureBudget> measured_slices(Engine& engine, const Request& request);

} // namespace catoptric::app
