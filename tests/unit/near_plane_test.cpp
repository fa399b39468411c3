// Tests that the near planes of cameras and cube faces clip no geometry. A point at the distance of
// the nearest surface must lie beyond the near plane, even in the corners of a picture or face.
#include "core/shader_math.hpp"
#include "render/views.hpp"
#include "support/numbers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace {

using namespace catoptric;

constexpr vec3 kEyeNearSurface{.3f, -.2f, .1f};

/// Returns the view of the cube face, of six, that shows `direction`.
const shared::View& find_cube_view_of_direction(const std::vector<shared::View>& views,
                                                const vec3& direction) {
    return *std::ranges::max_element(
        views, {}, [&](const shared::View& view) { return dot(view.forward, direction); });
}

TEST(NearPlane, NearPlaneOfCubeFacesIsTheLargestPowerOfTwoOfAtMostHalfTheGap) {
    for (const auto& [gap, near] : {std::pair(1.f, .5f), {1.5f, .5f}, {2.f, 1.f}, {.3f, .125f}})
        for (const shared::View& view : render::make_cube_views(kEyeNearSurface, gap))
            EXPECT_EQ(view.near, near) << gap;
}

TEST(NearPlane, NearPlaneOfCubeFacesClipsNothingInTheCorners) {
    test::RandomNumbers numbers(1);
    for (const float gap : {.001f, .1f, 3.f})
        for (int k = 0; k < 20; ++k) {
            // The axes of the first cube are the world axes. The other cubes are turned at random.
            const vec3 forward = k == 0 ? vec3(0) : numbers.random_unit_direction();
            const auto views = render::make_turned_views(kEyeNearSurface, forward, gap);
            ASSERT_EQ(views.size(), 6u);
            const vec3 x = views[0].forward, y = views[2].forward, z = views[4].forward;
            std::vector<vec3> directions{x, -x, y, -y, z, -z};
            for (int corner = 0; corner < 8; ++corner)
                directions.push_back(normalize((corner & 1 ? x : -x) + (corner & 2 ? y : -y) +
                                               (corner & 4 ? z : -z)));
            for (int i = 0; i < 100; ++i) directions.push_back(numbers.random_unit_direction());
            for (const vec3& direction : directions) {
                const shared::View& view = find_cube_view_of_direction(views, direction);
                EXPECT_LT(view.near, dot(view.forward, gap * direction));
                EXPECT_GT(view.near, 0.f);
            }
        }
}

TEST(NearPlane, NearPlaneOfTheCameraClipsNothingInTheCorners) {
    for (const float gap : {.001f, .1f, 3.f})
        for (const double fov : {10.0, 45.0, 120.0})
            for (const uvec2 size : {uvec2(64, 64), uvec2(128, 32), uvec2(32, 128)}) {
                const scene::Camera camera{.eye = dvec3(kEyeNearSurface),
                                           .target = dvec3(kEyeNearSurface) + dvec3(.3, -.4, .8),
                                           .vertical_fov_degrees = fov};
                const shared::View view = render::make_camera_view(camera, {}, size, gap);
                EXPECT_GT(view.near, 0.f);
                for (const float x : {-1.f, 0.f, 1.f})
                    for (const float y : {-1.f, 0.f, 1.f}) {
                        const vec3 direction = normalize(
                            view.forward + x * view.right / dot(view.right, view.right) +
                            y * view.down / dot(view.down, view.down));
                        EXPECT_LT(view.near, dot(view.forward, gap * direction))
                            << "fov " << fov << ", " << size.x << "x" << size.y;
                    }
            }
}

} // namespace
