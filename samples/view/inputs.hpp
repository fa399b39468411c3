#pragma once

#include "state.hpp"

#include <array>
#include <string>
#include <vector>

/// What the user does, as plain data: a window fills it, or a test.
namespace catoptric::view {

enum class Act {
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

/// A key and what it does; `mode`: of Act::mode, its number.
struct Key {
    int code; ///< as the window library numbers it
    Act act;
    int mode;
    const char* name;
    const char* does;
};
const std::vector<Key>& keys();

/// Since the frame before.
struct Inputs {
    uvec2 window{0, 0};         ///< pixels; 0: minimised
    dvec2 scale{1};             ///< pixels per unit of the desktop, as pixels_per_unit has them
    dvec2 mouse{0};             ///< pixels from the upper left corner
    std::array<bool, 3> down{}; ///< buttons: left, right, middle
    double wheel = 0;
    bool on_controls = false; ///< the mouse is theirs
    dvec3 flies{0};           ///< -1 to 1: right, up, forwards
    std::vector<Key> acts;
    std::vector<std::string> dropped; ///< files
    bool closes = false;
    double seconds = 0;
};

/// What a drag has got hold of, from frame to frame.
class Hand {
public:
    /// Moves the divider or the camera of `state`. `size`: of the picture; `reach`: as `moved` has
    /// it. Returns the pixel that was clicked, without dragging, if one was.
    std::optional<uvec2> apply(const Inputs& inputs, State& state, uvec2 size, double reach);

private:
    enum class Holds { nothing, controls, divider, turning, shifting };
    Holds grasp(const Inputs& inputs, const State& state, uvec2 size) const;

    Holds holds_ = Holds::nothing;
    dvec2 last_{0}, pressed_{0};
    bool strayed_ = false;
};

/// How many pixels a window has along one unit in which the desktop says its size and where the
/// mouse is: more than 1 where the display is scaled, 1 where there is nothing to tell it by.
dvec2 pixels_per_unit(uvec2 pixels, uvec2 units);

/// Of the picture beside or under the controls; at least 16x16.
uvec2 picture_size(uvec2 window, bool shows_panels);
inline constexpr std::uint32_t kPanelWidth = 360;

} // namespace catoptric::view
