#include "controls.hpp"

#include <algorithm>

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

namespace catoptric::view {

namespace {

/// Returns the part of a rectangle that lies within the window, or none.
std::optional<std::array<std::uint32_t, 4>> clip_to_window(const ImVec4& clip, const ImVec2& size) {
    const float left = std::max(clip.x, 0.f), top = std::max(clip.y, 0.f),
                right = std::min(clip.z, size.x), bottom = std::min(clip.w, size.y);
    if (right <= left || bottom <= top) return {};
    const auto x = static_cast<std::uint32_t>(left), y = static_cast<std::uint32_t>(top);
    return std::array{x, y, static_cast<std::uint32_t>(right) - x,
                      static_cast<std::uint32_t>(bottom) - y};
}

} // namespace

ImGuiControls::ImGuiControls(ViewWindow& window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // the program stores its own settings
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.Fonts->Flags |= ImFontAtlasFlags_NoBakedLines;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 0;
    ImGui_ImplGlfw_InitForVulkan(window.glfw_window(), true);
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&texels, &width,
                                 &height); // ImGui refuses to begin without a built font
}

ImGuiControls::~ImGuiControls() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void ImGuiControls::upload_font(session::WindowScreen& screen) const {
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&texels, &width, &height);
    screen.set_font({static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
                    {texels, texels + static_cast<std::ptrdiff_t>(width) * height});
}

void ImGuiControls::begin(uvec2 window, const UserInput& inputs) {
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(window.x), static_cast<float>(window.y)};
    io.MousePos = {static_cast<float>(inputs.mouse.x), static_cast<float>(inputs.mouse.y)};
    for (std::size_t button = 0; button < inputs.down.size(); ++button)
        io.MouseDown[button] |= inputs.down[button];
    ImGui::NewFrame();
}

session::WindowOverlay ImGuiControls::end() {
    ImGui::Render();
    const ImDrawData& data = *ImGui::GetDrawData();
    session::WindowOverlay overlay;
    for (int l = 0; l < data.CmdListsCount; ++l) {
        const ImDrawList& list = *data.CmdLists[l];
        const auto first_vertex = static_cast<std::uint32_t>(overlay.vertices.size());
        const auto first_index = static_cast<std::uint32_t>(overlay.indices.size());
        for (const ImDrawVert& vertex : list.VtxBuffer)
            overlay.vertices.push_back(
                {{vertex.pos.x, vertex.pos.y}, {vertex.uv.x, vertex.uv.y}, vertex.col});
        std::uint32_t at = 0;
        for (const ImDrawCmd& command : list.CmdBuffer) {
            for (std::uint32_t i = 0; i < command.ElemCount; ++i, ++at)
                overlay.indices.push_back(first_vertex + command.VtxOffset +
                                          list.IdxBuffer[static_cast<int>(command.IdxOffset + i)]);
            if (const auto area = clip_to_window(command.ClipRect, data.DisplaySize))
                overlay.draws.push_back(
                    {first_index + command.IdxOffset, command.ElemCount, *area});
        }
    }
    return overlay;
}

bool ImGuiControls::takes_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool ImGuiControls::takes_keyboard() const { return ImGui::GetIO().WantTextInput; }

} // namespace catoptric::view
