// Writes report.json.
#include "report/json.hpp"

#include "core/mirror_id.hpp"
#include "core/text.hpp"
#include "measure/flip.hpp"
#include "measure/lag.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <cmath>

namespace catoptric::report {

Json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    constexpr double kExact = 9007199254740992; // 2^53
    if (std::abs(value) < kExact && value == std::trunc(value) && !std::signbit(value))
        return static_cast<std::int64_t>(value);
    return value;
}

Json number(const std::optional<double>& value) { return value ? number(*value) : Json(); }

Json numbers_json(const std::vector<double>& values) {
    return list_json(values, [](double value) { return number(value); });
}

Json interval_json(const measure::Interval& interval) {
    return interval.is_known() ? Json::array({number(interval.low), number(interval.high)})
                               : Json();
}

std::string shown(const Json& value) {
    if (value.is_null()) return "nothing";
    if (value.is_structured()) return value.is_array() ? "a list" : "an object";
    return in_quotes(value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

Json device_json(const DeviceFacts& device) {
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

Json to_json(const measure::Summary& summary) {
    if (summary.n == 0) return nullptr; // never measured
    return {{"median", number(summary.median)},
            {"p05", number(summary.p05)},
            {"p95", number(summary.p95)},
            {"mad", number(summary.mad)},
            {"ci95", interval_json(summary.ci95)},
            {"rounds", numbers_json(summary.rounds)},
            {"n", summary.n},
            {"samples", numbers_json(summary.samples)}};
}

Json to_json(const measure::Parts& parts) {
    Json json{{parts.kind, parts.name}};
    for (const auto& [name, value] : parts.values) json[std::string(name)] = value_json(value);
    return json;
}

struct Writes {
    Json operator()(std::monostate) const { return nullptr; }
    Json operator()(bool mark) const { return mark; }
    Json operator()(double value) const { return number(value); }
    Json operator()(const dvec3& colour) const { return point_json(colour); }
    Json operator()(const measure::PixelPosition& place) const {
        return place.x < 0 ? Json(nullptr) : Json::array({place.x, place.y});
    }
    Json operator()(const measure::Summary& times) const { return to_json(times); }
    Json operator()(const std::vector<double>& list) const { return numbers_json(list); }
    Json operator()(const std::vector<measure::Parts>& list) const {
        return list_json(list, [](const measure::Parts& parts) { return to_json(parts); });
    }
};

/// Returns an object that begins with `json` and has all metrics of a difference.
Json with_metrics(Json json, const measure::Difference& error) {
    for (const measure::Metric& quantity : measure::difference_metrics())
        json[std::string(quantity.name)] = value_json(measure::value_of(quantity, error));
    return json;
}

void add_errors(Json& json, const Row& row) {
    for (const measure::RowMask& mask : measure::masks())
        json[std::string(mask.field)] = with_metrics({{"mask", mask.name}}, row.*mask.error);
    Json& list = json["error_per_mirror"] = Json::array();
    for (std::size_t i = 0; i < row.error_per_mirror.size(); ++i)
        list.push_back(
            with_metrics({{"mirror", MirrorId::at(i).number()}}, row.error_per_mirror[i]));
}

/// Adds a metric to an object of metrics. The object is null as long as none of its metrics has a
/// value.
void add_to_object(Json& json, const measure::Metric& quantity, const measure::Value& value) {
    const std::size_t slash = quantity.name.find('/');
    Json& object = json[std::string(quantity.name.substr(0, slash))];
    if (object.is_null() && measure::is_nothing(value)) return;
    if (object.is_null() && !quantity.mask.empty()) object["mask"] = quantity.mask;
    object[std::string(quantity.name.substr(slash + 1))] = value_json(value);
}

void add_figure(Json& json, const measure::Metric& quantity, const Row& row) {
    const measure::Value value = measure::value_of(quantity, row);
    const bool* mark = std::get_if<bool>(&value);
    if (quantity.only_where_true && mark != nullptr && !*mark) return;
    if (quantity.name.find('/') != std::string_view::npos)
        add_to_object(json, quantity, value);
    else
        json[std::string(quantity.name)] = value_json(value);
}

/// Adds all metrics of the table. Those of differences stand at the place of the first of them.
void add_figures(Json& json, const Comparison& comparison, const Row& row) {
    for (const measure::Metric& quantity : measure::metrics()) {
        if (!measure::is_shown(quantity, comparison)) continue;
        if (quantity.mask != "each")
            add_figure(json, quantity, row);
        else if (!json.contains("error"))
            add_errors(json, row);
    }
}

Json to_json(const std::vector<Setting>& settings) {
    Json json = Json::object();
    for (const Setting& setting : settings)
        json[setting.name] = setting.number ? number(*setting.number) : Json(setting.text);
    return json;
}

Json to_json(const measure::CulledWork& work) {
    return {{"what", work.what},
            {"why", work.why},
            {"saves", work.saves},
            {"error", number(work.error)}};
}

Json to_json(const Comparison& comparison, const Row& row) {
    Json json{{"technique", row.technique}, {"settings", to_json(row.settings)}};
    json["label"] = row.label;
    json["model"] = row.model;
    json["left_out"] = list_json(row.left_out,
                                 [](const measure::CulledWork& work) { return to_json(work); });
    add_figures(json, comparison, row);
    json["views"] = views_json(comparison, row);
    json["plan"] = plan_json(row.plan);
    json["image"] = image_path(comparison, row.image + ".png");
    json["is_reference"] = row.is_reference;
    return json;
}

Json to_json(const SetupFacts& setup) {
    return {{"load_ms", number(setup.load_ms)},
            {"upload_ms", number(setup.upload_ms)},
            {"hierarchy_ms", number(setup.hierarchy_ms)},
            {"compile_ms", number(setup.compile_ms)},
            {"pipelines", setup.pipelines},
            {"pipeline_cache", setup.pipeline_cache}};
}

void add_circumstances(Json& json, const Comparison& comparison) {
    json["device"] = device_json(comparison.device);
    json["device"]["held_threads"] = comparison.device.held_threads;
    json["scene"] = scene_json(comparison.scene);
    json["setup"] = to_json(comparison.setup);
    json["size"] = Json::array({comparison.width, comparison.height});
    json["frames"] = comparison.frames;
    json["warmup"] = comparison.warmup;
    json["rounds"] = comparison.rounds;
    json["timing"] = comparison.timing;
    json["load"] = Json::array({number(comparison.load_start), number(comparison.load_end)});
    json["time"] = number(comparison.time);
    json["ambient"] = number(comparison.ambient);
    json["exposure"] = number(comparison.exposure);
    json["flip_source"] = measure::kFlipOfFloats;
    json["together"] = comparison.together;
    json["warnings"] = comparison.warnings;
}

} // namespace

Json point_json(const dvec3& point) {
    return Json::array({number(point.x), number(point.y), number(point.z)});
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

Json times_json(const Row& row) {
    Json json = Json::object();
    for (const measure::Metric& quantity : measure::metrics())
        if (quantity.unit == "ms" && quantity.study.empty()) add_figure(json, quantity, row);
    return json;
}

Json value_json(const measure::Value& value) { return std::visit(Writes{}, value); }

Json document_of(const Comparison& comparison) {
    Json json{{"schema", "catoptric/compare/1"}, {"version", comparison.version},
              {"commit", comparison.commit},     {"date", comparison.date},
              {"command", comparison.command},   {"complete", comparison.complete}};
    if (!comparison.complete) {
        json["incomplete"] = incomplete_text(comparison);
        json["rows_asked"] = comparison.asked;
    }
    add_circumstances(json, comparison);
    json["reference"] = {{"technique", comparison.reference_technique},
                         {"settings", to_json(comparison.reference_settings)},
                         {"label", comparison.reference_label},
                         {"gpu_ms", to_json(comparison.reference_gpu_ms)}};
    if (comparison.clear_ms) json["clear_ms"] = to_json(*comparison.clear_ms);
    json["model"] = comparison.model;
    json["views"] = views_json(comparison);
    json["rows"] = list_json(comparison.rows,
                             [&](const Row& row) { return to_json(comparison, row); });
    json["pareto"] = comparison.pareto;
    if (comparison.lag) json["lag"] = to_json(*comparison.lag);
    return json;
}

std::string written(const Json& document) {
    // Names from files may contain any bytes. ASCII output cannot hold control sequences for a
    // terminal.
    return document.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

std::string to_json(const Comparison& comparison) { return written(document_of(comparison)); }

} // namespace catoptric::report
