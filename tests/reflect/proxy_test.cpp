// Tests of `proxy`, which fits a box or a sphere to the captured distances. The result must be
// exact if the surroundings have that shape, and must do no harm if there are none.
#include "measure/lookup.hpp"
#include "scene/built_in.hpp"
#include "stress/glyph_room.hpp"
#include "support/searches.hpp"

namespace {

using namespace catoptric;

constexpr uvec2 kProxyPictureSize{128, 128};
constexpr int kSearchHitState = 0,
              kMiss = 2; // states of a search, as in shaders/lib/probe.glsl

// The rasteriser snaps vertices to 1/256 of a pixel, so rays are reflected at slightly different
// points than in the reference. This shows only at the outline of the ball, where normals change
// fast.
// Largest errors allowed, in degrees: for the worst pixel, and for 99 % of the pixels. A graphics
// card also interpolates between the snapped vertices.
double largest_snapped_ray_difference() { return test::computes_like_cpp() ? .1 : .4; }
double largest_common_ray_difference() { return test::computes_like_cpp() ? .01 : .06; }

measure::LookupSummary summarise_proxy_errors(const std::string& what,
                                              const std::vector<measure::LookupError>& pixels,
                                              double& worst) {
    worst = 0;
    for (const measure::LookupError& pixel : pixels) worst = std::max(worst, pixel.angle_degrees);
    const measure::LookupSummary error = measure::summarise_lookups(pixels);
    std::cout << "[ MEASURED ] " << what << ": mean angle " << error.mean_degrees << ", p99 "
              << error.p99_degrees << ", worst " << worst << " degrees\n";
    return error;
}

TEST(Proxy, BoxOfAnEmptyRoomIsExact) {
    for (const std::string face : {"16", "37", "64", "256"}) {
        const auto pixels = test::measure_lookup_directions(
            stress::LetterRoom().make_scene(), "proxy:face=" + face, kProxyPictureSize);
        ASSERT_GT(pixels.size(), 1000u);
        double worst;
        EXPECT_LT(summarise_proxy_errors("box, face " + face, pixels, worst).p99_degrees,
                  largest_common_ray_difference());
        EXPECT_LT(worst, largest_snapped_ray_difference());
        EXPECT_EQ(std::ranges::count(pixels, kSearchHitState, &measure::LookupError::state),
                  std::ssize(pixels));
    }
}

TEST(Proxy, SphereOfARoundRoomIsExact) {
    scene::Scene scene{.name = "round room"};
    const std::size_t hot = test::add_material(
        // The room is a ball that is seen from inside.
        scene, {.name = "hot", .emission = vec3(1), .two_sided = true});
    test::add_ball(scene, "room", hot, {.5, .5, .5}, 8, 6);
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {.5, .5, .5}, 2, 5);
    scene.cameras.push_back({.eye = {.5, .5, -6}, .target = {.5, .5, .5}});
    const auto pixels = test::measure_lookup_directions(scene, "proxy:shape=sphere,face=64",
                                                        kProxyPictureSize);
    ASSERT_GT(pixels.size(), 1000u);
    double worst;
    EXPECT_LT(summarise_proxy_errors("sphere", pixels, worst).p99_degrees,
              largest_snapped_ray_difference()); // the round room consists of 4^7 flat triangles
    EXPECT_EQ(std::ranges::count(pixels, kSearchHitState, &measure::LookupError::state),
              std::ssize(pixels));
}

TEST(Proxy, RaysBesideAFloorHitTheFloorOrMiss) {
    scene::Scene scene{.name = "floor"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)});
    test::add_quad(scene, "floor", hot, {-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9});
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {0, 2, 0}, 1);
    scene.cameras.push_back({.eye = {0, 2.5, -5}, .target = {0, 2, 0}});
    const auto pixels = test::measure_lookup_directions(scene, "proxy:face=64", kProxyPictureSize);
    double worst;
    const measure::LookupSummary error = summarise_proxy_errors("floor", pixels, worst);
    EXPECT_LT(error.mean_degrees, .1);
    EXPECT_LT(error.wrong_object, .02);
    const double hits = static_cast<double>(std::ranges::count(pixels, kSearchHitState,
                                                               &measure::LookupError::state)) /
                        static_cast<double>(pixels.size());
    EXPECT_GT(hits, .25);
    EXPECT_LT(hits, .75);
}

TEST(Proxy, AllRaysMissWithoutSurroundings) {
    scene::Scene scene{.name = "void"};
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {0, 0, 0}, 1);
    scene.cameras.push_back({.eye = {0, 0, -5}, .target = {0, 0, 0}});
    for (const std::string shape : {"box", "sphere"})
        for (const std::string distance : {"r32f", "unorm8"}) {
            const auto pixels = test::measure_lookup_directions(
                scene, "proxy:face=16,shape=" + shape + ",distance=" + distance, kProxyPictureSize);
            EXPECT_EQ(
                test::count_nonfinite(
                    test::render_technique(scene, "proxy:face=16,shape=" + shape, kProxyPictureSize)
                        .hdr),
                0u);
            ASSERT_GT(pixels.size(), 1000u);
            // unorm8 cannot store infinity, so the number of misses is not checked for that format.
            const auto misses = std::ranges::count(pixels, kMiss, &measure::LookupError::state);
            EXPECT_EQ(misses, distance == "r32f" ? std::ssize(pixels) : misses) << shape;
            double worst;
            EXPECT_LT(summarise_proxy_errors("nothing, " + shape + ", " + distance, pixels, worst)
                          .p99_degrees,
                      largest_common_ray_difference());
            EXPECT_LT(worst, largest_snapped_ray_difference());
        }
}

/// If rays are followed through the other balls, the box of `proxy` is wrong only for objects
/// inside the room.
TEST(Proxy, BoxReducesTheErrorInTheBuiltInScene) {
    const auto judged = test::measure_search_errors(scene::make_cornell(),
                                                    test::list_search_test_views().front(),
                                                    {"parallax", "proxy", "proxy:continue=4"});
    EXPECT_LE(judged[2].all, .80 * judged[0].all);
    EXPECT_LE(judged[1].lookup.mean_degrees, .05 * judged[0].lookup.mean_degrees);
}

} // namespace
