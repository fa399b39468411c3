#pragma once

#include "core/plan_entry.hpp"
#include "measure/metric.hpp"
#include "report/comparison.hpp"

#include <nlohmann/json.hpp>

// The parts of JSON files; for those who write them only.
namespace catoptric::report {

using Json = nlohmann::ordered_json;

/// report.json of one scene.
Json document_of(const Comparison& comparison);
/// In ASCII, with a newline at its end.
std::string written(const Json& document);

/// Whole numbers without a fraction, null for what JSON has no number for.
Json number(double value);
/// Low and high; null where it is not known.
Json interval_json(const measure::Interval& interval);
/// A value that was read, for a message: "nothing", "a list", as JSON in quotes.
std::string shown(const Json& value);
/// The field "device".
Json device_json(const DeviceFacts& device);
/// What a row's frames took, milliseconds: its fields of that unit, as report.json has them.
Json times_json(const Row& row);
/// What a quantity came to; null where it says nothing.
Json value_json(const measure::Value& value);
/// The field "lag".
Json to_json(const Lag& lag);

/// The field "views": of the comparison, a list; of a row, null where none were drawn.
Json views_json(const Comparison& comparison);
Json views_json(const Comparison& comparison, const Row& row);
Json point_json(const dvec3& point);
Json camera_json(const measure::CameraFacts& camera);
/// Lists, and null for no environment.
Json lights_json(const std::vector<LightFacts>& lights);
Json environment_json(const std::optional<EnvironmentFacts>& environment);
Json unsupported_json(const std::vector<UnsupportedFeatureFacts>& unsupported);
/// The field "scene".
Json scene_json(const SceneFacts& scene);

/// A list with an object for each mirror: mirror, name, technique, settings, why.
Json plan_json(const std::vector<PlanEntry>& plan);

} // namespace catoptric::report
