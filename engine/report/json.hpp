#pragma once

#include "report/lag.hpp"

#include <nlohmann/json.hpp>

// The parts of report.json; for the files json*.cpp only.
namespace catoptric::report {

using Json = nlohmann::ordered_json;

/// Whole numbers without a fraction, null for what JSON has no number for.
Json number(double value);
/// The field "lag".
Json to_json(const Lag& lag);

} // namespace catoptric::report
