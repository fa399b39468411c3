// Tests of exact spheres in ray tracing. They have a BVH of their own, which must follow moved
// objects.
#include "import/load.hpp"
#include "measure/causes.hpp"
#include "support/lit.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;

constexpr uvec2 kExactSpheresPictureSize{64, 48};
const std::string kExactSphereTechnique = "raytrace:sphere=exact,depth=3",
                  kMesh = "raytrace:depth=3";

measure::Picture render_exact_sphere_picture(const scene::Scene& scene,
                                             const std::string& technique) {
    return test::render_technique(scene, technique, kExactSpheresPictureSize).hdr;
}

/// A session that shows meshes and spheres in turns must show moved objects at the same places as a
/// new session.
TEST(ExactSpheres, MovedSpheresAreSeenAtTheirNewPlaces) {
    scene::Scene scene = test::make_lit_room(3, 1);
    session::Session session(test::get_test_engine(), scene);
    const auto ball = [&](int number) { return scene.objects.size() - std::size_t(number); };
    for (int step = 0; step < 4; ++step) {
        if (step > 0) { // move a ball, then a wall, then two balls
            const std::size_t object = step == 2 ? 0 : ball(1);
            dmat4 place = scene.objects[object].world_from_object;
            place[3] += dvec4(.1, .15 * step, -.2, 0);
            session.change(scene::move(object, place));
            if (step == 3) session.change(scene::move(ball(2), place));
            scene = session.scene();
        }
        const std::string first = step % 2 ? kExactSphereTechnique : kMesh,
                          second = step % 2 ? kMesh : kExactSphereTechnique;
        for (const std::string& technique : {first, second, kExactSphereTechnique})
            EXPECT_TRUE(test::have_equal_pixel_bytes(
                session.frame(test::make_test_request(scene, {technique}, kExactSpheresPictureSize))
                    .hdr(0),
                render_exact_sphere_picture(scene, technique)))
                << technique << ", step " << step;
    }
}

/// An exact sphere that the camera does not see must cast a shadow, as the mesh of such a sphere
/// does.
TEST(ExactSpheres, SpheresHiddenFromTheCameraStillCastShadows) {
    scene::Scene scene = test::make_lit_room(2, 1), without = scene;
    without.objects.erase(without.objects.end() - 1);
    scene.objects.back().seen_by_camera = false;
    const measure::Picture hidden = render_exact_sphere_picture(scene,
                                                                "raytrace:sphere=exact,depth=0"),
                           gone = render_exact_sphere_picture(without,
                                                              "raytrace:sphere=exact,depth=0");
    const auto hits = test::render_technique(scene, "raytrace:sphere=exact,depth=0",
                                             kExactSpheresPictureSize)
                          .hits;
    EXPECT_THAT(hits, testing::Each(testing::Ne(2u)));
    int darker = 0, brighter = 0;
    for (std::size_t i = 0; i < hidden.pixels.size(); ++i) {
        darker += hidden.pixels[i].y < gone.pixels[i].y;
        brighter += hidden.pixels[i].y > gone.pixels[i].y;
    }
    EXPECT_GT(darker, 20) << "its shadow";
    EXPECT_EQ(brighter, 0);
}

/// The meshes have many triangles, so the pictures of sphere and mesh may differ only at the
/// outlines.
TEST(ExactSpheres, SpheresEqualTheirMeshesExceptAtOutlines) {
    const scene::Scene scene = test::make_lit_room(3, 2);
    const measure::Picture exact = render_exact_sphere_picture(scene,
                                                               "raytrace:sphere=exact,depth=1"),
                           mesh = render_exact_sphere_picture(scene, "raytrace:depth=1");
    int off = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i)
        off += !(test::max_channel_difference(exact.pixels[i], mesh.pixels[i]) <=
                 float(measure::kMaxInvisibleDifference));
    EXPECT_LE(off, 120);
}

} // namespace
