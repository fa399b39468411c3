// face=auto is the edge that the picture can show: less loses where mirrors look, more gains
// little.
#include "support/searches.hpp"

namespace {

using namespace catoptric;

TEST(AutoFace, IsTheEdgeItNamesAndNamesEachMirrorsNeed) {
    const scene::Scene scene = scene::cornell_mirrors();
    const app::Part chosen = test::render(scene, "secant:face=auto", test::kContractSize, 2);
    ASSERT_TRUE(chosen.auto_face.has_value());
    ASSERT_EQ(chosen.auto_face->needs.size(), 4u);
    const std::array<double, 4> wanted{
        39.71, 48.66, 57.82, 21.38}; // (pi/2) / (37.5 degrees / 512 * (1 + 2 z / r)), z to the ball
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(chosen.auto_face->needs[i], wanted[i], .05) << "ball " << i + 1;
    EXPECT_EQ(chosen.auto_face->edge, 64u);
    const app::Part named = test::render(scene, "secant:face=64", test::kContractSize, 2);
    EXPECT_FALSE(named.auto_face.has_value());
    EXPECT_TRUE(test::same_bytes(chosen.hdr, named.hdr));
}

TEST(AutoFace, NeedsNothingForWhatIsNotInThePicture) {
    scene::Scene away = test::room(2, 1);
    away.cameras = {{.name = "away", .eye = {0, 0, -2}, .target = {0, 0, -4}}};
    const app::Part part = test::render(away, "parallax:face=auto", {32, 32});
    ASSERT_TRUE(part.auto_face.has_value());
    EXPECT_EQ(part.auto_face->needs, std::vector<double>(2, 0));
    EXPECT_EQ(part.auto_face->edge, 16u);
}

TEST(AutoFace, AMeshThatStandsForASphereNeedsNoMoreThanTheSphere) {
    scene::Scene scene = scene::cornell_mirrors();
    const auto needs = [&] {
        return test::render(scene, "reuse:face=auto", {512, 512}).auto_face->needs;
    };
    const std::vector<double> spheres = needs();
    for (scene::Object& object : scene.objects) object.sphere.reset();
    const std::vector<double> meshes = needs();
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(meshes[i], spheres[i], .01 * spheres[i]);
}

TEST(AutoFace, StaysTheSameWhileTheSceneMoves) {
    app::Request asked = test::request(scene::cornell_mirrors(), {"secant:face=auto"}, {64, 64});
    asked.animate = true;
    asked.frames = 3;
    const app::Part moving = std::move(test::engine().run(asked).parts.front());
    asked.techniques = {"secant:face=" + std::to_string(moving.auto_face->edge)};
    EXPECT_TRUE(test::same_bytes(moving.hdr, test::engine().run(asked).parts.front().hdr));
}

std::uint32_t auto_edge(const test::Look& look) {
    app::Request asked = test::request(scene::cornell_mirrors(), {"secant:face=auto"},
                                       test::kContractSize);
    asked.camera = look.camera;
    asked.time = look.time;
    return test::engine().run(asked).parts.front().auto_face->edge;
}

std::vector<std::string> with_faces(const std::vector<std::uint32_t>& faces) {
    std::vector<std::string> techniques;
    for (const std::uint32_t face : faces)
        techniques.push_back("secant:lookup=bilinear,face=" + std::to_string(face));
    return techniques;
}

TEST(AutoFace, IsTheKneeOfWhereMirrorsLook) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        const std::uint32_t edge = auto_edge(look);
        const auto judged = test::judge(scene::cornell_mirrors(), look,
                                        with_faces({edge / 2, edge, 2 * edge}));
        EXPECT_GE(judged[0].lookup.mean_degrees, 1.35 * judged[1].lookup.mean_degrees);
        EXPECT_GE(judged[2].lookup.mean_degrees, .75 * judged[1].lookup.mean_degrees);
    }
}

/// Finer captures are truer to one ray through a pixel's centre and no truer to the pixel: they
/// flicker more. So does a lookup that does not mix objects, at any edge: it has no knee.
TEST(AutoFace, IsTheKneeOfThePixelsColours) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        const std::uint32_t edge = auto_edge(look);
        const auto judged = test::judge(scene::cornell_mirrors(), look,
                                        with_faces({edge / 2, edge, 4 * edge}),
                                        "raytrace:depth=16,samples=16");
        EXPECT_GE(judged[0].first_order, 1.2 * judged[1].first_order);
        EXPECT_GE(judged[2].first_order, judged[1].first_order);
    }
}

} // namespace
