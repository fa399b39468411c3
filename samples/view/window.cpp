// The only file that uses types of the window library and Vulkan surface types.
#include "window.hpp"

#include "core/error.hpp"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace catoptric::view {

namespace {

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason was given";
}

uvec2 make_size(int width, int height) {
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

std::uint64_t make_surface(GLFWwindow* window, void* instance) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(static_cast<VkInstance>(instance), window,
                                                    nullptr, &surface);
    check(result == VK_SUCCESS, Failure::no_device,
          "the window cannot show pictures by Vulkan: ", last_error());
    return reinterpret_cast<std::uint64_t>(surface);
}

} // namespace

/// Callbacks of the window library, called while events are polled.
struct WindowCallbacks {
    static UserInput& input_of(GLFWwindow* window) {
        return static_cast<ViewWindow*>(glfwGetWindowUserPointer(window))->gathered_;
    }
    static void on_key_pressed(GLFWwindow* window, int code, int, int action, int) {
        if (action == GLFW_RELEASE) return;
        const auto repeats = [](const KeyBinding& key) {
            return key.act == KeyAction::step || key.act == KeyAction::back;
        };
        for (const KeyBinding& key : key_bindings())
            if (key.code == code && (action == GLFW_PRESS || repeats(key)))
                input_of(window).acts.push_back(key);
    }
    static void on_mouse_scrolled(GLFWwindow* window, double, double y) {
        input_of(window).wheel += y;
    }
    static void on_files_dropped(GLFWwindow* window, int count, const char** paths) {
        for (int i = 0; i < count; ++i) input_of(window).dropped.emplace_back(paths[i]);
    }
};

ViewWindow::ViewWindow(const std::string& title, uvec2 size) {
    if (!glfwInit())
        fail(Failure::no_device,
             "no display: a window needs one (is DISPLAY set?); 'catoptric render' makes pictures "
             "without (",
             last_error(), ")");
    if (!glfwVulkanSupported()) {
        glfwTerminate();
        fail(Failure::no_device, "this display shows no pictures by Vulkan; no driver is "
                                 "installed: apt-get install mesa-vulkan-drivers");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(size.x), static_cast<int>(size.y), title.c_str(),
                               nullptr, nullptr);
    if (!window_) {
        const std::string why = last_error();
        glfwTerminate();
        fail(Failure::no_device, "no window could be opened: ", why);
    }
    // Keeps a click between two frames until the next frame.
    glfwSetInputMode(window_, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, WindowCallbacks::on_key_pressed);
    glfwSetScrollCallback(window_, WindowCallbacks::on_mouse_scrolled);
    glfwSetDropCallback(window_, WindowCallbacks::on_files_dropped);
    polled_ = glfwGetTime();
}

ViewWindow::~ViewWindow() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void ViewWindow::add_hooks(session::EngineHooks& hooks) const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    hooks.instance_extensions.assign(names, names + count);
    hooks.make_surface = [window = window_](void* instance) {
        return make_surface(window, instance);
    };
}

UserInput ViewWindow::poll_events(bool wait) {
    constexpr double kMaxWaitSeconds = .1;
    if (wait)
        glfwWaitEventsTimeout(kMaxWaitSeconds);
    else
        glfwPollEvents();
    UserInput inputs = std::exchange(gathered_, {});
    int width = 0, height = 0, wide = 0, high = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glfwGetWindowSize(window_, &wide, &high);
    if (!glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) inputs.window = make_size(width, height);
    inputs.scale = pixels_per_unit(inputs.window, make_size(wide, high));
    glfwGetCursorPos(window_, &inputs.mouse.x, &inputs.mouse.y);
    inputs.mouse *= inputs.scale;
    for (int button = 0; button < 3; ++button)
        inputs.down[static_cast<std::size_t>(button)] = glfwGetMouseButton(window_, button) ==
                                                        GLFW_PRESS;
    const auto axis = [&](int forwards, int backwards) {
        return (glfwGetKey(window_, forwards) == GLFW_PRESS) -
               (glfwGetKey(window_, backwards) == GLFW_PRESS);
    };
    inputs.flies = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                    axis(GLFW_KEY_W, GLFW_KEY_S)};
    inputs.closes = glfwWindowShouldClose(window_) == GLFW_TRUE;
    const double now = glfwGetTime();
    inputs.seconds = std::min(now - std::exchange(polled_, now), kMaxWaitSeconds);
    return inputs;
}

void ViewWindow::resize(uvec2 size) {
    glfwSetWindowSize(window_, static_cast<int>(size.x), static_cast<int>(size.y));
}

void ViewWindow::copy_to_clipboard(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}

} // namespace catoptric::view
