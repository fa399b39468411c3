#pragma once

#include "session/screen.hpp"
#include "window.hpp"

namespace catoptric::view {

/// Dear ImGui in a window, at most one per process. Access::show draws its triangles.
class ImGuiControls {
public:
    /// Installs callbacks that also call the window's earlier callbacks.
    explicit ImGuiControls(ViewWindow& window);
    ~ImGuiControls();
    ImGuiControls(const ImGuiControls&) = delete;
    ImGuiControls& operator=(const ImGuiControls&) = delete;

    /// Gives the font to a screen. Needed once per new screen.
    void upload_font(session::WindowScreen& screen) const;
    /// Begins and ends the controls of a frame. ImGui:: calls in between add controls. `window` is
    /// the window's size in pixels. `inputs` supplies the mouse.
    void begin(uvec2 window, const UserInput& inputs);
    session::WindowOverlay end();
    /// Returns whether, in the last frame, the mouse was over controls (`takes_mouse`) or
    /// a text was being typed (`takes_keyboard`).
    bool takes_mouse() const;
    bool takes_keyboard() const;
};

} // namespace catoptric::view
