#include "plan_state.hpp"
#include "session/technique_choice.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace catoptric::view {

namespace {

TechniqueSettings make_technique_settings(const std::string& technique,
                                          const std::vector<Setting>& settings) {
    TechniqueSettings made{technique, {}};
    for (const Setting& setting : settings)
        if (setting.changed) made.knobs[setting.name] = setting.text;
    return made;
}

nlohmann::json make_rule_json(nlohmann::json mirror, const TechniqueSettings& settings) {
    nlohmann::json knobs = nlohmann::json::object();
    for (const auto& [knob, value] : settings.knobs) knobs[knob] = value;
    return {{"mirror", std::move(mirror)},
            {"technique", settings.technique},
            {"settings", std::move(knobs)}};
}

} // namespace

const std::vector<session::TechniqueInfo>& technique_infos() {
    static const std::vector<session::TechniqueInfo> kTechniqueInfos = session::techniques();
    return kTechniqueInfos;
}

const session::TechniqueInfo* technique_info(const std::string& technique) {
    const auto found = std::ranges::find(technique_infos(), technique,
                                         &session::TechniqueInfo::name);
    return found == technique_infos().end() ? nullptr : &*found;
}

std::string technique_text(const TechniqueSettings& settings) {
    std::string text = settings.technique;
    char before = ':';
    for (const auto& [knob, value] : settings.knobs) {
        text += before + knob + "=" + value;
        before = ',';
    }
    return text;
}

std::string technique_text(const EditedPlan& plan) {
    if (!plan.typed.empty()) return plan.typed;
    std::string text;
    for (const auto& [mirror, settings] : plan.own)
        if (!(settings == plan.rest))
            text += std::to_string(mirror) + "=" + technique_text(settings) + " ";
    return text.empty() ? technique_text(plan.rest) : text + "*=" + technique_text(plan.rest);
}

std::vector<std::string> plan_words(const EditedPlan& plan) {
    constexpr std::string_view kPlanFilePrefix = "plan:";
    const std::string text = technique_text(plan);
    if (text.starts_with(kPlanFilePrefix)) return {"--plan", text.substr(kPlanFilePrefix.size())};
    return {session::parse_technique(text).technique == "plan" ? "--plan" : "--technique", text};
}

EditedPlan parse_plan(const std::string& text) {
    const session::ParsedTechnique choice = session::parse_technique(text);
    EditedPlan plan;
    if (technique_info(choice.technique))
        plan.rest = make_technique_settings(choice.technique, choice.settings);
    else
        plan.typed = text;
    return plan;
}

EditedPlan resolve_plan(const EditedPlan& plan, const std::vector<PlanEntry>& entries) {
    if (plan.typed.empty() || entries.empty()) return plan;
    EditedPlan made;
    made.rest = make_technique_settings(entries.front().technique, entries.front().settings);
    for (const PlanEntry& entry : entries) {
        const TechniqueSettings settings = make_technique_settings(entry.technique, entry.settings);
        if (!(settings == made.rest)) made.own[entry.mirror] = settings;
    }
    return made;
}

void set(TechniqueSettings& settings, const session::KnobInfo& knob, const std::string& value) {
    if (value == knob.value)
        settings.knobs.erase(knob.name);
    else
        settings.knobs[knob.name] = value;
}

std::string knob_value(const TechniqueSettings& settings, const session::KnobInfo& knob) {
    const auto found = settings.knobs.find(knob.name);
    return found == settings.knobs.end() ? knob.value : found->second;
}

EditedPlan set_knob(EditedPlan plan, const std::string& knob, const std::string& value) {
    const auto change = [&](TechniqueSettings& settings) {
        const session::TechniqueInfo* technique = technique_info(settings.technique);
        if (!technique) return;
        const auto known = std::ranges::find(technique->knobs, knob, &session::KnobInfo::name);
        if (known != technique->knobs.end()) set(settings, *known, value);
    };
    change(plan.rest);
    for (auto& [mirror, settings] : plan.own) change(settings);
    return plan;
}

std::string plan_to_json(const EditedPlan& plan) {
    nlohmann::json rules = nlohmann::json::array();
    for (const auto& [mirror, settings] : plan.own)
        rules.push_back(make_rule_json(mirror, settings));
    rules.push_back(make_rule_json("*", plan.rest));
    return nlohmann::json{{"plan", rules}}.dump(2) + "\n";
}

} // namespace catoptric::view
