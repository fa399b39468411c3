// Draws the controls for techniques and their knobs, from the table of techniques.
#include "panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>

namespace catoptric::view {

namespace {

void draw_choice_knob(TechniqueSettings& settings, const session::KnobInfo& knob) {
    const std::string value = knob_value(settings, knob);
    if (!ImGui::BeginCombo(knob.name.c_str(), value.c_str())) return;
    for (const std::string& choice : knob.choices)
        if (ImGui::Selectable(choice.c_str(), choice == value)) set(settings, knob, choice);
    ImGui::EndCombo();
}

/// Draws a number with buttons that halve it, double it or replace it by the knob's special word.
void draw_number_knob(TechniqueSettings& settings, const session::KnobInfo& knob) {
    constexpr int kMaxSliderRange = 64;
    const std::string text = knob_value(settings, knob);
    const bool is_special = !knob.special.empty() && text == knob.special;
    const int low = static_cast<int>(knob.low), high = static_cast<int>(knob.high);
    int value = is_special ? low : std::atoi(text.c_str());
    ImGui::PushItemWidth(110);
    if (is_special)
        ImGui::TextDisabled("%s: %s", knob.name.c_str(), knob.special.c_str());
    else if (high - low <= kMaxSliderRange ? ImGui::SliderInt(knob.name.c_str(), &value, low, high)
                                           : ImGui::InputInt(knob.name.c_str(), &value, 0, 0,
                                                             ImGuiInputTextFlags_EnterReturnsTrue))
        set(settings, knob, std::to_string(std::clamp(value, low, high)));
    ImGui::PopItemWidth();
    if (high - low > kMaxSliderRange && !is_special) {
        ImGui::SameLine(210);
        if (ImGui::SmallButton("/2"))
            set(settings, knob, std::to_string(std::clamp(value / 2, low, high)));
        ImGui::SameLine();
        if (ImGui::SmallButton("x2"))
            set(settings, knob, std::to_string(std::clamp(value * 2, low, high)));
    }
    if (knob.special.empty()) return;
    ImGui::SameLine(275);
    bool now = is_special;
    if (ImGui::Checkbox(knob.special.c_str(), &now))
        set(settings, knob,
            now                          ? knob.special
            : knob.value == knob.special ? std::to_string(low)
                                         : knob.value);
}

void draw_knob_controls(TechniqueSettings& settings) {
    const session::TechniqueInfo* technique = technique_info(settings.technique);
    if (!technique) return;
    for (const session::KnobInfo& knob : technique->knobs) {
        ImGui::PushID(knob.name.c_str());
        if (knob.choices.empty())
            draw_number_knob(settings, knob);
        else
            draw_choice_knob(settings, knob);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", knob.help.c_str());
        ImGui::PopID();
    }
}

void draw_technique_controls(TechniqueSettings& settings) {
    if (ImGui::BeginCombo("technique", settings.technique.c_str())) {
        for (const session::TechniqueInfo& technique : technique_infos()) {
            if (ImGui::Selectable(technique.name.c_str(), technique.name == settings.technique) &&
                technique.name != settings.technique)
                settings = {technique.name, {}};
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", technique.summary.c_str());
        }
        ImGui::EndCombo();
    }
    draw_knob_controls(settings);
}

void draw_mirror_technique(EditedPlan& plan, std::uint32_t& chosen, const scene::Scene& scene,
                           const std::vector<PlanEntry>& entries) {
    if (!plan.typed.empty()) {
        ImGui::TextWrapped("%s", plan.typed.c_str());
        for (const PlanEntry& entry : entries)
            ImGui::TextWrapped("%u %s: %s (%s)", entry.mirror, entry.name.c_str(),
                               entry.technique.c_str(), entry.why.c_str());
        if (ImGui::SmallButton("edit it mirror by mirror")) plan = resolve_plan(plan, entries);
        return;
    }
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    const auto name = [&](std::uint32_t mirror) {
        return mirror == 0
                   ? std::string("all, but those with their own")
                   : fmt::format("mirror {}: {}{}", mirror, scene.objects[mirrors[mirror - 1]].name,
                                 plan.own.contains(mirror) ? " *" : "");
    };
    chosen = std::min(chosen, static_cast<std::uint32_t>(mirrors.size()));
    if (ImGui::BeginCombo("of", name(chosen).c_str())) {
        for (std::uint32_t m = 0; m <= mirrors.size(); ++m)
            if (ImGui::Selectable(name(m).c_str(), m == chosen)) chosen = m;
        ImGui::EndCombo();
    }
    if (chosen == 0) return draw_technique_controls(plan.rest);
    const auto own = plan.own.find(chosen);
    TechniqueSettings settings = own == plan.own.end() ? plan.rest : own->second;
    draw_technique_controls(settings);
    if (own != plan.own.end() && ImGui::SmallButton("as all others"))
        plan.own.erase(own);
    else if (own != plan.own.end() || !(settings == plan.rest))
        plan.own[chosen] = settings;
}

/// Draws a slider of the chosen mirror's roughness. It is disabled if a texture varies the
/// material.
void draw_roughness_slider(ViewState& state, const scene::Scene& scene) {
    if (state.chosen == 0) return;
    const std::optional<float> given = find_editable_roughness(scene, state.chosen);
    if (!given) return ImGui::TextDisabled("roughness: by the scene's material");
    const auto set = state.roughness.find(state.chosen);
    float value = set == state.roughness.end() ? *given : set->second;
    ImGui::PushItemWidth(110);
    if (ImGui::SliderFloat("roughness", &value, 0, scene.mirror_max_roughness, "%.2f",
                           ImGuiSliderFlags_AlwaysClamp))
        state.roughness[state.chosen] = value;
    ImGui::PopItemWidth();
    if (set == state.roughness.end()) return;
    ImGui::SameLine(210);
    if (ImGui::SmallButton("as in the scene")) state.roughness.erase(state.chosen);
}

} // namespace

void draw_plan_controls(ViewState& state, const scene::Scene& scene,
                        const std::vector<PlanEntry>& entries) {
    const bool has_other = (state.mode == ViewMode::split || state.mode == ViewMode::difference) &&
                           state.against == ComparisonPicture::other;
    if (!has_other) {
        draw_mirror_technique(state.plan, state.chosen, scene, entries);
        return draw_roughness_slider(state, scene);
    }
    if (ImGui::RadioButton("the plan", !state.edits_other)) state.edits_other = false;
    ImGui::SameLine();
    if (ImGui::RadioButton("the other", state.edits_other)) state.edits_other = true;
    draw_mirror_technique(state.edits_other ? state.other : state.plan, state.chosen, scene,
                          entries);
    draw_roughness_slider(state, scene);
}

} // namespace catoptric::view
