#pragma once

#include "core/plan_entry.hpp"
#include "measure/quantity.hpp"
#include "report/comparison.hpp"

#include <nlohmann/json.hpp>

// The parts of JSON files; for those who write them only.
namespace catoptric::report {

using Json = nlohmann::ordered_json;

/// Whole numbers without a fraction, null for what JSON has no number for.
Json number(double value);
/// What a quantity came to; null where it says nothing.
Json value_json(const measure::Value& value);
/// The field "lag".
Json to_json(const Lag& lag);

/// The field "views": of the comparison, a list; of a row, null where none were drawn.
Json views_json(const Comparison& comparison);
Json views_json(const Row& row);
Json point_json(const dvec3& point);
Json camera_json(const measure::CameraFacts& camera);

/// A list with an object for each mirror: mirror, name, technique, settings, why.
Json plan_json(const std::vector<PlanEntry>& plan);

} // namespace catoptric::report
