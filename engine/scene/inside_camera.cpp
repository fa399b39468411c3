#include "scene/inside_camera.hpp"

#include "scene/material_facts.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace catoptric::scene {

namespace {

struct SurfaceHit {
    double distance = 0;   ///< in lengths of the ray's direction
    bool is_front = false; ///< the surface's normal points towards the ray's origin
    bool is_glass = false;
};

/// Ray casts through a scene at rest. Each ray is tested against every triangle.
class RayCaster {
public:
    explicit RayCaster(const Scene& scene) : scene_(scene) {
        for (const Object& object : scene.objects)
            object_from_world_.push_back(glm::inverse(object.world_from_object));
    }

    /// Returns the first surface that a ray from a camera meets.
    std::optional<SurfaceHit> first_hit(const dvec3& origin, const dvec3& direction) const;
    bool is_blocked(const dvec3& from, const dvec3& to) const {
        constexpr double kShortenedRayFactor = 1 - 1e-6; // excludes the surface at `to`
        const auto met = first_hit(from, to - from);
        return met && met->distance < kShortenedRayFactor;
    }

private:
    const Scene& scene_;
    std::vector<dmat4> object_from_world_;
};

/// Returns the distance along the ray to a triangle, met from either side (Moeller and Trumbore
/// 1997). Returns nothing for a triangle behind the origin.
std::optional<double> triangle_distance(const dvec3& a, const dvec3& b, const dvec3& c,
                                        const dvec3& origin, const dvec3& direction) {
    const dvec3 ab = b - a, ac = c - a, p = cross(direction, ac);
    const double volume = dot(ab, p);
    if (volume == 0) return std::nullopt;
    const dvec3 from_a = origin - a, q = cross(from_a, ab);
    const double u = dot(from_a, p) / volume, v = dot(direction, q) / volume;
    const double distance = dot(ac, q) / volume;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && distance > 0)) return std::nullopt;
    return distance;
}

std::optional<SurfaceHit> RayCaster::first_hit(const dvec3& origin, const dvec3& direction) const {
    std::optional<SurfaceHit> nearest;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
        const Object& object = scene_.objects[i];
        if (!object.seen_by_camera) continue;
        const Mesh& mesh = scene_.meshes[object.mesh];
        const bool has_back = is_mirror(scene_, object) ||
                              !is_one_sided(scene_.materials[object.material]);
        const bool shows_behind = is_glass(scene_.materials[object.material]);
        const dvec3 from = transform_point(object_from_world_[i], origin);
        const dvec3 along = dmat3(object_from_world_[i]) * direction;
        for (const uvec3& t : mesh.triangles) {
            const auto distance = triangle_distance(mesh.positions[t.x], mesh.positions[t.y],
                                                    mesh.positions[t.z], from, along);
            if (!distance || (nearest && *distance >= nearest->distance)) continue;
            const dvec3 normal = dvec3(mesh.normals[t.x]) + dvec3(mesh.normals[t.y]) +
                                 dvec3(mesh.normals[t.z]);
            const bool is_front = dot(normal, along) < 0;
            if (is_front || has_back) nearest = SurfaceHit{*distance, is_front, shows_behind};
        }
    }
    return nearest;
}

/// Returns directions spread evenly over the sphere, on a spiral with golden angles.
std::vector<dvec3> spread_directions(int count) {
    std::vector<dvec3> all;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2 * i + 1) / static_cast<double>(count),
                     across = std::sqrt(1 - y * y),
                     turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        all.emplace_back(across * std::cos(turn), y, across * std::sin(turn));
    }
    return all;
}

/// Returns whether nearly every ray from the place meets a surface that `counts`.
template <typename Counts>
bool is_enclosed(const RayCaster& rays, const dvec3& place, Counts&& counts) {
    constexpr int kEnclosureTestRays = 64, kMaxMissedRays = 3;
    int misses = 0;
    for (const dvec3& direction : spread_directions(kEnclosureTestRays)) {
        const auto met = rays.first_hit(place, direction);
        if (!(met && counts(*met)) && ++misses > kMaxMissedRays) return false;
    }
    return true;
}
bool is_closed_around(const RayCaster& rays, const dvec3& centre) {
    return is_enclosed(rays, centre, [](const SurfaceHit&) { return true; });
}
/// Returns whether the place is inside a room: its walls are no glass and face the place. The
/// inside of a can shows the backs of surfaces.
bool is_in_room(const RayCaster& rays, const dvec3& place) {
    return is_enclosed(rays, place,
                       [](const SurfaceHit& met) { return met.is_front && !met.is_glass; });
}

