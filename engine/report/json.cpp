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

Json make_number_json(double value) {
    if (!std::isfinite(value)) return nullptr;
    constexpr double kMaxExactInteger = 9007199254740992; // 2^53
    if (std::abs(value) < kMaxExactInteger && value == std::trunc(value) && !std::signbit(value))
        return static_cast<std::int64_t>(value);
    return value;
}

Json make_number_json(const std::optional<double>& value) {
    return value ? make_number_json(*value) : Json();
}

Json make_number_list_json(const std::vector<double>& values) {
    return make_list_json(values, [](double value) { return make_number_json(value); });
}

Json make_interval_json(const measure::Interval& interval) {
    return interval.is_known()
               ? Json::array({make_number_json(interval.low), make_number_json(interval.high)})
               : Json();
}

std::string describe(const Json& value) {
    if (value.is_null()) return "nothing";
    if (value.is_structured()) return value.is_array() ? "a list" : "an object";
    return quote(value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

Json make_device_json(const DeviceFacts& device) {
    Json json{{"name", device.name},
              {"driver", device.driver},
              {"api", device.api},
              {"type", device.type},
              {"threads", device.threads}};
    if (device.lanes > 0) json["lanes"] = device.lanes;
    json["profile"] = device.profile.empty() ? Json() : Json(device.profile);
    json["variants"] = Json::object();
    for (const auto& [name, choice] : device.variants) json["variants"][name] = choice;
    return json;
}

namespace {

Json to_json(const measure::SampleSummary& summary) {
    if (summary.n == 0) return nullptr; // never measured
    return {{"median", make_number_json(summary.median)},
            {"p05", make_number_json(summary.p05)},
            {"p95", make_number_json(summary.p95)},
            {"mad", make_number_json(summary.mad)},
            {"ci95", make_interval_json(summary.ci95)},
            {"rounds", make_number_list_json(summary.rounds)},
            {"n", summary.n},
            {"samples", make_number_list_json(summary.samples)}};
}

Json to_json(const measure::MetricParts& parts) {
    Json json{{parts.kind, parts.name}};
    for (const auto& [name, value] : parts.values)
        json[std::string(name)] = make_metric_value_json(value);
    return json;
}

struct JsonValueWriter {
    Json operator()(std::monostate) const { return nullptr; }
    Json operator()(bool mark) const { return mark; }
    Json operator()(double value) const { return make_number_json(value); }
    Json operator()(const dvec3& colour) const { return make_point_json(colour); }
    Json operator()(const measure::PixelPosition& place) const {
        return place.x < 0 ? Json(nullptr) : Json::array({place.x, place.y});
    }
    Json operator()(const measure::SampleSummary& times) const { return to_json(times); }
    Json operator()(const std::vector<double>& list) const { return make_number_list_json(list); }
    Json operator()(const std::vector<measure::MetricParts>& list) const {
        return make_list_json(list,
                              [](const measure::MetricParts& parts) { return to_json(parts); });
    }
};

/// Returns an object that begins with `json` and has all metrics of a difference.
Json add_difference_metrics_json(Json json, const measure::Difference& error) {
    for (const measure::Metric& quantity : measure::difference_metrics())
        json[std::string(quantity.name)] = make_metric_value_json(
            measure::metric_value(quantity, error));
    return json;
}

Json make_labels_json(const std::vector<const Row*>& rows) {
    return make_list_json(rows, [](const Row* row) { return Json(row->label); });
}

/// Returns the answers of the first sentence as lists of rows.
Json make_verdict_json(const Comparison& comparison) {
    const measure::RayTracingVerdict tracing = measure::find_ray_tracing_verdict(comparison);
    const measure::FastestRows fastest = measure::find_fastest_rows(comparison);
    return {{"text", summarise_ray_tracing_verdict(comparison)},
            {"fastest", make_labels_json(fastest.rows)},
            {"fastest_are_equal", fastest.are_equal},
            {"ray_tracing",
             {{"beats", make_labels_json(tracing.beaten)},
              {"does_not_beat", make_labels_json(tracing.unbeaten)},
              {"cannot_tell", make_labels_json(tracing.open)}}}};
}

/// Returns the budgets, and the labels of the rows that answer them.
Json make_budget_json(const Comparison& comparison) {
    const measure::BestRows answer = measure::find_best_rows(comparison);
    const auto label = [](const Row* row) { return row == nullptr ? Json() : Json(row->label); };
    std::vector<const Row*> ties = answer.equal;
    ties.insert(ties.end(), answer.open.begin(), answer.open.end());
    return {{"max_ms", make_number_json(comparison.max_ms)},
            {"max_flip", make_number_json(comparison.max_flip)},
            {"max_rmse", make_number_json(comparison.max_rmse)},
            {"row", label(answer.row)},
            {"ties", make_labels_json(ties)},
            {"cannot_tell", make_labels_json(answer.open)},
            {"undecided", make_labels_json(answer.undecided)},
            {"nearest", label(answer.nearest)},
            {"text", describe_budget_answer(comparison)}};
}

/// Adds a metric to an object of metrics. The object is null as long as none of its metrics has a
/// value.
void add_metric_to_object(Json& json, const measure::Metric& quantity,
                          const measure::MetricValue& value) {
    const std::size_t slash = quantity.name.find('/');
    Json& object = json[std::string(quantity.name.substr(0, slash))];
    if (object.is_null() && measure::is_missing(value)) return;
    if (object.is_null() && !quantity.mask.empty()) object["mask"] = quantity.mask;
    object[std::string(quantity.name.substr(slash + 1))] = make_metric_value_json(value);
}

void add_metric_json(Json& json, const measure::Metric& quantity, const Row& row) {
    const measure::MetricValue value = measure::metric_value(quantity, row);
    const bool* mark = std::get_if<bool>(&value);
    if (quantity.only_where_true && mark != nullptr && !*mark) return;
    if (quantity.name.find('/') != std::string_view::npos)
        add_metric_to_object(json, quantity, value);
    else
        json[std::string(quantity.name)] = make_metric_value_json(value);
}

/// Adds all metrics of the table to a row. Metrics of differences are written together, at the
/// place of the first of them.
void add_row_metrics_json(Json& json, const Comparison& comparison, const Row& row) {
    for (const measure::Metric& quantity : measure::metrics()) {
        if (!measure::is_shown(quantity, comparison)) continue;
        if (quantity.mask != "each")
            add_metric_json(json, quantity, row);
        else if (!json.contains("error"))
            add_error_fields_json(json, row);
    }
}

Json to_json(const std::vector<Setting>& settings) {
    Json json = Json::object();
    for (const Setting& setting : settings)
        json[setting.name] = setting.number ? make_number_json(*setting.number)
                                            : Json(setting.text);
    return json;
}

Json to_json(const measure::CulledWork& work) {
    return {{"what", work.what},
            {"why", work.why},
            {"saves", work.saves},
            {"error", make_number_json(work.error)}};
}

Json to_json(const Comparison& comparison, const Row& row) {
    Json json{{"technique", row.technique}, {"settings", to_json(row.settings)}};
    json["label"] = row.label;
    json["model"] = row.model;
    json["left_out"] = make_list_json(
        row.left_out, [](const measure::CulledWork& work) { return to_json(work); });
    add_row_metrics_json(json, comparison, row);
    json["views"] = make_views_json(comparison, row);
    json["plan"] = make_plan_json(row.plan);
    json["image"] = report_image_path(comparison, row.image + ".png");
    json["is_reference"] = row.is_reference;
    return json;
}

Json to_json(const SetupFacts& setup) {
    return {{"load_ms", make_number_json(setup.load_ms)},
            {"upload_ms", make_number_json(setup.upload_ms)},
            {"hierarchy_ms", make_number_json(setup.hierarchy_ms)},
            {"compile_ms", make_number_json(setup.compile_ms)},
            {"pipelines", setup.pipelines},
            {"pipeline_cache", setup.pipeline_cache}};
}

void add_circumstances_json(Json& json, const Comparison& comparison) {
    json["device"] = make_device_json(comparison.device);
    json["device"]["held_threads"] = comparison.device.held_threads;
    json["scene"] = make_scene_json(comparison.scene);
    json["setup"] = to_json(measure::read_setup_facts(comparison));
    json["size"] = Json::array({comparison.width, comparison.height});
    json["frames"] = comparison.frames;
    json["warmup"] = comparison.warmup;
    json["rounds"] = comparison.rounds;
    json["timing"] = comparison.timing;
    json["load"] = Json::array(
        {make_number_json(comparison.load_start), make_number_json(comparison.load_end)});
    json["time"] = make_number_json(comparison.time);
    json["ambient"] = make_number_json(comparison.ambient);
    json["exposure"] = make_number_json(comparison.exposure);
    json["flip_source"] = measure::kFlipSourceFloats;
    json["together"] = comparison.together;
    json["warnings"] = comparison.warnings;
}

/// Returns the noise of a reference.
Json to_json(const measure::ReferenceNoise& noise) {
    return {{"frames", noise.frames},
            {"rays", noise.rays},
            {"wanted_rays", noise.wanted_rays},
            {"seconds", make_number_json(noise.seconds)},
            {"most_seconds", make_number_json(noise.most_seconds)},
            {"flip_floor", make_number_json(noise.flip_floor)},
            {"wanted_floor", make_number_json(noise.wanted_floor)},
            {"halves_rmse", make_number_json(noise.halves_rmse)},
            {"predicted_rmse", make_number_json(noise.predicted_rmse)}};
}

} // namespace

Json make_point_json(const dvec3& point) {
    return Json::array(
        {make_number_json(point.x), make_number_json(point.y), make_number_json(point.z)});
}

Json make_plan_json(const std::vector<PlanEntry>& plan) {
    return make_list_json(plan, [](const PlanEntry& entry) {
        return Json{{"mirror", entry.mirror},
                    {"name", entry.name},
                    {"technique", entry.technique},
                    {"settings", to_json(entry.settings)},
                    {"why", entry.why}};
    });
}

Json make_row_times_json(const Row& row) {
    Json json = Json::object();
    for (const measure::Metric& quantity : measure::metrics())
        if (quantity.unit == "ms" && quantity.study.empty()) add_metric_json(json, quantity, row);
    return json;
}

Json make_metric_value_json(const measure::MetricValue& value) {
    return std::visit(JsonValueWriter{}, value);
}

Json make_report_json(const Comparison& comparison) {
    Json json{{"schema", "catoptric/compare/1"}, {"version", comparison.version},
              {"commit", comparison.commit},     {"date", comparison.date},
              {"command", comparison.command},   {"complete", comparison.complete}};
    if (!comparison.complete) {
        json["incomplete"] = describe_incomplete_run(comparison);
        json["rows_asked"] = comparison.asked;
    }
    add_circumstances_json(json, comparison);
    json["reference"] = {{"technique", comparison.reference_technique},
                         {"settings", to_json(comparison.reference_settings)},
                         {"label", comparison.reference_label},
                         {"gpu_ms", to_json(comparison.reference_gpu_ms)}};
    json["reference"]["area_flip"] = make_number_json(comparison.reference_area_flip);
    if (comparison.noise) json["reference"]["noise"] = to_json(*comparison.noise);
    if (comparison.path_distance)
        json["reference"]["path_distance"] = make_path_distance_json(*comparison.path_distance);
    if (comparison.clear_ms) json["clear_ms"] = to_json(*comparison.clear_ms);
    json["model"] = comparison.model;
    json["views"] = make_views_json(comparison);
    json["rows"] = make_list_json(comparison.rows,
                                  [&](const Row& row) { return to_json(comparison, row); });
    json["pareto"] = comparison.pareto;
    json["judged_time"] = measure::judged_time(comparison);
    json["verdict"] = make_verdict_json(comparison);
    if (measure::has_budget(comparison)) json["budget"] = make_budget_json(comparison);
    if (comparison.lag) json["lag"] = make_lag_json(comparison);
    return json;
}

void add_error_fields_json(Json& json, const measure::Errors& errors) {
    for (const measure::RowMask& mask : measure::row_masks())
        json[std::string(mask.field)] = add_difference_metrics_json({{"mask", mask.name}},
                                                                    errors.*mask.error);
    Json& list = json["error_per_mirror"] = Json::array();
    for (std::size_t i = 0; i < errors.error_per_mirror.size(); ++i)
        list.push_back(add_difference_metrics_json({{"mirror", MirrorId::from_index(i).number()}},
                                                   errors.error_per_mirror[i]));
}

std::string serialise_json(const Json& document) {
    // Names from files may contain any bytes. ASCII output cannot hold control sequences for a
    // terminal.
    return document.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

std::string to_json(const Comparison& comparison) {
    return serialise_json(make_report_json(comparison));
}

} // namespace catoptric::report
