#pragma once

#include "inputs.hpp"
#include "session/access.hpp"
#include "session/engine.hpp"

#include <memory>

struct GLFWwindow;

namespace catoptric::view {

/// A window of the desktop. At most one per process, used by the main thread only.
class ViewWindow {
public:
    /// Opens a window of `size`, in desktop units. Throws `no_device` if there is no display, or
    /// none that Vulkan can show pictures on.
    ViewWindow(const std::string& title, uvec2 size);
    ~ViewWindow();
    ViewWindow(const ViewWindow&) = delete;
    ViewWindow& operator=(const ViewWindow&) = delete;

    /// Adds to the hooks what an engine needs to show pictures in this window. The window must
    /// outlive the engine.
    void add_hooks(session::EngineHooks& hooks) const;
    /// Returns the input since the last call. With `wait`, sleeps up to a tenth of a second until
    /// something happens.
    UserInput poll_events(bool wait);
    void resize(uvec2 size); ///< desktop units
    void copy_to_clipboard(const std::string& text);
    GLFWwindow* glfw_window() const { return window_; }

private:
    friend struct WindowCallbacks;
    GLFWwindow* window_ = nullptr;
    UserInput gathered_; ///< gathered by callbacks since the last poll
    double polled_ = 0;
};

} // namespace catoptric::view
