// Exact spheres in rays' world: balls in a hierarchy of their own, which follows what moves.
#include "measure/causes.hpp"
#include "scene/load.hpp"
#include "support/lit.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{64, 48};
const std::string kExact = "raytrace:sphere=exact,depth=3", kMesh = "raytrace:depth=3";

measure::Picture picture(const scene::Scene& scene, const std::string& technique) {
    return test::render(scene, technique, kSize).hdr;
}

/// A session that shows meshes and spheres by turns; what moves in it stands where it does in a
/// session that has never seen anything else.
TEST(ExactSpheres, StandWhereTheyWereMoved) {
    scene::Scene scene = test::room(3, 1);
    app::Session session(test::engine(), scene);
    const auto ball = [&](int number) { return scene.objects.size() - std::size_t(number); };
    for (int step = 0; step < 4; ++step) {
        if (step > 0) { // a ball, then a wall, then both
            const std::size_t object = step == 2 ? 0 : ball(1);
            dmat4 place = scene.objects[object].world_from_object;
            place[3] += dvec4(.1, .15 * step, -.2, 0);
            session.change(scene::move(object, place));
            if (step == 3) session.change(scene::move(ball(2), place));
            scene = session.scene();
        }
        const std::string first = step % 2 ? kExact : kMesh, second = step % 2 ? kMesh : kExact;
        for (const std::string& technique : {first, second, kExact})
            EXPECT_TRUE(
                test::same_bytes(session.frame(test::request(scene, {technique}, kSize)).hdr(0),
                                 picture(scene, technique)))
                << technique << ", step " << step;
    }
}

/// As their meshes do.
TEST(ExactSpheres, AreHiddenFromTheCameraAndStillCastShadows) {
    scene::Scene scene = test::room(2, 1), without = scene;
    without.objects.erase(without.objects.end() - 1);
    scene.objects.back().seen_by_camera = false;
    const measure::Picture hidden = picture(scene, "raytrace:sphere=exact,depth=0"),
                           gone = picture(without, "raytrace:sphere=exact,depth=0");
    const auto hits = test::render(scene, "raytrace:sphere=exact,depth=0", kSize).hits;
    EXPECT_THAT(hits, testing::Each(testing::Ne(2u)));
    int darker = 0, brighter = 0;
    for (std::size_t i = 0; i < hidden.pixels.size(); ++i) {
        darker += hidden.pixels[i].y < gone.pixels[i].y;
        brighter += hidden.pixels[i].y > gone.pixels[i].y;
    }
    EXPECT_GT(darker, 20) << "its shadow";
    EXPECT_EQ(brighter, 0);
}

/// Of a ball of that many triangles the two pictures are apart at its outline alone.
TEST(ExactSpheres, AreWhereTheirMeshesAre) {
    const scene::Scene scene = test::room(3, 2);
    const measure::Picture exact = picture(scene, "raytrace:sphere=exact,depth=1"),
                           mesh = picture(scene, "raytrace:depth=1");
    int off = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i)
        off += !(test::apart(exact.pixels[i], mesh.pixels[i]) <= float(measure::kOff));
    EXPECT_LE(off, 120);
}

} // namespace
