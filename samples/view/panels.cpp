// Draws the controls beside the picture.
#include "panels.hpp"

#include "inputs.hpp"
#include "session/capture_budget.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace catoptric::view {

namespace {

void draw_mode_controls(ViewState& state) {
    for (int i = 0; i < kViewModeCount; ++i) {
        const auto mode = static_cast<ViewMode>(i);
        if (i % 3 != 0) ImGui::SameLine(static_cast<float>(i % 3) * 115);
        if (ImGui::RadioButton(mode_name(mode), state.mode == mode)) state.mode = mode;
    }
    const bool compares = state.mode == ViewMode::split || state.mode == ViewMode::difference;
    if (compares) {
        int against = static_cast<int>(state.against);
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted("with");
        ImGui::SameLine();
        ImGui::RadioButton("another plan", &against, 0);
        ImGui::SameLine();
        ImGui::RadioButton("the reference", &against, 1);
        state.against = static_cast<ComparisonPicture>(against);
    }
    if (state.mode == ViewMode::difference || state.mode == ViewMode::causes) {
        int power = std::bit_width(static_cast<unsigned>(state.gain)) - 1;
        const std::string format = fmt::format("x{}", state.gain);
        ImGui::SliderInt("gain", &power, 0, 6, format.c_str(), ImGuiSliderFlags_AlwaysClamp);
        state.gain = 1 << power;
    }
    if (state.mode == ViewMode::causes)
        for (const CauseLabel& cause : cause_labels())
            if (ImGui::RadioButton(cause.name, state.cause == cause.bit)) state.cause = cause.bit;
    if (state.mode == ViewMode::answers)
        ImGui::TextWrapped(state.plan.typed.empty()
                               ? "green: hit, red: unknown, blue: miss; of techniques that search"
                               : "a plan that was typed shows its colours: edit it mirror by "
                                 "mirror first");
}

void draw_playback_controls(ViewState& state, double period) {
    if (ImGui::Button(state.motion.plays ? "pause" : "play")) state.motion.plays ^= true;
    ImGui::SameLine();
    if (ImGui::Button("-1/60")) state.motion.plays = false, state.motion.time -= kFrameStepSeconds;
    ImGui::SameLine();
    if (ImGui::Button("+1/60")) state.motion.plays = false, state.motion.time += kFrameStepSeconds;
    ImGui::SameLine();
    auto speed = static_cast<float>(state.motion.speed);
    ImGui::SetNextItemWidth(110);
    if (ImGui::SliderFloat("speed", &speed, -4, 4, "%.2f", ImGuiSliderFlags_AlwaysClamp))
        state.motion.speed = speed;
    auto time = static_cast<float>(state.motion.time);
    if (ImGui::SliderFloat("s", &time, 0, static_cast<float>(std::max(period, 1.)), "%.3f",
                           ImGuiSliderFlags_AlwaysClamp))
        state.motion.time = time, state.motion.plays = false;
    if (period == 0) ImGui::TextDisabled("nothing moves in this scene");
}

void draw_errors(ViewState& state, const SceneViewer& viewer, const study::PlanAudit* audit) {
    if (audit != nullptr) ImGui::TextWrapped("%s", audit->describe().c_str());
    ImGui::Checkbox("errors against the traced reference", &state.judges);
    const int passes = viewer.progressive_reference().pass_count();
    if (passes > 0)
        ImGui::Text("reference: %d of %d passes", passes, ProgressiveReference::kMaxPasses);
    if (!viewer.measured_error()) return;
    const measure::Difference& error = *viewer.measured_error();
    ImGui::Text("mirrors: FLIP %.4f  RMSE %.4f", error.flip, error.rmse);
    ImGui::Text("p99 %.4f  off %.2f %% of %zu pixels", error.p99, 100 * error.off, error.pixels);
}

void draw_culled_work(ViewState& state, const SceneViewer& viewer) {
    int model = state.model == session::RenderedWork::required;
    ImGui::RadioButton("required", &model, 1);
    ImGui::SameLine();
    ImGui::RadioButton("everything", &model, 0);
    state.model = model ? session::RenderedWork::required : session::RenderedWork::everything;
    if (viewer.capture_budget())
        ImGui::TextWrapped("%s", session::describe_budget(*viewer.capture_budget()).c_str());
    for (const require::CulledWork& left : viewer.culled_work())
        ImGui::TextWrapped("%s: %s; saves %s", left.what.c_str(), left.why.c_str(),
                           left.saves.c_str());
    if (viewer.culled_work().empty()) ImGui::TextDisabled("nothing is left out");
}

void draw_action_buttons(PanelRequests& requests) {
    requests.copies |= ImGui::Button("copy command");
    ImGui::SameLine();
    requests.writes |= ImGui::Button("screenshot");
    ImGui::SameLine();
    requests.saves_plan |= ImGui::Button("save plan");
    ImGui::SameLine();
    requests.cuts |= ImGui::Button("cut");
}

void draw_key_help(uvec2 window) {
    ImGui::SetNextWindowPos({20, 20});
    ImGui::SetNextWindowSizeConstraints(
        {0, 0}, {static_cast<float>(window.x), static_cast<float>(window.y)});
    ImGui::Begin("Keys", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
    for (const KeyBinding& key : key_bindings()) {
        ImGui::TextUnformatted(key.name);
        ImGui::SameLine(70);
        ImGui::TextUnformatted(key.does);
    }
    ImGui::Separator();
    ImGui::TextUnformatted("drag: turn; right button: shift; wheel: nearer\n"
                           "W A S D Q E: fly; click: the mirror to edit\n"
                           "a file dropped here is loaded");
    ImGui::End();
}

} // namespace

void draw_panels(ViewState& state, const PanelData& data, uvec2 window, PanelRequests& requests) {
    if (state.shows_keys) draw_key_help(window);
    if (!state.shows_panels) return;
    ImGui::SetNextWindowPos({static_cast<float>(window.x) - kPanelWidth, 0});
    ImGui::SetNextWindowSize({kPanelWidth, static_cast<float>(window.y)});
    ImGui::Begin("Catoptric", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoTitleBar);
    const TimeStatistics& times = data.viewer.times();
    ImGui::Text("%s  %.1f ms a frame, %.1f FPS", data.scene.name.c_str(), times.frame().median,
                times.fps());
    draw_action_buttons(requests);
    if (!state.said.empty()) ImGui::TextWrapped("%s", state.said.c_str());
    const auto section = [](const char* name, bool is_open = true) {
        return ImGui::CollapsingHeader(name, is_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    };
    if (section("View")) draw_mode_controls(state);
    if (section("Errors")) draw_errors(state, data.viewer, data.audit);
    if (section("Plan")) draw_plan_controls(state, data.scene, data.entries);
    if (section("Motion")) draw_playback_controls(state, data.period);
    if (section("Times")) draw_frame_times(data.viewer);
    if (section("Left out", false)) draw_culled_work(state, data.viewer);
    if (section("Scene", false)) draw_scene_facts(data.scene, requests);
    ImGui::End();
}

} // namespace catoptric::view
