#pragma once

#include "scene/scene.hpp"

/// Moves a camera by mouse and keys. All input and output is plain data.
namespace catoptric::view {

/// Moves that the user asked for since the previous frame.
struct CameraMoves {
    dvec2 turned{0};  ///< pixels dragged with the left mouse button
    dvec2 shifted{0}; ///< pixels dragged with the right or middle button
    double wheel = 0; ///< wheel notches, forwards positive
    dvec3 flown{0};   ///< seconds of flight to the right, up and forwards
    bool any() const;
};

/// Returns the camera after the moves. It turns around the target, shifts eye and target in the
/// picture's plane, and comes nearer or goes away. If `flies`, it turns around the eye and flies
/// instead.
///
/// `height` is the picture's height in pixels. `reach` is the distance in world units that flight
/// covers in about three seconds. A moved camera is fixed in the scene (it follows no object), and
/// up is +y. It equals to the last bit the camera that `--camera` makes of its text. Without moves,
/// the camera is returned unchanged.
scene::Camera move_camera(const scene::Camera& camera, const CameraMoves& moves, bool flies,
                          double height, double reach);

} // namespace catoptric::view
