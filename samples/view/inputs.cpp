#include "inputs.hpp"
#include "scene/pose.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

namespace catoptric::view {

namespace {

constexpr double kDividerGripPixels = 6; // distance in pixels at which the divider can be dragged
constexpr double kMaxClickMovement = 3;  // most pixels that the mouse moves during a click

} // namespace

const std::vector<KeyBinding>& key_bindings() {
    static const std::vector<KeyBinding> kKeyBindings{
        {GLFW_KEY_F1, KeyAction::keys, 0, "F1", "this list"},
        {GLFW_KEY_TAB, KeyAction::panels, 0, "Tab", "controls come and go"},
        {GLFW_KEY_SPACE, KeyAction::pause, 0, "Space", "motion stops and goes on"},
        {GLFW_KEY_PERIOD, KeyAction::step, 0, ".", "a sixtieth of a second on"},
        {GLFW_KEY_COMMA, KeyAction::back, 0, ",", "a sixtieth of a second back"},
        {GLFW_KEY_1, KeyAction::mode, 0, "1", "the plan's picture"},
        {GLFW_KEY_2, KeyAction::mode, 1, "2", "split: drag the divider"},
        {GLFW_KEY_3, KeyAction::mode, 2, "3", "difference"},
        {GLFW_KEY_4, KeyAction::mode, 3, "4", "answers: hit, unknown, miss"},
        {GLFW_KEY_5, KeyAction::mode, 4, "5", "numbers of mirrors"},
        {GLFW_KEY_6, KeyAction::mode, 5, "6", "a cause of error"},
        {GLFW_KEY_X, KeyAction::against, 0, "X", "compared with: another plan, the reference"},
        {GLFW_KEY_G, KeyAction::gain, 0, "G", "differences x1 to x64"},
        {GLFW_KEY_F, KeyAction::fly, 0, "F", "the mouse orbits, or looks around"},
        {GLFW_KEY_V, KeyAction::camera, 0, "V", "the scene's next camera"},
        {GLFW_KEY_M, KeyAction::model, 0, "M", "what is required, or everything"},
        {GLFW_KEY_R, KeyAction::cut, 0, "R", "a cut: history is forgotten"},
        {GLFW_KEY_C, KeyAction::copy, 0, "C", "copies the command of this picture"},
        {GLFW_KEY_P, KeyAction::picture, 0, "P", "writes the picture (PNG and EXR)"},
        {GLFW_KEY_L, KeyAction::save_plan, 0, "L", "writes the plan (JSON)"},
        {GLFW_KEY_ESCAPE, KeyAction::quit, 0, "Esc", "ends"},
    };
    return kKeyBindings;
}

dvec2 pixels_per_unit(uvec2 pixels, uvec2 units) {
    const bool is_known = pixels.x > 0 && pixels.y > 0 && units.x > 0 && units.y > 0;
    return is_known ? dvec2(pixels) / dvec2(units) : dvec2(1);
}

uvec2 choose_picture_size(uvec2 window, bool shows_panels) {
    constexpr std::uint32_t kMinPictureSide = 16;
    const std::uint32_t taken = shows_panels ? kPanelWidth : 0;
    return {std::max(window.x > taken ? window.x - taken : 0, kMinPictureSide),
            std::max(window.y, kMinPictureSide)};
}

MouseDrag::Dragged MouseDrag::begin_drag(const UserInput& inputs, const ViewState& state,
                                         uvec2 size) const {
    const double divider = state.divider * size.x;
    if (inputs.on_controls || inputs.mouse.x >= size.x) return Dragged::controls;
    if (inputs.down[1] || inputs.down[2]) return Dragged::shifting;
    const bool on_divider = state.mode == ViewMode::split &&
                            std::abs(inputs.mouse.x - divider) <= kDividerGripPixels;
    return on_divider ? Dragged::divider : Dragged::turning;
}

std::optional<uvec2> MouseDrag::apply_drag(const UserInput& inputs, ViewState& state, uvec2 size,
                                           double reach) {
    const bool is_down = inputs.down[0] || inputs.down[1] || inputs.down[2];
    std::optional<uvec2> clicked;
    if (!is_down) {
        if (holds_ == Dragged::turning && !strayed_)
            clicked = glm::min(uvec2(glm::max(pressed_, dvec2(0))), size - 1u);
        holds_ = Dragged::nothing;
    } else if (holds_ == Dragged::nothing) {
        holds_ = begin_drag(inputs, state, size);
        last_ = pressed_ = inputs.mouse;
        strayed_ = false;
    }
    strayed_ |= is_down && glm::length(inputs.mouse - pressed_) > kMaxClickMovement;
    CameraMoves moves;
    const dvec2 dragged = inputs.mouse - last_;
    if (holds_ == Dragged::turning && strayed_) moves.turned = dragged;
    if (holds_ == Dragged::shifting) moves.shifted = dragged;
    if (holds_ == Dragged::divider) state.divider = std::clamp(inputs.mouse.x / size.x, 0., 1.);
    if (!inputs.on_controls) moves.wheel = inputs.wheel;
    moves.flown = inputs.flies * inputs.seconds;
    if (holds_ != Dragged::turning || strayed_) last_ = inputs.mouse;
    if (moves.any())
        state.camera = move_camera(scene::camera_at(state.camera, state.motion.time), moves,
                                   state.flies, size.y, reach);
    return clicked;
}

} // namespace catoptric::view
