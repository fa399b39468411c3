#include "json.hpp"

#include "measure/metric.hpp"
#include "report/comparison.hpp"
#include "report/json.hpp"
#include "session/access.hpp"
#include "session/capture_budget.hpp"
#include "session/device_facts.hpp"
#include "session/technique_choice.hpp"
#include "study/compare_row.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace catoptric::cli {

namespace {

using report::Json;

std::string serialise(const Json& document) {
    return document.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

Json vector_json(const dvec3& v) { return {v.x, v.y, v.z}; }

Json device_json(const session::DeviceInfo& device) {
    Json row = report::device_json(session::make_device_facts(device));
    row["id"] = device.id;
    row["usable"] = device.missing.empty();
    if (!device.missing.empty()) row["missing"] = device.missing;
    return row;
}

/// Returns the times in the format of report.json.
Json times_json(const session::RunResult& result, const session::DeviceInfo& device) {
    report::Row row;
    const session::TechniqueResult& part = result.parts.front();
    study::fill_row_times(
        row,
        {.rounds = {result.frames}, .cycle = part.capture_budget ? part.capture_budget->every : 1},
        part.prefix, device.type == "cpu");
    const std::vector<session::PassTime>& last = result.frames.back().passes;
    std::erase_if(row.passes,
                  [&](const report::PassFacts& pass) { // passes that only other frames had are left
                                                       // out
                      return std::ranges::find(last, pass.name, &session::PassTime::name) ==
                             last.end();
                  });
    return report::row_times_json(row);
}

Json culled_work_json(const session::TechniqueResult& part) {
    Json list = Json::array();
    for (const auto& [what, why, saves, error] : part.left_out)
        list.push_back({{"what", what}, {"why", why}, {"saves", saves}, {"error", error}});
    return list;
}

/// Returns how many captures a frame draws again, and how old their contents can be.
Json budget_json(const std::optional<session::CaptureBudget>& capture_budget, double budget_ms) {
    if (!capture_budget) return nullptr;
    return {{"budget_ms", budget_ms},
            {"mirrors", capture_budget->mirrors},
            {"most", capture_budget->most},
            {"drawn", capture_budget->drawn},
            {"waiting", capture_budget->waiting},
            {"oldest_frames", capture_budget->frames_per_cycle() - 1},
            {"round_frames", capture_budget->frames_per_cycle()},
            {"said", session::describe_budget(*capture_budget)}};
}

Json settings_json(const std::vector<Setting>& list) {
    Json settings = Json::object();
    for (const Setting& setting : list)
        settings[setting.name] = setting.number ? Json(std::stoll(setting.text))
                                                : Json(setting.text);
    return settings;
}

/// Returns in one word whether larger or smaller values of a metric are better; null if neither is.
Json direction_json(measure::BetterDirection better) {
    switch (better) {
    case measure::BetterDirection::less: return "less";
    case measure::BetterDirection::more: return "more";
    case measure::BetterDirection::neither: break;
    }
    return nullptr;
}

} // namespace

std::string diff_json(const DiffFacts& facts) {
    Json document{{"schema", "catoptric/diff/1"}, {"a", facts.a}, {"b", facts.b}};
    document["mask"] = facts.mask.empty() ? Json() : Json(facts.mask);
    document["size"] = {facts.size.x, facts.size.y};
    document["exposure"] = facts.exposure;
    document["flip_source"] = facts.flip_source;
    for (const measure::Metric& metric : measure::difference_metrics())
        document[std::string(metric.name)] = report::metric_json(
            measure::metric_value(metric, facts.difference));
    document["mean"] = {{"a", vector_json(facts.a_mean.rgb)}, {"b", vector_json(facts.b_mean.rgb)}};
    document["mean_clamped"] = {{"a", vector_json(facts.a_clamped.rgb)},
                                {"b", vector_json(facts.b_clamped.rgb)}};
    document["over"] = facts.over;
    return serialise(document);
}

std::string render_json(const session::Request& request, int first_frame,
                        const session::DeviceInfo& device, const session::RunResult& result,
                        const std::string& output) {
    const session::TechniqueResult& part = result.parts.front();
    const session::ParsedTechnique choice = session::parse_technique(request.techniques.front());
    using measure::ValueRange;
    Json document{{"schema", "catoptric/render/1"},
                  {"version", session::version()},
                  {"commit", session::commit()}};
    document["output"] = output;
    document["device"] = device_json(device);
    document["scene"] = request.scene.name;
    document["camera"] = request.camera.name;
    document["size"] = {request.size.x, request.size.y};
    document["frames"] = result.frames.size();
    document["first_frame"] = first_frame;
    document["warmup"] = request.warmup;
    document["settled"] = request.until_settled ? Json(result.settled) : Json();
    document["time"] = request.time;
    document["exposure"] = request.exposure;
    document["timing"] = request.timing == session::PassTimingMode::isolated ? "isolated"
                                                                             : "pipelined";
    document["technique"] = choice.technique;
    document["label"] = choice.label;
    document["settings"] = settings_json(choice.settings);
    document["plan"] = report::plan_json(part.plan);
    document["notes"] = part.notes;
    document["model"] = work_name(part.model);
    document["left_out"] = culled_work_json(part);
    document["captures"] = budget_json(part.capture_budget, request.budget_ms);
    document["scene_passes"] = part.scene_passes;
    document["scene_draws"] = part.scene_draws;
    // Frames of a still picture also compile shaders at their first use. The times of such frames
    // are therefore left out.
    const Json times = times_json(result, device);
    for (const auto& [name, value] : times.items())
        document[name] = request.until_settled ? Json() : value;
    document["memory_bytes"] = part.memory_bytes;
    if (part.rays)
        document["rays"] = {{"primary", part.rays->primary},
                            {"mirror", part.rays->mirror},
                            {"shadow", part.rays->shadow}};
    document["mean"] = vector_json(measure::mean_of(part.hdr, ValueRange::unclamped).rgb);
    document["mean_clamped"] = vector_json(measure::mean_of(part.hdr, ValueRange::clamped).rgb);
    return serialise(document);
}

std::string origin_json(const PictureOrigin& origin) {
    const Json json{{"schema", "catoptric/picture/1"},
                    {"version", session::version()},
                    {"commit", session::commit()},
                    {"device", origin.device},
                    {"driver", origin.driver},
                    {"scene", origin.scene},
                    {"scene_hash", origin.scene_hash},
                    {"technique", origin.technique},
                    {"model", origin.model},
                    {"camera", report::camera_json(origin.camera)},
                    {"time", origin.time},
                    {"seed", origin.seed},
                    {"exposure", origin.exposure}};
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string trace_json(const session::FrameTimes& frame, const std::string& process) {
    Json events = Json::array();
    const auto name_of = [&](const char* what, const std::string& name) {
        events.push_back(
            {{"name", what}, {"ph", "M"}, {"pid", 1}, {"tid", 1}, {"args", {{"name", name}}}});
    };
    name_of("process_name", process);
    name_of("thread_name", "device");
    for (const session::PassTime& pass : frame.passes) // Chrome's trace format uses microseconds
        events.push_back({{"name", pass.name},
                          {"cat", "pass"},
                          {"ph", "X"},
                          {"ts", 1000 * pass.begin_ms},
                          {"dur", 1000 * pass.ms()},
                          {"pid", 1},
                          {"tid", 1}});
    return serialise({{"traceEvents", events}, {"displayTimeUnit", "ms"}});
}

std::string devices_json(const std::vector<session::DeviceInfo>& devices) {
    Json rows = Json::array();
    for (const session::DeviceInfo& device : devices) rows.push_back(device_json(device));
    return serialise({{"schema", "catoptric/list/1"}, {"devices", rows}});
}

Json traits_json(const TechniqueTraits& traits) {
    constexpr std::array<const char*, 3> kCaptures{"none", "own", "shared"},
        kNoises{"none", "rays", "history"};
    return {{"captures", kCaptures[static_cast<std::size_t>(traits.captures)]},
            {"mirrored_views", traits.draws_mirrored_views},
            {"rays", traits.traces_rays},
            {"noise", kNoises[static_cast<std::size_t>(traits.noise)]}};
}

std::string techniques_json(const std::vector<session::TechniqueInfo>& techniques) {
    Json rows = Json::array();
    for (const session::TechniqueInfo& technique : techniques) {
        Json knobs = Json::array();
        for (const session::KnobInfo& knob : technique.knobs) {
            Json row{{"name", knob.name}, {"help", knob.help}, {"default", knob.value}};
            if (knob.choices.empty())
                row["low"] = knob.low, row["high"] = knob.high,
                row["default"] = std::stoll(knob.value);
            else
                row["choices"] = knob.choices;
            if (!knob.special.empty()) row["special"] = knob.special;
            knobs.push_back(row);
        }
        rows.push_back({{"name", technique.name},
                        {"summary", technique.summary},
                        {"traits", traits_json(session::parse_technique(technique.name).traits())},
                        {"knobs", knobs}});
    }
    return serialise({{"schema", "catoptric/list/1"}, {"techniques", rows}});
}

std::string named_json(const std::string& kind, const std::vector<NamedListEntry>& named) {
    Json rows = Json::array();
    for (const NamedListEntry& row : named)
        rows.push_back({{"name", row.name}, {"summary", row.summary}});
    return serialise({{"schema", "catoptric/list/1"}, {kind, rows}});
}

std::string metrics_json() {
    Json rows = Json::array();
    for (const measure::Metric& metric : measure::metrics())
        rows.push_back({{"name", metric.name},
                        {"summary", metric.help},
                        {"unit", metric.unit},
                        {"mask", metric.mask},
                        {"better", direction_json(metric.better)}});
    return serialise({{"schema", "catoptric/list/1"}, {"metrics", rows}});
}

std::string info_json(const ProgramInfo& facts) {
    Json document{{"schema", "catoptric/info/1"},
                  {"version", session::version()},
                  {"commit", session::commit()}};
    document["device"] = facts.device ? device_json(*facts.device) : Json();
    if (facts.device) document["device"]["lanes"] = facts.lanes;
    if (!facts.balance.empty()) document["device"]["balance"] = facts.balance;
    if (!facts.device) document["no_device"] = facts.why_no_device;
    Json features = Json::object();
    for (const auto& [group, names] : facts.features) features[group] = names;
    document["features"] = features;
    return serialise(document);
}

} // namespace catoptric::cli
