#pragma once

#include "scene/scene.hpp"

/// How mouse and keys move a camera. Plain values in, a camera out.
namespace catoptric::view {

/// What was asked for since the frame before.
struct Moves {
    dvec2 turned{0};  ///< pixels that the mouse was dragged by with its left button
    dvec2 shifted{0}; ///< with its right or middle button
    double wheel = 0; ///< notches, forwards positive
    dvec3 flown{0};   ///< seconds to the right, up and forwards
    bool any() const;
};

/// Turns around the target, shifts eye and target in the picture's plane, comes nearer or goes
/// away; where `flies`, turns around the eye instead and flies. `height`: of the picture, pixels;
/// `reach`: world units that are crossed in about three seconds. The camera stands still in the
/// scene from then on (it rides on nothing), up is +y, and it is what `--camera` says of it, to the
/// last bit. Without moves it is left as it was.
scene::Camera moved(const scene::Camera& camera, const Moves& moves, bool flies, double height,
                    double reach);

} // namespace catoptric::view
