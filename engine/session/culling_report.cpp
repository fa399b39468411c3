#include "session/culling_report.hpp"

#include "core/text.hpp"
#include "report/text.hpp"
#include "require/culled_work.hpp"
#include "require/model.hpp"
#include "require/suggest.hpp"
#include "scene/pose.hpp"
#include "session/capture_budget.hpp"
#include "session/plan_file.hpp"
#include "session/scene_info.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace catoptric::session {

namespace {

using OrderedJson = nlohmann::ordered_json;

struct WorkReport {
    scene::Scene now;
    require::WorkModel model;
    require::PlanSuggestion suggestion;
};

/// Returns the feature of reflectors in the picture whose reflections only ray tracing draws.
std::optional<measure::UnsupportedFeatureFacts> find_undrawn(const Request& request) {
    constexpr std::string_view kSmoothDielectricGapId = "smooth-dielectric";
    const auto gap = std::ranges::find(request.scene.unsupported, kSmoothDielectricGapId,
                                       &scene::UnsupportedFeature::id);
    if (gap == request.scene.unsupported.end()) return std::nullopt;
    const std::vector<int> seen = find_visible_objects(request, thumbnail_size(request.size));
    return measure::UnsupportedFeatureFacts{gap->id, gap->count, gap->first,
                                            pixel_share(seen, request.scene, gap->materials)};
}

WorkReport find_required_work(const Request& request, const require::UnitCosts& costs) {
    WorkReport required{
        .now = scene::scene_at(request.scene, request.time), .model = {}, .suggestion = {}};
    const scene::Camera camera = scene::camera_at(request.camera, request.time);
    const require::WorkModelInput input{required.now, camera, request.size};
    required.model = require::make_required_model(input);
    required.suggestion = require::suggest_plan(input, costs);
    return required;
}

OrderedJson mirror_to_json(const WorkReport& required, const std::string& name, std::size_t i) {
    const require::MirrorRequirements& needs = required.model.mirrors[i];
    OrderedJson sees = OrderedJson::array(), faces = OrderedJson::array();
    if (needs.is_captured) faces = split(require::face_names(needs.faces), " ");
    for (const std::uint32_t other : needs.sees) sees.push_back(other + 1);
    return {{"mirror", i + 1},
            {"name", name},
            {"seen", needs.is_seen},
            {"seen_in", needs.seen_in ? OrderedJson(needs.seen_in.number()) : OrderedJson()},
            {"captured", needs.is_captured},
            {"faces", faces},
            {"sees", sees},
            {"suggested", required.suggestion.reasons[i]}};
}

constexpr const char* kUndrawnText = "what smooth surfaces that are no mirrors reflect";
constexpr const char* kUndrawnRemedy =
    "no technique but raytrace draws it; --dielectric-mirrors makes mirrors of them";

} // namespace

std::string culling_to_text(const Request& request, const require::DeviceUnitCosts& costs,
                            const std::optional<CaptureBudget>& capture_budget) {
    const auto [now, model, suggestion] = find_required_work(request, costs.costs);
    const std::vector<std::string> names = mirror_names(now);
    std::string text = require::describe_model(model, now);
    if (const auto gap = find_undrawn(request))
        text += std::string("not drawn\n  ") + kUndrawnText + ": " +
                report::format_fixed(100 * *gap->pixel_share, 1) +
                " % of the picture (first: " + escape(gap->first) +
                ")\n    why: " + kUndrawnRemedy + "\n";
    if (capture_budget) text += describe_budget(*capture_budget) + "\n";
    if (names.empty()) return text;
    text += "suggested --plan \"" + suggestion.plan + "\"\n";
    for (std::size_t i = 0; i < names.size(); ++i)
        text += "  mirror " + std::to_string(i + 1) + " " + quote(names[i]) + ": " +
                suggestion.reasons[i] + "\n";
    return text + require::format_candidates(suggestion.candidates, costs.note);
}

std::string culling_to_json(const Request& request, const require::DeviceUnitCosts& costs,
                            const std::optional<CaptureBudget>& capture_budget) {
    const WorkReport required = session::find_required_work(request, costs.costs);
    const std::vector<std::string> names = mirror_names(required.now);
    OrderedJson document{
        {"schema", "catoptric/why/1"},        {"mirrors", OrderedJson::array()},
        {"lights", OrderedJson::array()},     {"left_out", OrderedJson::array()},
        {"not_drawn", OrderedJson::array()},  {"suggested", required.suggestion.plan},
        {"candidates", OrderedJson::array()}, {"unit_costs", costs.note}};
    for (const require::PlanCandidate& candidate : required.suggestion.candidates)
        document["candidates"].push_back({{"name", candidate.name},
                                          {"plan", candidate.plan},
                                          {"ms", candidate.ms},
                                          {"flip", candidate.error},
                                          {"score", candidate.score()}});
    for (std::size_t i = 0; i < names.size(); ++i)
        document["mirrors"].push_back(mirror_to_json(required, names[i], i));
    for (std::size_t i = 0; i < required.model.lights.size(); ++i)
        document["lights"].push_back({{"light", i + 1}, {"map", required.model.lights[i].has_map}});
    for (const require::CulledWork& thing : required.model.left_out)
        document["left_out"].push_back({{"what", thing.what},
                                        {"why", thing.why},
                                        {"saves", thing.saves},
                                        {"error", thing.error}});
    if (const auto gap = find_undrawn(request))
        document["not_drawn"].push_back({{"what", kUndrawnText},
                                         {"why", kUndrawnRemedy},
                                         {"first", gap->first},
                                         {"pixel_share", *gap->pixel_share}});
    document["captures"] = capture_budget
                               ? OrderedJson{{"mirrors", capture_budget->mirrors},
                                             {"most", capture_budget->most},
                                             {"oldest_frames",
                                              capture_budget->frames_per_cycle() - 1},
                                             {"round_frames", capture_budget->frames_per_cycle()},
                                             {"said", describe_budget(*capture_budget)}}
                               : OrderedJson();
    return document.dump(2, ' ', true, OrderedJson::error_handler_t::replace) + "\n";
}

std::optional<CaptureBudget> measure_capture_budget(Engine& engine, const Request& request) {
    constexpr int kFramesBeforeMeasurement = 5; // cuts: the first frames compile what they use
    Session session(engine, request.scene);
    FrameSpec spec = request;
    spec.time = request.instant(1);
    for (int k = 0; k < kFramesBeforeMeasurement; ++k) {
        session.forget();
        session.frame(spec);
    }
    return session.frame(spec).capture_budget();
}

} // namespace catoptric::session
