#pragma once

#include "app/run.hpp"

#include <string>

/// What a request's picture requires of mirrors and lights, what is left out and why, and which
/// plan suits it (require/), at its instant. No device is asked.
namespace catoptric::app {

/// For the user to read.
std::string why_text(const Request& request);
/// The same as {"schema": "catoptric/why/1", "mirrors": [...], "lights": [...], "left_out": [...],
/// "suggested": PLAN}, with a newline.
std::string why_json(const Request& request);

} // namespace catoptric::app