/// Returns whether nearly all surfaces that the camera sees turn their backs, over a grid of its
/// picture.
bool sees_mostly_backs(const RayCaster& rays, const Camera& camera) {
    constexpr int kCameraRaysPerSide = 12;
    constexpr double kMaxBackFaceShare = .9;
    const dvec3 forward = normalize(camera.target - camera.eye),
                right = normalize(cross(forward, camera.up)), upward = cross(right, forward);
    const double slope = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    int all = 0, backs = 0;
    for (int i = 0; i < kCameraRaysPerSide * kCameraRaysPerSide; ++i) {
        const double x = 2 * (i % kCameraRaysPerSide + .5) / kCameraRaysPerSide - 1,
                     y = 2 * (i / kCameraRaysPerSide + .5) / kCameraRaysPerSide - 1;
        const auto met = rays.first_hit(camera.eye, forward + slope * (x * right + y * upward));
        all += met.has_value();
        backs += met && !met->is_front;
    }
    return all > 0 && backs >= kMaxBackFaceShare * all;
}

/// Returns some places on the objects that matter most in a picture: mirrors and lamps.
std::vector<dvec3> places_of_interest(const Scene& scene) {
    constexpr std::size_t kMaxInterestObjects = 16, kMaxInterestPlaces = 8;
    std::vector<dvec3> places;
    std::size_t objects = 0;
    for (const Object& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        const bool counts = is_mirror(scene, object) ||
                            is_visibly_emissive(scene.materials[object.material]);
        if (!counts || mesh.triangles.empty() || objects++ >= kMaxInterestObjects) continue;
        const std::size_t step = (mesh.triangles.size() + kMaxInterestPlaces - 1) /
                                 kMaxInterestPlaces;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
            const uvec3& t = mesh.triangles[i];
            places.push_back(transform_point(
                object.world_from_object,
                (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0));
        }
    }
    return places;
}

bool hides_places(const RayCaster& rays, const std::vector<dvec3>& places, const dvec3& eye,
                  const dvec3& centre) {
    const auto seen_from = [&](const dvec3& from) {
        return std::ranges::any_of(places,
                                   [&](const dvec3& to) { return !rays.is_blocked(from, to); });
    };
    return seen_from(centre) && !seen_from(eye);
}

/// Returns the share of the places that the camera sees unhidden, within a cone as wide as its
/// vertical field of view.
double visible_share(const RayCaster& rays, const std::vector<dvec3>& places,
                     const Camera& camera) {
    const dvec3 forward = normalize(camera.target - camera.eye);
    const double least = std::cos(glm::radians(camera.vertical_fov_degrees) / 2);
    const auto seen = std::ranges::count_if(places, [&](const dvec3& place) {
        return dot(normalized_or_zero(place - camera.eye), forward) >= least &&
               !rays.is_blocked(camera.eye, place);
    });
    return places.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(places.size());
}

/// Returns the summed distance from a place to the surfaces that rays from it meet. A ray that
/// meets nothing counts as 0.
double sum_distances(const RayCaster& rays, const dvec3& place) {
    double sum = 0;
    for (const dvec3& direction : spread_directions(24)) {
        const auto met = rays.first_hit(place, direction);
        sum += met ? met->distance : 0;
    }
    return sum;
}

/// Returns the point rounded to about a thousandth of the extent. This is exact enough for an eye's
/// position and short to type.
dvec3 round_to_thousandth(const dvec3& point, double extent) {
    const double unit = std::pow(10, 3 - std::floor(std::log10(extent)));
    return glm::round(point * unit) / unit;
}

} // namespace

std::optional<InsideCamera> find_inside_camera(const Scene& scene, const Camera& outside) {
    const Bounds<double> box = bounds(scene);
    if (box.empty() || triangle_count(scene) > kMaxTestedTriangles) return std::nullopt;
    const RayCaster rays(scene);
    const double extent = length(box.extent());
    const dvec3 centre = round_to_thousandth(box.centre(), extent);
    if (!is_closed_around(rays, centre)) return std::nullopt;
    const std::vector<dvec3> places = places_of_interest(scene);
    if (!sees_mostly_backs(rays, outside) && !hides_places(rays, places, outside.eye, centre))
        return std::nullopt;
    Camera tried{.name = "default", .target = centre, .vertical_fov_degrees = 60};
    InsideCamera found;
    double best = -1;
    constexpr double kEyeSidewaysOffset = .35,
                     kUpwardOffset = .15; // offset from the centre, in extents of the bounds
    // A round room does not reach into the corners of its bounds.
    for (const double share : {1., .65, .3}) {
        for (int i = 0; i < 8; ++i) {
            const dvec3 side(i & 1 ? -kEyeSidewaysOffset : kEyeSidewaysOffset,
                             i & 4 ? 0 : kUpwardOffset,
                             i & 2 ? -kEyeSidewaysOffset : kEyeSidewaysOffset);
            tried.eye = round_to_thousandth(centre + share * side * box.extent(), extent);
            const bool is_room = is_in_room(rays, tried.eye);
            const double worth = sum_distances(rays, tried.eye) *
                                 (1 + visible_share(rays, places, tried));
            if (is_room < found.is_in_room || (is_room == found.is_in_room && worth <= best))
                continue;
            best = worth, found = {tried, is_room};
        }
        if (found.is_in_room) break;
    }
    return found;
}

} // namespace catoptric::scene
