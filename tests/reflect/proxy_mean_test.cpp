// Tests of the sphere by which `proxy` approximates a mirror's surroundings. Its radius must be the
// mean distance over all directions that show something. The tests compute the radius from the
// directions in which the mirror's pixels look.
#include "render/views.hpp"
#include "scene/shapes.hpp"
#include "session/rays.hpp"
#include "stress/texels.hpp"
#include "support/rendering.hpp"

#include <algorithm>

namespace {

using namespace catoptric;

constexpr uvec2 kProxyMeanPictureSize{48, 48};
// The room is long, so that other kinds of mean differ clearly.
constexpr dvec3 kProxyRoomLowCorner{-7, -1, -1.5}, kProxyRoomHighCorner{5, 2, 2.5};
constexpr double kHalfMirrorWidth =
    .4; // half width and height of the flat mirrors, which face along z

struct TwoMirrorRoom {
    std::array<dvec3, 2> centres{{{.6, .3, .4}, {-2.5, .8, .9}}}; // centres of the two mirrors
    bool open = false; // whether the room lacks its wall at +x

    scene::Scene make_room_scene(std::size_t looked_at) const {
        scene::Scene scene{.name = "long room"};
        const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)});
        for (int face = open ? 1 : 0; face < 6; ++face)
            test::add_mesh(
                scene, test::make_box_wall(face, kProxyRoomLowCorner, kProxyRoomHighCorner), hot);
        const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
        for (const dvec3& c : centres)
            test::add_quad(scene, "mirror", mirror,
                           c + dvec3(-kHalfMirrorWidth, -kHalfMirrorWidth, 0),
                           c + dvec3(-kHalfMirrorWidth, kHalfMirrorWidth, 0),
                           c + dvec3(kHalfMirrorWidth, kHalfMirrorWidth, 0),
                           c + dvec3(kHalfMirrorWidth, -kHalfMirrorWidth, 0));
        scene.cameras.push_back({.eye = centres[looked_at] + dvec3(.3, .2, -1.2),
                                 .target = centres[looked_at],
                                 .vertical_fov_degrees = 30});
        return scene;
    }

    /// Returns the distance from a mirror's centre to the walls or the other mirror. Infinite if
    /// the direction shows nothing.
    double distance_from_mirror_centre(std::size_t mirror, const dvec3& direction) const {
        const dvec3 from = centres[mirror];
        double nearest = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0) continue;
            const bool low = direction[axis] < 0;
            if (open && axis == 0 && !low) continue;
            const double t = ((low ? kProxyRoomLowCorner : kProxyRoomHighCorner)[axis] -
                              from[axis]) /
                             direction[axis];
            // A ray that passes the open end leaves the room, and meets no wall beyond the opening.
            if (axis != 0 && open && from.x + t * direction.x > kProxyRoomHighCorner.x) continue;
            nearest = std::min(nearest, t);
        }
        const dvec3 other = centres[1 - mirror] - from;
        const double t = other.z / direction.z;
        const dvec3 met = t * direction - other;
        if (t > 0 && std::abs(met.x) <= kHalfMirrorWidth && std::abs(met.y) <= kHalfMirrorWidth)
            nearest = std::min(nearest, t);
        return nearest;
    }

    /// Returns the mean distance over the solid angle of the directions whose distance is below
    /// `range`.
    double mean_distance_of_mirror(std::size_t mirror,
                                   double range = std::numeric_limits<double>::infinity()) const {
        double sum = 0, all = 0;
        stress::for_each_texel(256, [&](const dvec3& direction, int, std::uint32_t, std::uint32_t) {
            const double size = glm::length(direction), angle = 1 / (size * size * size),
                         d = distance_from_mirror_centre(mirror, direction / size);
            if (!(d < range)) return;
            sum += angle * d, all += angle;
        });
        return sum / all;
    }
};

/// Returns the sphere's radius in world units, as the median over the mirror's pixels.
double proxy_sphere_radius(const TwoMirrorRoom& room, std::size_t mirror,
                           const std::string& settings) {
    const scene::Scene scene = room.make_room_scene(mirror);
    session::Request request = test::make_test_request(
        scene, {"proxy:shape=sphere,shadow=none," + settings}, kProxyMeanPictureSize);
    request.with_lookup = true;
    const session::TechniqueResult part = std::move(
        session::run(test::get_test_engine(), request).parts.front());
    const shared::View view = render::make_camera_view(request.camera, {}, kProxyMeanPictureSize,
                                                       0);
    std::vector<double> radii;
    for (std::size_t i = 0; i < part.lookup.size(); ++i) {
        if (!(part.lookup[i].w > 0)) continue;
        const dvec3 eye = request.camera.eye, centre = room.centres[mirror],
                    ray(session::make_camera_ray(view, kProxyMeanPictureSize, i).direction),
                    offset = eye + ray * ((centre.z - eye.z) / ray.z) - centre,
                    onward(ray.x, ray.y, -ray.z), looked(vec3(part.lookup[i]));
        // The point in which the reflected ray meets the looked-up line lies on the sphere.
        const dvec3 across = glm::cross(onward, looked);
        if (glm::length(across) < .05) continue;
        const double t = -dot(glm::cross(offset, looked), across) / dot(across, across);
        radii.push_back(glm::length(offset + t * onward));
    }
    EXPECT_GT(radii.size(), 50u);
    std::ranges::nth_element(radii, radii.begin() + std::ssize(radii) / 2);
    return radii[radii.size() / 2];
}

TEST(ProxyMean, RadiusIsTheMeanDistanceOverAllDirections) {
    for (const std::string face : {"16", "37", "64", "200"})
        for (const std::size_t mirror : {0u, 1u}) {
            const double wanted = TwoMirrorRoom{}.mean_distance_of_mirror(mirror),
                         found = proxy_sphere_radius(TwoMirrorRoom{}, mirror, "face=" + face);
            std::cout << "[ MEASURED ] face " << face << ", mirror " << mirror + 1 << ": radius "
                      << found << ", mean distance " << wanted << "\n";
            EXPECT_NEAR(found, wanted, .004 * wanted) << "face " << face << ", mirror " << mirror;
        }
}

TEST(ProxyMean, EmptyDirectionsDoNotCount) {
    const TwoMirrorRoom open{.open = true};
    const double wanted = open.mean_distance_of_mirror(0),
                 found = proxy_sphere_radius(open, 0, "face=64");
    EXPECT_NEAR(found, wanted, .004 * wanted);
    const double in_range = TwoMirrorRoom{}.mean_distance_of_mirror(0, 3),
                 eight_bits = proxy_sphere_radius(TwoMirrorRoom{}, 0,
                                                  "face=64,distance=unorm8,range=3");
    std::cout << "[ MEASURED ] open: " << found << " for " << wanted << "; in range: " << eight_bits
              << " for " << in_range << "\n";
    EXPECT_NEAR(eight_bits, in_range, .008 * in_range);
}

} // namespace
