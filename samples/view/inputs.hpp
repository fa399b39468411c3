#pragma once

#include "state.hpp"

#include <array>
#include <string>
#include <vector>

/// User input as plain data. A window or a test fills it.
namespace catoptric::view {

enum class KeyAction {
    keys,
    panels,
    pause,
    step,
    back,
    copy,
    picture,
    save_plan,
    fly,
    camera,
    cut,
    model,
    gain,
    against,
    quit,
    mode
};

/// A key and its action. `mode` is the mode's number for KeyAction::mode.
struct KeyBinding {
    int code; ///< key code of the window library
    KeyAction act;
    int mode;
    const char* name;
    const char* does;
};
const std::vector<KeyBinding>& key_bindings();

/// User input since the previous frame.
struct UserInput {
    uvec2 window{0, 0};         ///< size in pixels; 0: minimised
    dvec2 scale{1};             ///< pixels per desktop unit (pixels_per_unit)
    dvec2 mouse{0};             ///< position in pixels from the upper left corner
    std::array<bool, 3> down{}; ///< pressed buttons: left, right, middle
    double wheel = 0;
    bool on_controls = false; ///< whether the mouse is over controls
    dvec3 flies{0};           ///< flight, each from -1 to 1: right, up, forwards
    std::vector<KeyBinding> acts;
    std::vector<std::string> dropped; ///< files dropped on the window
    bool closes = false;
    double seconds = 0;
};

/// The object that a drag moves, kept from frame to frame.
class MouseDrag {
public:
    /// Moves the divider or the camera of `state`. `size` is the picture's size; `reach` is that of
    /// `move_camera`. Returns the pixel that was clicked without dragging, if any.
    std::optional<uvec2> apply_drag(const UserInput& inputs, ViewState& state, uvec2 size,
                                    double reach);

private:
    enum class Dragged { nothing, controls, divider, turning, shifting };
    Dragged begin_drag(const UserInput& inputs, const ViewState& state, uvec2 size) const;

    Dragged holds_ = Dragged::nothing;
    dvec2 last_{0}, pressed_{0};
    bool strayed_ = false;
};

/// Returns how many pixels a window has per desktop unit, in which the desktop gives window sizes
/// and mouse positions. The result is above 1 if the display is scaled, and 1 if the sizes are
/// unknown.
dvec2 pixels_per_unit(uvec2 pixels, uvec2 units);

/// Returns the size of the picture beside or under the controls, at least 16x16.
uvec2 choose_picture_size(uvec2 window, bool shows_panels);
inline constexpr std::uint32_t kPanelWidth = 360;

} // namespace catoptric::view
