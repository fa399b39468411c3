// Tests that `face=auto` chooses the useful resolution of captures: a smaller edge looks up clearly
// worse directions, and a larger edge improves little.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/classify.hpp"
#include "support/searches.hpp"

#include <cmath>
#include <memory>
#include <numbers>

namespace {

using namespace catoptric;

TEST(AutoFace, ChosenEdgeEqualsTheNamedEdgeAndEachNeedIsReported) {
    const scene::Scene scene = scene::make_cornell();
    const session::TechniqueResult chosen = test::render_technique(scene, "secant:face=auto",
                                                                   test::kSearchTestPictureSize, 2);
    ASSERT_TRUE(chosen.auto_face.has_value());
    ASSERT_EQ(chosen.auto_face->needs.size(), 4u);
    // Expected edge: (pi/2) / (p cos^2 (1 + 2 z / r)), for a pixel of size p at the ball's nearest
    // point. Pixels further from the axis are smaller, so they need slightly more texels.
    const scene::Camera& camera = scene.cameras.front();
    const double pixel = 2 * std::tan(glm::radians(camera.vertical_fov_degrees) / 2) / 512;
    for (std::size_t i = 0; i < 4; ++i) {
        const scene::Sphere& ball = *scene.objects[scene::mirrors(scene)[i]].sphere;
        const dvec3 seen = ball.centre - camera.eye;
        const double cosine = dot(glm::normalize(camera.target - camera.eye), glm::normalize(seen)),
                     distance = length(seen) - ball.radius;
        const double next = std::numbers::pi / 2 /
                            (pixel * cosine * cosine * (1 + 2 * distance / ball.radius));
        std::cout << "[ MEASURED ] ball " << i + 1 << ": needs " << chosen.auto_face->needs[i]
                  << ", next to the eye " << next << "\n";
        EXPECT_GE(chosen.auto_face->needs[i], next) << "ball " << i + 1;
        EXPECT_LE(chosen.auto_face->needs[i], 1.01 * next) << "ball " << i + 1;
    }
    EXPECT_EQ(chosen.auto_face->edge, 64u);
    const session::TechniqueResult named = test::render_technique(scene, "secant:face=64",
                                                                  test::kSearchTestPictureSize, 2);
    EXPECT_FALSE(named.auto_face.has_value());
    EXPECT_TRUE(test::have_equal_pixel_bytes(chosen.hdr, named.hdr));
}

TEST(AutoFace, MirrorsOutsideThePictureNeedNothing) {
    scene::Scene away = test::make_lit_room(2, 1);
    away.cameras = {{.name = "away", .eye = {0, 0, -2}, .target = {0, 0, -4}}};
    const session::TechniqueResult part = test::render_technique(away, "parallax:face=auto",
                                                                 {32, 32});
    ASSERT_TRUE(part.auto_face.has_value());
    EXPECT_EQ(part.auto_face->needs, std::vector<double>(2, 0));
    EXPECT_EQ(part.auto_face->edge, 16u);
}

/// An edit that makes a mirror, or ends one, changes the list of edges as a new session would.
TEST(AutoFace, EditsOfMirrorsAreFollowed) {
    const scene::Scene room = test::make_lit_room(2, 1);
    const session::FrameSpec spec = test::make_test_request(room, {"reuse:face=auto"}, {32, 32});
    session::Session session(test::get_test_engine(), room);
    ASSERT_EQ(session.frame(spec).read().auto_face->needs.size(), 2u);
    const std::size_t mirror = scene::mirrors(room).front();
    std::size_t diffuse = 0;
    while (room.materials[diffuse].mirror) ++diffuse;
    for (const std::size_t material : {diffuse, room.objects[mirror].material}) {
        session.change(scene::paint(mirror, material));
        const session::TechniqueResult edited = session.frame(spec).read();
        session::Session fresh(test::get_test_engine(), session.scene());
        EXPECT_EQ(edited.auto_face->needs, fresh.frame(spec).read().auto_face->needs);
    }
}

/// The lobe of a rough mirror blurs details that are smaller than the lobe, so a finer capture
/// would not improve the picture. If a texture varies the roughness, some parts of the mirror may
/// be smooth.
TEST(AutoFace, RoughFlatMirrorsNeedTheTexelsOfTheirLobe) {
    scene::Scene scene = test::make_furnace_scene(0);
    std::erase_if(scene.objects, [&](const auto& object) { return is_mirror(scene, object); });
    const std::size_t metal = test::add_material(
        scene, {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = .3f});
    test::add_quad(scene, "wall", metal, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    scene.cameras = {{.name = "front", .eye = {0, 0, 2}, .target = {0, 0, 0}}};
    scene::find_mirrors(scene);
    const auto needs = [&] {
        return test::render_technique(scene, "parallax:face=auto", {512, 512}).auto_face.value();
    };
    EXPECT_NEAR(needs().needs.at(0), 2 * std::numbers::pi / .09, 1e-3);
    EXPECT_EQ(needs().edge, 80u);
    auto image = std::make_shared<scene::Image>();
    image->size = {1, 1};
    image->texels = {0xFFFFFFFFu};
    scene.materials[metal].roughness_texture = scene::Texture{.image = image};
    EXPECT_GT(needs().edge, 500u);
    scene.materials[metal].roughness_texture.reset();
    scene.materials[metal].roughness = 0;
    EXPECT_GT(needs().edge, 500u);
}

TEST(AutoFace, SphereMeshNeedsNoMoreThanItsSphere) {
    scene::Scene scene = scene::make_cornell();
    const auto needs = [&] {
        return test::render_technique(scene, "reuse:face=auto", {512, 512}).auto_face->needs;
    };
    const std::vector<double> spheres = needs();
    for (scene::Object& object : scene.objects) object.sphere.reset();
    const std::vector<double> meshes = needs();
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(meshes[i], spheres[i], .01 * spheres[i]);
}

TEST(AutoFace, EdgeStaysTheSameWhileTheSceneMoves) {
    session::Request asked = test::make_test_request(scene::make_cornell(), {"secant:face=auto"},
                                                     {64, 64});
    asked.animate = true;
    asked.frames = 3;
    const session::TechniqueResult moving = std::move(
        session::run(test::get_test_engine(), asked).parts.front());
    asked.techniques = {"secant:face=" + std::to_string(moving.auto_face->edge)};
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        moving.hdr, session::run(test::get_test_engine(), asked).parts.front().hdr));
}

