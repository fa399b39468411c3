#pragma once

#include "core/frame_facts.hpp"
#include "measure/lag.hpp"
#include "measure/metric.hpp"
#include "report/comparison.hpp"

#include <nlohmann/json.hpp>

// Parts of JSON files. No installed header includes this one. New versions of a file add fields and
// never remove any.
namespace catoptric::report {

using Json = nlohmann::ordered_json;

/// Returns report.json of one scene.
Json report_json(const Comparison& comparison);
/// Returns the document as ASCII text that ends with a newline.
std::string serialise(const Json& document);

/// Return a number: integers without a fraction, and null if JSON cannot hold the value or if there
/// is none.
Json number_json(double value);
Json number_json(const std::optional<double>& value);
/// Returns a list with `entry` of each item.
template <class List, class Entry>
Json list_json(const List& list, Entry entry) {
    Json json = Json::array();
    for (const auto& item : list) json.push_back(entry(item));
    return json;
}
Json numbers_json(const std::vector<double>& values);
/// Returns the list [low, high], or null if the interval is not known.
Json interval_json(const measure::Interval& interval);
/// Describes a value for a message: "nothing", "a list", or its JSON in quotes.
std::string describe(const Json& value);
Json device_json(const DeviceFacts& device);
/// Returns all fields of a row with the unit milliseconds, as in report.json.
Json row_times_json(const Row& row);
/// Adds a field for each mask of pixels with all metrics of a difference, and "error_per_mirror".
void add_errors(Json& json, const measure::Errors& errors);
/// Returns null if the metric has no value.
Json metric_json(const measure::MetricValue& value);
Json path_distance_json(const measure::PathDistance& distance);
/// Returns the field "lag" of a comparison whose lag was measured.
Json lag_json(const Comparison& comparison);

/// Return the field "views": a list for a comparison; for a row, null if no views were drawn.
Json views_json(const Comparison& comparison);
Json views_json(const Comparison& comparison, const Row& row);
Json point_json(const dvec3& point);
Json camera_json(const measure::CameraFacts& camera);
/// Return the lists of lights and unsupported features, and the environment or null.
Json lights_json(const std::vector<LightFacts>& lights);
Json environment_json(const std::optional<EnvironmentFacts>& environment);
Json unsupported_json(const std::vector<UnsupportedFeatureFacts>& unsupported);
Json scene_json(const SceneFacts& scene);

/// Returns a list with one object a mirror: mirror, name, technique, settings, why.
Json plan_json(const std::vector<PlanEntry>& plan);

} // namespace catoptric::report
