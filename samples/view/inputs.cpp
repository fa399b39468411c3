#include "inputs.hpp"
#include "scene/pose.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

namespace catoptric::view {

namespace {

constexpr double kGrip = 6;  // distance in pixels at which the divider can be dragged
constexpr double kStray = 3; // most pixels that the mouse moves during a click

} // namespace

const std::vector<KeyBinding>& keys() {
    static const std::vector<KeyBinding> kList{
        {GLFW_KEY_F1, Act::keys, 0, "F1", "this list"},
        {GLFW_KEY_TAB, Act::panels, 0, "Tab", "controls come and go"},
        {GLFW_KEY_SPACE, Act::pause, 0, "Space", "motion stops and goes on"},
        {GLFW_KEY_PERIOD, Act::step, 0, ".", "a sixtieth of a second on"},
        {GLFW_KEY_COMMA, Act::back, 0, ",", "a sixtieth of a second back"},
        {GLFW_KEY_1, Act::mode, 0, "1", "the plan's picture"},
        {GLFW_KEY_2, Act::mode, 1, "2", "split: drag the divider"},
        {GLFW_KEY_3, Act::mode, 2, "3", "difference"},
        {GLFW_KEY_4, Act::mode, 3, "4", "answers: hit, unknown, miss"},
        {GLFW_KEY_5, Act::mode, 4, "5", "numbers of mirrors"},
        {GLFW_KEY_6, Act::mode, 5, "6", "a cause of error"},
        {GLFW_KEY_X, Act::against, 0, "X", "compared with: another plan, the reference"},
        {GLFW_KEY_G, Act::gain, 0, "G", "differences x1 to x64"},
        {GLFW_KEY_F, Act::fly, 0, "F", "the mouse orbits, or looks around"},
        {GLFW_KEY_V, Act::camera, 0, "V", "the scene's next camera"},
        {GLFW_KEY_M, Act::model, 0, "M", "what is required, or everything"},
        {GLFW_KEY_R, Act::cut, 0, "R", "a cut: history is forgotten"},
        {GLFW_KEY_C, Act::copy, 0, "C", "copies the command of this picture"},
        {GLFW_KEY_P, Act::picture, 0, "P", "writes the picture (PNG and EXR)"},
        {GLFW_KEY_L, Act::save_plan, 0, "L", "writes the plan (JSON)"},
        {GLFW_KEY_ESCAPE, Act::quit, 0, "Esc", "ends"},
    };
    return kList;
}

dvec2 pixels_per_unit(uvec2 pixels, uvec2 units) {
    const bool is_known = pixels.x > 0 && pixels.y > 0 && units.x > 0 && units.y > 0;
    return is_known ? dvec2(pixels) / dvec2(units) : dvec2(1);
}

uvec2 picture_size(uvec2 window, bool shows_panels) {
    constexpr std::uint32_t kLeast = 16;
    const std::uint32_t taken = shows_panels ? kPanelWidth : 0;
    return {std::max(window.x > taken ? window.x - taken : 0, kLeast), std::max(window.y, kLeast)};
}

Hand::Holds Hand::grasp(const Inputs& inputs, const State& state, uvec2 size) const {
    const double divider = state.divider * size.x;
    if (inputs.on_controls || inputs.mouse.x >= size.x) return Holds::controls;
    if (inputs.down[1] || inputs.down[2]) return Holds::shifting;
    const bool on_divider = state.mode == Mode::split &&
                            std::abs(inputs.mouse.x - divider) <= kGrip;
    return on_divider ? Holds::divider : Holds::turning;
}

std::optional<uvec2> Hand::apply(const Inputs& inputs, State& state, uvec2 size, double reach) {
    const bool is_down = inputs.down[0] || inputs.down[1] || inputs.down[2];
    std::optional<uvec2> clicked;
    if (!is_down) {
        if (holds_ == Holds::turning && !strayed_)
            clicked = glm::min(uvec2(glm::max(pressed_, dvec2(0))), size - 1u);
        holds_ = Holds::nothing;
    } else if (holds_ == Holds::nothing) {
        holds_ = grasp(inputs, state, size);
        last_ = pressed_ = inputs.mouse;
        strayed_ = false;
    }
    strayed_ |= is_down && glm::length(inputs.mouse - pressed_) > kStray;
    Moves moves;
    const dvec2 dragged = inputs.mouse - last_;
    if (holds_ == Holds::turning && strayed_) moves.turned = dragged;
    if (holds_ == Holds::shifting) moves.shifted = dragged;
    if (holds_ == Holds::divider) state.divider = std::clamp(inputs.mouse.x / size.x, 0., 1.);
    if (!inputs.on_controls) moves.wheel = inputs.wheel;
    moves.flown = inputs.flies * inputs.seconds;
    if (holds_ != Holds::turning || strayed_) last_ = inputs.mouse;
    if (moves.any())
        state.camera = moved(scene::camera_at(state.camera, state.motion.time), moves, state.flies,
                             size.y, reach);
    return clicked;
}

} // namespace catoptric::view
