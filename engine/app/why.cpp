#include "app/why.hpp"

#include "app/plan_file.hpp"
#include "core/text.hpp"
#include "require/left_out.hpp"
#include "require/suggest.hpp"

#include <nlohmann/json.hpp>

namespace catoptric::app {

namespace {

using Json = nlohmann::ordered_json;

struct Required {
    scene::Scene now;
    require::Model model;
    require::Suggestion suggestion;
};

Required required(const Request& request) {
    Required required{.now = scene::at(request.scene, request.time), .model = {}, .suggestion = {}};
    const scene::Camera camera = scene::camera_at(request.camera, request.time);
    const require::Question question{required.now, camera, request.size};
    required.model = require::required(question);
    required.suggestion = require::suggest(question);
    return required;
}

Json mirror_of(const Required& required, const std::string& name, std::size_t i) {
    const require::MirrorNeeds& needs = required.model.mirrors[i];
    Json sees = Json::array(), faces = Json::array();
    if (needs.is_captured) faces = split(require::names_of(needs.faces), " ");
    for (const std::uint32_t other : needs.sees) sees.push_back(other + 1);
    return {{"mirror", i + 1},
            {"name", name},
            {"seen", needs.is_seen},
            {"seen_in", needs.seen_in ? Json(needs.seen_in.number()) : Json()},
            {"captured", needs.is_captured},
            {"faces", faces},
            {"sees", sees},
            {"suggested", required.suggestion.reasons[i]}};
}

} // namespace

std::string why_text(const Request& request, const std::optional<Slices>& slices) {
    const auto [now, model, suggestion] = required(request);
    const std::vector<std::string> names = mirror_names(now);
    std::string text = require::to_text(model, now);
    if (slices) text += to_text(*slices) + "\n";
    if (names.empty()) return text;
    text += "suggested --plan \"" + suggestion.plan + "\"\n";
    for (std::size_t i = 0; i < names.size(); ++i)
        text += "  mirror " + std::to_string(i + 1) + " " + in_quotes(names[i]) + ": " +
                suggestion.reasons[i] + "\n";
    return text;
}

std::string why_json(const Request& request, const std::optional<Slices>& slices) {
    const Required required = app::required(request);
    const std::vector<std::string> names = mirror_names(required.now);
    Json document{{"schema", "catoptric/why/1"},
                  {"mirrors", Json::array()},
                  {"lights", Json::array()},
                  {"left_out", Json::array()},
                  {"suggested", required.suggestion.plan}};
    for (std::size_t i = 0; i < names.size(); ++i)
        document["mirrors"].push_back(mirror_of(required, names[i], i));
    for (std::size_t i = 0; i < required.model.lights.size(); ++i)
        document["lights"].push_back({{"light", i + 1}, {"map", required.model.lights[i].has_map}});
    for (const require::LeftOut& thing : required.model.left_out)
        document["left_out"].push_back({{"what", thing.what},
                                        {"why", thing.why},
                                        {"saves", thing.saves},
                                        {"error", thing.error}});
    document["captures"] = slices ? Json{{"mirrors", slices->mirrors},
                                         {"most", slices->most},
                                         {"oldest_frames", slices->round() - 1},
                                         {"round_frames", slices->round()},
                                         {"said", to_text(*slices)}}
                                  : Json();
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<Slices> measured_slices(Engine& engine, const Request& request) {
    constexpr int kCuts = 5; // the first ones compile what they use
    Session session(engine, request.scene);
    FrameSpec spec = request;
    spec.time = request.instant(1);
    for (int k = 0; k < kCuts; ++k) {
        session.forget();
        session.frame(spec);
    }
    return session.frame(spec).slices();
}

} // namespace catoptric::app
