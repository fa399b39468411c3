#include "camera.hpp"

#include "core/error.hpp"
#include "scene/camera_named.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::view {

namespace {

constexpr double kRadiansPerPixel = .005;
constexpr double kMaxCameraPitch = 1.5533; // 89 degrees, so that up stays up
constexpr double kWheelNotchFactor = .9;   // factor on the distance per wheel notch

/// Returns the unit viewing direction turned by pixels of the mouse.
dvec3 turn_by_mouse(const dvec3& direction, const dvec2& pixels) {
    const double pitch = std::clamp(std::asin(std::clamp(direction.y, -1., 1.)) +
                                        kRadiansPerPixel * pixels.y,
                                    -kMaxCameraPitch, kMaxCameraPitch);
    const double yaw = std::atan2(direction.x, direction.z) + kRadiansPerPixel * pixels.x;
    return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

/// Returns how many world units a pixel covers at the target.
double pixel_size_at(const scene::Camera& camera, double distance, double height) {
    if (camera.orthographic_height > 0) return camera.orthographic_height / height;
    const double half = camera.vertical_fov_degrees * std::numbers::pi / 360;
    return 2 * distance * std::tan(half) / height;
}

} // namespace

bool CameraMoves::any() const {
    return turned != dvec2(0) || shifted != dvec2(0) || wheel != 0 || flown != dvec3(0);
}

scene::Camera move_camera(const scene::Camera& camera, const CameraMoves& moves, bool flies,
                          double height, double reach) {
    if (!moves.any()) return camera;
    scene::Camera next = camera;
    next.follows = {};
    next.up = {0, 1, 0};
    next.name = "moved";
    double distance = glm::length(next.target - next.eye);
    dvec3 forward = (next.target - next.eye) / distance;
    if (flies) {
        forward = turn_by_mouse(forward, {-moves.turned.x, -moves.turned.y});
        next.target = next.eye + forward * distance;
    } else {
        forward = turn_by_mouse(forward, {-moves.turned.x, -moves.turned.y});
        distance *= std::pow(kWheelNotchFactor, moves.wheel);
        if (next.orthographic_height > 0)
            next.orthographic_height *= std::pow(kWheelNotchFactor, moves.wheel);
        next.eye = next.target - forward * distance;
    }
    const dvec3 right = glm::normalize(glm::cross(forward, next.up)),
                up = glm::cross(right, forward);
    const double pixel = pixel_size_at(next, distance, height);
    dvec3 shift = (-moves.shifted.x * right + moves.shifted.y * up) * pixel;
    shift += (moves.flown.x * right + moves.flown.y * up + moves.flown.z * forward) * (reach / 3);
    if (flies) shift += forward * (moves.wheel * reach / 20);
    next.eye += shift, next.target += shift;
    try {
        scene::Camera typed = scene::find_camera(scene::format_camera(next), {});
        typed.name = next.name;
        return typed;
    } catch (const Error&) { // the camera would leave its allowed range
        return camera;
    }
}

} // namespace catoptric::view