std::uint32_t find_automatic_face_edge(const test::SearchTestView& look) {
    session::Request asked = test::make_test_request(scene::make_cornell(), {"secant:face=auto"},
                                                     test::kSearchTestPictureSize);
    asked.camera = look.camera;
    asked.time = look.time;
    return session::run(test::get_test_engine(), asked).parts.front().auto_face->edge;
}

std::vector<std::string> list_rows_with_faces(const std::vector<std::uint32_t>& faces) {
    std::vector<std::string> techniques;
    for (const std::uint32_t face : faces)
        techniques.push_back("secant:lookup=bilinear,face=" + std::to_string(face));
    return techniques;
}

/// With half the edge the mean direction error grows by at least half a pixel. With twice the edge
/// it falls by less than a third of a pixel.
TEST(AutoFace, DoublingTheEdgeHardlyImprovesDirections) {
    for (const test::SearchTestView& look : test::list_search_test_views()) {
        SCOPED_TRACE(look.camera.name);
        const std::uint32_t edge = find_automatic_face_edge(look);
        const auto judged = test::measure_search_errors(
            scene::make_cornell(), look, list_rows_with_faces({edge / 2, edge, 2 * edge}));
        const double pixel = look.camera.vertical_fov_degrees / test::kSearchTestPictureSize.y;
        const double half = judged[0].lookup.mean_degrees, at = judged[1].lookup.mean_degrees,
                     twice = judged[2].lookup.mean_degrees;
        EXPECT_GE(half - at, .5 * pixel);
        EXPECT_LE(at - twice, .3 * pixel);
    }
}

/// Finer captures equal a ray through the pixel's centre better, but not the mean over the pixel,
/// because they flicker more. The test uses a bilinear lookup. A lookup that does not mix objects
/// flickers at any edge.
TEST(AutoFace, LargerEdgeDoesNotImprovePixelColours) {
    for (const test::SearchTestView& look : test::list_search_test_views()) {
        SCOPED_TRACE(look.camera.name);
        const std::uint32_t edge = find_automatic_face_edge(look);
        const auto judged = test::measure_search_errors(
            scene::make_cornell(), look, list_rows_with_faces({edge / 2, edge, 4 * edge}),
            "raytrace:depth=16,samples=16");
        EXPECT_GE(judged[0].first_order, 1.2 * judged[1].first_order);
        EXPECT_GE(judged[2].first_order, judged[1].first_order);
    }
}

} // namespace
