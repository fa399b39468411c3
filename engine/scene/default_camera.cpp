#include "scene/default_camera.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene {

namespace {

/// Returns the point rounded to about a millionth of `distance`.
dvec3 round_short(const dvec3& point, double distance) {
    const double digits = 6 - std::floor(std::log10(distance)),
                 unit = std::pow(10, std::abs(digits));
    return digits > 0 ? glm::round(point * unit) / unit : glm::round(point / unit) * unit;
}

} // namespace

Camera default_camera(const Scene& scene, double aspect) {
    constexpr double kSceneShareOfPicture = .9, kAzimuthDegrees = 30, kElevationDegrees = 20;
    Bounds<double> box = bounds(scene);
    if (box.empty()) box.lo = dvec3(-1), box.hi = dvec3(1);
    const double across = glm::radians(kAzimuthDegrees), above = glm::radians(kElevationDegrees);
    const dvec3 to_eye(std::sin(across) * std::cos(above), std::sin(above),
                       std::cos(across) * std::cos(above));
    Camera camera{.name = "default", .vertical_fov_degrees = 40};
    const dvec3 right = glm::normalize(glm::cross(-to_eye, camera.up));
    const dvec3 upward = glm::cross(right, -to_eye);

    const double slope = kSceneShareOfPicture *
                         std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    double distance = 0; // least distance at which all corners lie within the margin
    for (int i = 0; i < 8; ++i) {
        const dvec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        const dvec3 corner = box.extent() * .5 * sign;
        const double aside = std::max(std::abs(glm::dot(right, corner)) / aspect,
                                      std::abs(glm::dot(upward, corner)));
        distance = std::max(distance, aside / slope + glm::dot(to_eye, corner));
    }
    if (!(distance > 0)) distance = 1;
    camera.target = round_short(box.centre(), distance);
    camera.eye = round_short(box.centre() + distance * to_eye, distance);
    return camera;
}

} // namespace catoptric::scene
