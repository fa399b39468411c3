// report.json. Only the files json*.cpp know the JSON library; fields are only ever added.
#include "report/json.hpp"
#include "report/report.hpp"
#include "report/rows.hpp"
#include "report/text.hpp"

#include <cmath>

namespace catoptric::report {

Json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    constexpr double kExact = 9007199254740992; // 2^53
    if (std::abs(value) < kExact && value == std::trunc(value) && !std::signbit(value))
        return static_cast<std::int64_t>(value);
    return value;
}

namespace {

template <typename Value>
Json number_or_null(const std::optional<Value>& value) {
    return value ? number(*value) : Json(nullptr);
}

Json to_json(const measure::Summary& summary) {
    if (summary.n == 0) return nullptr; // never measured
    Json samples = Json::array();
    for (const double sample : summary.samples) samples.push_back(number(sample));
    return {{"median", number(summary.median)},
            {"p05", number(summary.p05)},
            {"p95", number(summary.p95)},
            {"mad", number(summary.mad)},
            {"n", summary.n},
            {"samples", std::move(samples)}};
}

/// The figures, without saying of which pixels.
void add(Json& json, const measure::Difference& error) {
    json["pixels"] = error.pixels;
    json["rmse"] = number(error.rmse);
    json["mae"] = number(error.mae);
    json["flip"] = number(error.flip);
    json["psnr"] = number_or_null(error.psnr);
    json["p99"] = number(error.p99);
    json["nonfinite"] = error.nonfinite;
    json["max"] = number(error.max);
    json["max_at"] = error.max_x < 0 ? Json(nullptr) : Json({error.max_x, error.max_y});
    json["off"] = number(error.off);
    json["longest_line"] = number(error.longest_line);
}

Json to_json(const measure::Difference& error, const char* mask) {
    Json json{{"mask", mask}};
    add(json, error);
    return json;
}

Json per_mirror(const Row& row) {
    Json list = Json::array();
    for (std::size_t i = 0; i < row.error_per_mirror.size(); ++i) {
        Json json{{"mirror", i + 1}};
        add(json, row.error_per_mirror[i]);
        list.push_back(std::move(json));
    }
    return list;
}

Json to_json(const std::vector<Setting>& settings) {
    Json json = Json::object();
    for (const Setting& setting : settings)
        json[setting.name] = setting.number ? number(*setting.number) : Json(setting.text);
    return json;
}

Json to_json(const std::vector<PassFacts>& passes) {
    Json list = Json::array();
    for (const PassFacts& pass : passes)
        list.push_back({{"name", pass.name}, {"gpu_ms", to_json(pass.gpu_ms)}});
    return list;
}

Json to_json(const std::optional<Rays>& rays) {
    if (!rays) return nullptr;
    return {{"primary", rays->primary}, {"mirror", rays->mirror}, {"shadow", rays->shadow}};
}

Json to_json(const std::optional<measure::LookupError>& lookup) {
    if (!lookup) return nullptr;
    return {{"mask", "first_order"},
            {"pixels", lookup->pixels},
            {"mean_degrees", number(lookup->mean_degrees)},
            {"p95_degrees", number(lookup->p95_degrees)},
            {"p99_degrees", number(lookup->p99_degrees)},
            {"wrong_object", number(lookup->wrong_object)},
            {"unknown", number(lookup->unknown)},
            {"miss", number(lookup->miss)},
            {"p95_residual", number(lookup->p95_residual)}};
}

Json numbers(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number(value));
    return list;
}

Json to_json(const std::optional<Causes>& causes) {
    if (!causes) return nullptr;
    Json json{{"mask", "mirrors"},
              {"squared_error", number(causes->squared_error)},
              {"squared_error_per_mirror", numbers(causes->squared_error_per_mirror)},
              {"rest_rmse", number(causes->rest_rmse)},
              {"at_light_edges", number(causes->at_light_edges)}};
    for (const Cause& cause : causes->list)
        json["list"].push_back({{"cause", cause.name},
                                {"in_turn", number(cause.in_turn)},
                                {"alone", number(cause.alone)},
                                {"in_turn_per_mirror", numbers(cause.in_turn_per_mirror)},
                                {"alone_per_mirror", numbers(cause.alone_per_mirror)}});
    return json;
}

