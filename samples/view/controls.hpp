#pragma once

#include "app/screen.hpp"
#include "window.hpp"

namespace catoptric::view {

/// Dear ImGui in a window: one a process. Its triangles are drawn by Session::show.
class Controls {
public:
    /// Installs its own callbacks after the window's, which it calls.
    explicit Controls(Window& window);
    ~Controls();
    Controls(const Controls&) = delete;
    Controls& operator=(const Controls&) = delete;

    /// Of each new screen.
    void give_font(app::Screen& screen) const;
    /// Between these, ImGui:: calls make controls. `window`: as it is, pixels. What the mouse does
    /// is what the inputs say.
    void begin(uvec2 window, const Inputs& inputs);
    app::Overlay end();
    /// Of the last frame: the mouse is over controls, or a text is being typed.
    bool has_mouse() const;
    bool has_keys() const;
};

} // namespace catoptric::view
