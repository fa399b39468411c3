#pragma once

#include "app/engine.hpp"
#include "inputs.hpp"

#include <memory>

struct GLFWwindow;

namespace catoptric::view {

/// A window of the desktop. One a process; of the main thread.
class Window {
public:
    /// `size`: in the desktop's units. Throws `no_device` where there is no display, or none that
    /// Vulkan can show pictures on.
    Window(const std::string& title, uvec2 size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What an engine needs to show pictures here. The window must outlive it.
    void add_to(app::EngineOptions& options) const;
    /// What has happened; `wait`: sleeps up to a tenth of a second for something to happen.
    Inputs poll(bool wait);
    void resize(uvec2 size); ///< in the desktop's units
    void copy(const std::string& text);
    GLFWwindow* handle() const { return window_; }

private:
    friend struct Callbacks;
    GLFWwindow* window_ = nullptr;
    Inputs gathered_; ///< by callbacks, since the last poll
    double polled_ = 0;
};

} // namespace catoptric::view
