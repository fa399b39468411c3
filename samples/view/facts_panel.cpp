// Draws the panels with the times of passes and of the host, and with facts about the scene.
#include "panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace catoptric::view {

namespace {

void draw_time_row(const TimeRow& line, double most) {
    std::string text = fmt::format("{:.2f} ms", line.median);
    if (line.ci95.is_known())
        text += fmt::format(" [{:.2f} {:.2f}]", line.ci95.low, line.ci95.high);
    const float share = most > 0 ? static_cast<float>(line.median / most) : 0;
    ImGui::ProgressBar(share, {190, 0}, text.c_str());
    ImGui::SameLine();
    ImGui::TextUnformatted(line.name.c_str());
}

void draw_time_rows(const std::vector<TimeRow>& lines) {
    double most = 0;
    for (const TimeRow& line : lines) most = std::max(most, line.median);
    for (const TimeRow& line : lines) draw_time_row(line, most);
}

void draw_mirror_facts(const scene::Object& object, std::size_t number) {
    ImGui::BulletText("mirror %zu: %s%s", number, object.name.c_str(),
                      object.sphere ? ", a sphere" : "");
}

} // namespace

void draw_frame_times(const SceneViewer& viewer) {
    const TimeStatistics& times = viewer.times();
    draw_time_row(times.gpu(), times.frame().median);
    if (ImGui::TreeNodeEx("passes", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_time_rows(times.list_pass_times());
        ImGui::TreePop();
    }
    if (ImGui::TreeNode("host")) {
        draw_time_rows(times.host());
        ImGui::TreePop();
    }
    ImGui::TextDisabled("medians of %zu %s, with 95 %% intervals", times.frame_count(),
                        times.frame_count() == 1 ? "frame" : "frames");
}

void draw_scene_facts(const scene::Scene& scene, PanelRequests& requests) {
    ImGui::Text("%zu objects, %zu triangles, %zu materials", scene.objects.size(),
                scene::triangle_count(scene), scene.materials.size());
    if (ImGui::TreeNode("objects", "objects (%zu)", scene.objects.size())) {
        for (const scene::Object& object : scene.objects)
            ImGui::BulletText("%s", object.name.c_str());
        ImGui::TreePop();
    }
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    if (ImGui::TreeNode("mirrors", "mirrors (%zu)", mirrors.size())) {
        for (std::size_t i = 0; i < mirrors.size(); ++i)
            draw_mirror_facts(scene.objects[mirrors[i]], i + 1);
        ImGui::TreePop();
    }
    if (ImGui::TreeNode("cameras", "cameras (%zu)", scene.cameras.size())) {
        for (std::size_t i = 0; i < scene.cameras.size(); ++i)
            if (ImGui::SmallButton(fmt::format("{} {}", i, scene.cameras[i].name).c_str()))
                requests.camera = i;
        ImGui::TreePop();
    }
    if (ImGui::TreeNode("gaps", "gaps (%zu)", scene.unsupported.size())) {
        for (const scene::UnsupportedFeature& gap : scene.unsupported)
            ImGui::BulletText("%s: %zu, first %s", gap.id.c_str(), gap.count, gap.first.c_str());
        ImGui::TreePop();
    }
}

} // namespace catoptric::view
