// Writes report.json.
#include "report/json.hpp"

#include "core/mirror_id.hpp"
#include "core/text.hpp"
#include "measure/budget.hpp"
#include "measure/flip.hpp"
#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/lag.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <cmath>

namespace catoptric::report {

Json number_json(double value) {
    if (!std::isfinite(value)) return nullptr;
    constexpr double kMaxExactInteger = 9007199254740992; // 2^53
    if (std::abs(value) < kMaxExactInteger && value == std::trunc(value) && !std::signbit(value))
        return static_cast<std::int64_t>(value);
    return value;
}

Json number_json(const std::optional<double>& value) {
    return value ? number_json(*value) : Json();
}

Json numbers_json(const std::vector<double>& values) {
    return list_json(values, [](double value) { return number_json(value); });
}

Json interval_json(const measure::Interval& interval) {
    return interval.is_known()
               ? Json::array({number_json(interval.low), number_json(interval.high)})
               : Json();
}

std::string describe(const Json& value) {
    if (value.is_null()) return "nothing";
    if (value.is_structured()) return value.is_array() ? "a list" : "an object";
    return quote(value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

Json device_json(const DeviceFacts& device) {
    Json json{{"name", device.name},
              {"driver", device.driver},
              {"api", device.api},
              {"type", device.type},
              {"threads", device.threads}};
    if (device.lanes > 0) json["lanes"] = device.lanes;
    json["profile"] = device.profile.empty() ? Json() : Json(device.profile);
    if (!device.calibration.empty()) json["calibration"] = device.calibration;
    if (!device.balance.empty()) json["balance"] = device.balance;
    json["variants"] = Json::object();
    for (const auto& [name, choice] : device.variants) json["variants"][name] = choice;
    return json;
}

namespace {

Json to_json(const measure::SampleSummary& summary) {
    if (summary.n == 0) return nullptr; // never measured
    return {{"median", number_json(summary.median)},
            {"p05", number_json(summary.p05)},
            {"p95", number_json(summary.p95)},
            {"mad", number_json(summary.mad)},
            {"ci95", interval_json(summary.ci95)},
            {"rounds", numbers_json(summary.rounds)},
            {"n", summary.n},
            {"samples", numbers_json(summary.samples)}};
}

Json to_json(const measure::MetricParts& parts) {
    Json json{{parts.kind, parts.name}};
    for (const auto& [name, value] : parts.values) json[std::string(name)] = metric_json(value);
    return json;
}

struct JsonValueWriter {
    Json operator()(std::monostate) const { return nullptr; }
    Json operator()(bool mark) const { return mark; }
    Json operator()(double value) const { return number_json(value); }
    Json operator()(const dvec3& colour) const { return point_json(colour); }
    Json operator()(const measure::PixelPosition& place) const {
        return place.x < 0 ? Json(nullptr) : Json::array({place.x, place.y});
    }
    Json operator()(const measure::SampleSummary& times) const { return to_json(times); }
    Json operator()(const std::vector<double>& list) const { return numbers_json(list); }
    Json operator()(const std::vector<measure::MetricParts>& list) const {
        return list_json(list, [](const measure::MetricParts& parts) { return to_json(parts); });
    }
};

/// Returns an object that begins with `json` and has all metrics of a difference.
Json add_difference(Json json, const measure::Difference& error) {
    for (const measure::Metric& metric : measure::difference_metrics())
        json[std::string(metric.name)] = metric_json(measure::metric_value(metric, error));
    return json;
}

Json labels_json(const std::vector<const Row*>& rows) {
    return list_json(rows, [](const Row* row) { return Json(row->label); });
}

/// Returns the answers of the first sentence as lists of rows.
Json verdict_json(const Comparison& comparison) {
    const measure::RayTracingVerdict tracing = measure::find_ray_tracing_verdict(comparison);
    const measure::FastestRows fastest = measure::find_fastest_rows(comparison);
    return {{"text", summarise_verdict(comparison)},
            {"fastest", labels_json(fastest.rows)},
            {"fastest_are_equal", fastest.are_equal},
            {"ray_tracing",
             {{"beats", labels_json(tracing.beaten)},
              {"does_not_beat", labels_json(tracing.unbeaten)},
              {"cannot_tell", labels_json(tracing.open)}}}};
}

/// Returns the budgets, and the labels of the rows that answer them.
Json budget_json(const Comparison& comparison) {
    const measure::BestRows answer = measure::find_best_rows(comparison);
    const auto label = [](const Row* row) { return row == nullptr ? Json() : Json(row->label); };
    std::vector<const Row*> ties = answer.equal;
    ties.insert(ties.end(), answer.open.begin(), answer.open.end());
    return {{"max_ms", number_json(comparison.max_ms)},
            {"max_flip", number_json(comparison.max_flip)},
            {"max_rmse", number_json(comparison.max_rmse)},
            {"row", label(answer.row)},
            {"ties", labels_json(ties)},
            {"cannot_tell", labels_json(answer.open)},
            {"undecided", labels_json(answer.undecided)},
            {"nearest", label(answer.nearest)},
            {"text", describe_budget(comparison)}};
}

/// Adds a metric to an object of metrics. The object is null as long as none of its metrics has a
/// value.
void add_metric(Json& json, const measure::Metric& metric, const measure::MetricValue& value) {
    const std::size_t slash = metric.name.find('/');
    Json& object = json[std::string(metric.name.substr(0, slash))];
    if (object.is_null() && measure::is_missing(value)) return;
    if (object.is_null() && !metric.mask.empty()) object["mask"] = metric.mask;
    object[std::string(metric.name.substr(slash + 1))] = metric_json(value);
}

void add_metric(Json& json, const measure::Metric& metric, const Row& row) {
    const measure::MetricValue value = measure::metric_value(metric, row);
    const bool* mark = std::get_if<bool>(&value);
    if (metric.only_where_true && mark != nullptr && !*mark) return;
    if (metric.name.find('/') != std::string_view::npos)
        add_metric(json, metric, value);
    else
        json[std::string(metric.name)] = metric_json(value);
}

/// Adds all metrics of the table to a row. Metrics of differences are written together, at the
/// place of the first of them.
void add_row_metrics(Json& json, const Comparison& comparison, const Row& row) {
    for (const measure::Metric& metric : measure::metrics()) {
        if (!measure::is_shown(metric, comparison)) continue;
        if (metric.mask != "each")
            add_metric(json, metric, row);
        else if (!json.contains("error"))
            add_errors(json, row);
    }
}

Json to_json(const std::vector<Setting>& settings) {
    Json json = Json::object();
    for (const Setting& setting : settings)
        json[setting.name] = setting.number ? number_json(*setting.number) : Json(setting.text);
    return json;
}

Json to_json(const measure::CulledWork& work) {
    return {{"what", work.what},
            {"why", work.why},
            {"saves", work.saves},
            {"error", number_json(work.error)}};
}

Json to_json(const Comparison& comparison, const Row& row) {
    Json json{{"technique", row.technique}, {"settings", to_json(row.settings)}};
    json["label"] = row.label;
    json["model"] = row.model;
    json["left_out"] = list_json(row.left_out,
                                 [](const measure::CulledWork& work) { return to_json(work); });
    add_row_metrics(json, comparison, row);
    json["views"] = views_json(comparison, row);
    json["plan"] = plan_json(row.plan);
    json["image"] = image_path(comparison, row.image + ".png");
    json["is_reference"] = row.is_reference;
    return json;
}

Json to_json(const SetupFacts& setup) {
    return {{"load_ms", number_json(setup.load_ms)},
            {"upload_ms", number_json(setup.upload_ms)},
            {"hierarchy_ms", number_json(setup.hierarchy_ms)},
            {"compile_ms", number_json(setup.compile_ms)},
            {"pipelines", setup.pipelines},
            {"pipeline_cache", setup.pipeline_cache}};
}

void add_circumstances(Json& json, const Comparison& comparison) {
    json["device"] = device_json(comparison.device);
    json["device"]["held_threads"] = comparison.device.held_threads;
    json["scene"] = scene_json(comparison.scene);
    json["setup"] = to_json(measure::read_setup_facts(comparison));
    json["size"] = Json::array({comparison.width, comparison.height});
    json["frames"] = comparison.frames;
    json["warmup"] = comparison.warmup;
    json["rounds"] = comparison.rounds;
    json["timing"] = comparison.timing;
    json["load"] = Json::array(
        {number_json(comparison.load_start), number_json(comparison.load_end)});
    json["time"] = number_json(comparison.time);
    json["ambient"] = number_json(comparison.ambient);
    json["exposure"] = number_json(comparison.exposure);
    json["flip_source"] = measure::kFlipSourceFloats;
    json["together"] = comparison.together;
    json["warnings"] = comparison.warnings;
}

Json to_json(const measure::ReferenceNoise& noise) {
    return {{"frames", noise.frames},
            {"rays", noise.rays},
            {"wanted_rays", noise.wanted_rays},
            {"seconds", number_json(noise.seconds)},
            {"most_seconds", number_json(noise.most_seconds)},
            {"flip_floor", number_json(noise.flip_floor)},
            {"wanted_floor", number_json(noise.wanted_floor)},
            {"halves_rmse", number_json(noise.halves_rmse)},
            {"predicted_rmse", number_json(noise.predicted_rmse)}};
}

} // namespace

Json point_json(const dvec3& point) {
    return Json::array({number_json(point.x), number_json(point.y), number_json(point.z)});
}

Json plan_json(const std::vector<PlanEntry>& plan) {
    return list_json(plan, [](const PlanEntry& entry) {
        return Json{{"mirror", entry.mirror},
                    {"name", entry.name},
                    {"technique", entry.technique},
                    {"settings", to_json(entry.settings)},
                    {"why", entry.why}};
    });
}

Json row_times_json(const Row& row) {
    Json json = Json::object();
    for (const measure::Metric& metric : measure::metrics())
        if (metric.unit == "ms" && metric.study.empty()) add_metric(json, metric, row);
    return json;
}

Json metric_json(const measure::MetricValue& value) { return std::visit(JsonValueWriter{}, value); }

Json report_json(const Comparison& comparison) {
    Json json{{"schema", "catoptric/compare/1"}, {"version", comparison.version},
              {"commit", comparison.commit},     {"date", comparison.date},
              {"command", comparison.command},   {"complete", comparison.complete}};
    if (!comparison.complete) {
        json["incomplete"] = describe_incomplete_run(comparison);
        json["rows_asked"] = comparison.asked;
    }
    add_circumstances(json, comparison);
    json["reference"] = {{"technique", comparison.reference_technique},
                         {"settings", to_json(comparison.reference_settings)},
                         {"label", comparison.reference_label},
                         {"gpu_ms", to_json(comparison.reference_gpu_ms)}};
    json["reference"]["area_flip"] = number_json(comparison.reference_area_flip);
    if (comparison.noise) json["reference"]["noise"] = to_json(*comparison.noise);
    if (comparison.path_distance)
        json["reference"]["path_distance"] = path_distance_json(*comparison.path_distance);
    if (comparison.clear_ms) json["clear_ms"] = to_json(*comparison.clear_ms);
    json["model"] = comparison.model;
    json["views"] = views_json(comparison);
    json["rows"] = list_json(comparison.rows,
                             [&](const Row& row) { return to_json(comparison, row); });
    json["pareto"] = comparison.pareto;
    json["judged_time"] = measure::judged_time(comparison);
    json["verdict"] = verdict_json(comparison);
    if (measure::has_budget(comparison)) json["budget"] = budget_json(comparison);
    if (comparison.lag) json["lag"] = lag_json(comparison);
    return json;
}

void add_errors(Json& json, const measure::Errors& errors) {
    for (const measure::RowMask& mask : measure::row_masks())
        json[std::string(mask.field)] = add_difference({{"mask", mask.name}}, errors.*mask.error);
    Json& list = json["error_per_mirror"] = Json::array();
    for (std::size_t i = 0; i < errors.error_per_mirror.size(); ++i)
        list.push_back(add_difference({{"mirror", MirrorId::from_index(i).number()}},
                                      errors.error_per_mirror[i]));
}

std::string serialise(const Json& document) {
    // Names from files may contain any bytes. ASCII output cannot hold control sequences for a
    // terminal.
    return document.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

std::string to_json(const Comparison& comparison) { return serialise(report_json(comparison)); }

} // namespace catoptric::report