Json to_json(const std::optional<AutoFace>& face) {
    if (!face) return nullptr;
    Json needs = Json::array();
    for (const double need : face->needs) needs.push_back(number(need));
    return {{"edge", face->edge}, {"needs", std::move(needs)}};
}

Json to_json(const measure::Mean& mean) {
    return Json::array({number(mean.rgb.x), number(mean.rgb.y), number(mean.rgb.z)});
}

void add_errors(Json& json, const Row& row) {
    json["error"] = to_json(row.error, "mirrors");
    json["error_first_order"] = to_json(row.error_first_order, "first_order");
    json["error_mirror_in_mirror"] = to_json(row.error_mirror_in_mirror, "mirror_in_mirror");
    json["error_non_mirror"] = to_json(row.error_non_mirror, "non_mirror");
    json["error_all"] = to_json(row.error_all, "all");
    json["error_per_mirror"] = per_mirror(row);
}

Json to_json(const Row& row) {
    Json json{{"technique", row.technique}, {"settings", to_json(row.settings)}};
    json["label"] = row.label;
    json["model"] = row.model;
    json["scene_passes"] = row.scene_passes;
    json["scene_draws"] = row.scene_draws;
    json["gpu_ms"] = to_json(row.gpu_ms);
    json["cpu_record_ms"] = to_json(row.cpu_record_ms);
    json["wall_ms"] = to_json(row.wall_ms);
    json["passes"] = to_json(row.passes);
    json["closure"] = to_json(row.closure);
    add_errors(json, row);
    if (failed(row)) json["failed"] = true;
    json["memory_bytes"] = row.memory_bytes;
    json["traced_fraction"] = number_or_null(row.traced_fraction);
    json["auto_face"] = to_json(row.auto_face);
    json["rays"] = to_json(row.rays);
    json["saturated_texels"] = row.saturated_texels ? Json(*row.saturated_texels) : Json(nullptr);
    json["lookup"] = to_json(row.lookup);
    json["causes"] = to_json(row.causes);
    json["mean"] = to_json(row.mean);
    json["mean_clamped"] = to_json(row.mean_clamped);
    json["image"] = "images/" + row.image + ".png";
    json["is_reference"] = row.is_reference;
    return json;
}

void add_circumstances(Json& json, const Comparison& comparison) {
    const DeviceFacts& device = comparison.device;
    json["device"] = {{"name", device.name},
                      {"driver", device.driver},
                      {"api", device.api},
                      {"type", device.type},
                      {"threads", device.threads}};
    const SceneFacts& scene = comparison.scene;
    json["scene"] = {{"name", scene.name},
                     {"triangles", scene.triangles},
                     {"mirrors", scene.mirrors},
                     {"hash", scene.hash}};
    json["size"] = Json::array({comparison.width, comparison.height});
    json["frames"] = comparison.frames;
    json["warmup"] = comparison.warmup;
    json["timing"] = comparison.timing;
    json["time"] = number(comparison.time);
    json["ambient"] = number(comparison.ambient);
    json["exposure"] = number(comparison.exposure);
    json["together"] = comparison.together;
    json["warnings"] = comparison.warnings;
}

} // namespace

std::string to_json(const Comparison& comparison) {
    Json json{{"schema", "catoptric/compare/1"},
              {"version", comparison.version},
              {"commit", comparison.commit},
              {"command", comparison.command},
              {"complete", comparison.complete}};
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
    json["rows"] = Json::array();
    for (const Row& row : comparison.rows) json["rows"].push_back(to_json(row));
    json["pareto"] = comparison.pareto;
    if (comparison.lag) json["lag"] = to_json(*comparison.lag);
    // Names from files may be any bytes. In ASCII no terminal finds an order in them.
    return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

} // namespace catoptric::report
