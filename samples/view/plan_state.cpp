#include "plan_state.hpp"
#include "session/technique_choice.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace catoptric::view {

namespace {

TechniqueSettings drawing_of(const std::string& technique, const std::vector<Setting>& settings) {
    TechniqueSettings drawing{technique, {}};
    for (const Setting& setting : settings)
        if (setting.changed) drawing.knobs[setting.name] = setting.text;
    return drawing;
}

nlohmann::json rule_of(nlohmann::json mirror, const TechniqueSettings& drawing) {
    nlohmann::json settings = nlohmann::json::object();
    for (const auto& [knob, value] : drawing.knobs) settings[knob] = value;
    return {{"mirror", std::move(mirror)},
            {"technique", drawing.technique},
            {"settings", std::move(settings)}};
}

} // namespace

const std::vector<app::TechniqueInfo>& table() {
    static const std::vector<app::TechniqueInfo> kTechniques = app::techniques();
    return kTechniques;
}

const app::TechniqueInfo* find(const std::string& technique) {
    const auto found = std::ranges::find(table(), technique, &app::TechniqueInfo::name);
    return found == table().end() ? nullptr : &*found;
}

std::string text_of(const TechniqueSettings& drawing) {
    std::string text = drawing.technique;
    char before = ':';
    for (const auto& [knob, value] : drawing.knobs) {
        text += before + knob + "=" + value;
        before = ',';
    }
    return text;
}

std::string text_of(const PlanState& plan) {
    if (!plan.typed.empty()) return plan.typed;
    std::string text;
    for (const auto& [mirror, drawing] : plan.own)
        if (!(drawing == plan.rest)) text += std::to_string(mirror) + "=" + text_of(drawing) + " ";
    return text.empty() ? text_of(plan.rest) : text + "*=" + text_of(plan.rest);
}

std::vector<std::string> words_of(const PlanState& plan) {
    constexpr std::string_view kFile = "plan:";
    const std::string text = text_of(plan);
    if (text.starts_with(kFile)) return {"--plan", text.substr(kFile.size())};
    return {app::parse_technique(text).technique == "plan" ? "--plan" : "--technique", text};
}

PlanState plan_of(const std::string& text) {
    const app::TechniqueChoice choice = app::parse_technique(text);
    PlanState plan;
    if (find(choice.technique))
        plan.rest = drawing_of(choice.technique, choice.settings);
    else
        plan.typed = text;
    return plan;
}

PlanState resolved(const PlanState& plan, const std::vector<PlanEntry>& entries) {
    if (plan.typed.empty() || entries.empty()) return plan;
    PlanState made;
    made.rest = drawing_of(entries.front().technique, entries.front().settings);
    for (const PlanEntry& entry : entries) {
        const TechniqueSettings drawing = drawing_of(entry.technique, entry.settings);
        if (!(drawing == made.rest)) made.own[entry.mirror] = drawing;
    }
    return made;
}

void set(TechniqueSettings& drawing, const app::KnobInfo& knob, const std::string& value) {
    if (value == knob.value)
        drawing.knobs.erase(knob.name);
    else
        drawing.knobs[knob.name] = value;
}

std::string value_of(const TechniqueSettings& drawing, const app::KnobInfo& knob) {
    const auto found = drawing.knobs.find(knob.name);
    return found == drawing.knobs.end() ? knob.value : found->second;
}

PlanState with(PlanState plan, const std::string& knob, const std::string& value) {
    const auto change = [&](TechniqueSettings& drawing) {
        const app::TechniqueInfo* technique = find(drawing.technique);
        if (!technique) return;
        const auto known = std::ranges::find(technique->knobs, knob, &app::KnobInfo::name);
        if (known != technique->knobs.end()) set(drawing, *known, value);
    };
    change(plan.rest);
    for (auto& [mirror, drawing] : plan.own) change(drawing);
    return plan;
}

std::string json_of(const PlanState& plan) {
    nlohmann::json rules = nlohmann::json::array();
    for (const auto& [mirror, drawing] : plan.own) rules.push_back(rule_of(mirror, drawing));
    rules.push_back(rule_of("*", plan.rest));
    return nlohmann::json{{"plan", rules}}.dump(2) + "\n";
}

} // namespace catoptric::view
