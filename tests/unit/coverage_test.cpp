// Tests of find_first_objects, which finds the object that each pixel shows without a BVH.
// Rays through a BVH give the expected objects.
#include "bvh/closest_hit.hpp"
#include "import/load.hpp"
#include "render/space.hpp"
#include "session/coverage.hpp"
#include "session/rays.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace catoptric {
namespace {

std::vector<int> objects_by_pixel_from_tree(const render::FrameGeometry& geometry,
                                            const shared::View& view, uvec2 size) {
    const bvh::Bvh tree = session::build_bvh_without(geometry, geometry.ranges.size());
    std::vector<int> seen;
    for (std::size_t pixel = 0; pixel < std::size_t{size.x} * size.y; ++pixel) {
        const auto hit = bvh::find_closest_hit<float>(
            tree, session::make_camera_ray(view, size, pixel), std::numeric_limits<float>::max(),
            bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag);
        seen.push_back(hit ? static_cast<int>(hit->object) : -1);
    }
    return seen;
}

scene::Camera draw_random_camera_near(const scene::Camera& near, std::mt19937& random) {
    std::uniform_real_distribution<double> apart(-.6, .6);
    scene::Camera camera = near;
    camera.eye += dvec3(apart(random), apart(random), apart(random));
    camera.target += dvec3(apart(random), apart(random), apart(random));
    camera.vertical_fov_degrees = 45 + 50 * apart(random);
    return camera;
}

TEST(Coverage, ObjectsPerPixelEqualThoseThatRaysHit) {
    constexpr uvec2 kCoveragePictureSize{61, 47};
    std::mt19937 random(5);
    for (const char* name : {"cornell-mirrors", "room", "courtyard", "gallery"}) {
        const scene::Scene scene = scene::load(name);
        const render::SceneUnits space = render::make_scene_units(scene);
        const render::FrameGeometry geometry = render::make_geometry(scene, space);
        for (int k = 0; k < 8; ++k) {
            const scene::Camera camera = draw_random_camera_near(scene.cameras.front(), random);
            const shared::View view = render::make_camera_view(camera, space, kCoveragePictureSize,
                                                               0);
            const auto seen = session::find_first_objects(geometry, view, kCoveragePictureSize,
                                                          1U << 30);
            ASSERT_TRUE(seen.has_value());
            EXPECT_EQ(*seen, objects_by_pixel_from_tree(geometry, view, kCoveragePictureSize))
                << name << ", camera " << k;
        }
    }
}

TEST(Coverage, SearchStopsAtTheLimitOfTests) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    const render::SceneUnits space = render::make_scene_units(scene);
    const render::FrameGeometry geometry = render::make_geometry(scene, space);
    const shared::View view = render::make_camera_view(scene.cameras.front(), space, {64, 64}, 0);
    EXPECT_FALSE(session::find_first_objects(geometry, view, {64, 64}, 100));
}

} // namespace
} // namespace catoptric
