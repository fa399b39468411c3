// Tests of captures with two layers. The second layer must hold the surfaces that a small ball
// hides from the capture's centre, and the search must find them there.
#include "core/shader_math.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"
#include "support/captures.hpp"
#include "support/searches.hpp"

#include <cmath>
#include <iostream>

namespace {

using namespace catoptric;

constexpr dvec3 kLayeredBoxLowCorner{-4, -3, -5}, kLayeredBoxHighCorner{4, 3, 5};
constexpr dvec3 kCaptureCentre{.5, -.25, 1}, kOccludingBallCentre{1.7, -.25, .1};
constexpr double kOccludingBallRadius = .5; // radius of the occluding ball
constexpr vec3 kWallColours[6]{{.5f, 0, 0},   {0, .5f, 0},   {0, 0, .5f},
                               {.5f, .5f, 0}, {0, .5f, .5f}, {.25f, 0, .5f}};
constexpr vec3 kBallColour{1, .5f, .25f}; // exact in binary16, as are the wall colours

/// Returns a box whose walls each emit a different colour, with a mirror ball and a glowing ball
/// beside it.
scene::Scene make_hidden_wall_scene() {
    scene::Scene scene{.name = "hidden wall"};
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene,
                       test::make_box_wall(face, kLayeredBoxLowCorner, kLayeredBoxHighCorner),
                       test::add_material(scene, {.name = "wall", .emission = kWallColours[face]}));
    test::add_ball(scene, "mirror", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   kCaptureCentre, .75, 4);
    test::add_ball(scene, "occluder",
                   test::add_material(scene, {.name = "ball", .emission = kBallColour}),
                   kOccludingBallCentre, kOccludingBallRadius, 4);
    scene.cameras.push_back({.name = "inside",
                             .eye = {-2.5, 1, -3},
                             .target = kCaptureCentre,
                             .vertical_fov_degrees = 20});
    return scene;
}

/// Returns the distance from `centre` to the box along a unit direction. `wall` receives the number
/// of the wall.
double distance_to_box_wall(const dvec3& centre, const dvec3& direction, int& wall) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const bool low = direction[axis] < 0;
        const double t = ((low ? kLayeredBoxLowCorner : kLayeredBoxHighCorner)[axis] -
                          centre[axis]) /
                         direction[axis];
        if (t < nearest) nearest = t, wall = 2 * axis + low;
    }
    return nearest;
}

TEST(Layered, SecondLayerShowsTheWallBehindTheBall) {
    constexpr std::uint32_t kCaptureFaceTexels = 128;
    const scene::Scene scene = make_hidden_wall_scene();
    const auto [first, second] = test::capture_both_depth_layers(scene, kCaptureFaceTexels,
                                                                 TexelFormat::r32f);
    const dvec3 centre =
        scene::bounds(scene, scene.objects[scene::mirrors(scene).front()]).centre();
    std::size_t hidden = 0, wrong = 0;
    double solid_angle = 0;
    float worst = 0;
    for (int face = 0; face < 6; ++face)
        for (std::uint32_t y = 0; y < kCaptureFaceTexels; ++y)
            for (std::uint32_t x = 0; x < kCaptureFaceTexels; ++x) {
                const dvec3 at = f64::cube_direction(
                    face, dvec3((2 * x + 1.0) / kCaptureFaceTexels - 1,
                                (2 * y + 1.0) / kCaptureFaceTexels - 1, 1));
                const float one = first.distance(0, face, x, y, TexelFormat::r32f),
                            two = second.distance(0, face, x, y, TexelFormat::r32f);
                if (first.colour(0, face, x, y) != kBallColour) {
                    // Nothing lies behind a wall. The far side of the ball faces away from the
                    // centre, so no layer holds it.
                    EXPECT_TRUE(std::isinf(two));
                    EXPECT_EQ(second.colour(0, face, x, y), vec3(0));
                    continue;
                }
                ++hidden;
                solid_angle += 4 /
                               (kCaptureFaceTexels * kCaptureFaceTexels * std::pow(length(at), 3));
                int wall = 0;
                const float expected = first.space.to_scene_length(
                    distance_to_box_wall(centre, normalize(at), wall));
                EXPECT_GT(two, one * (1 + 0x1p-10f));
                // Interpolated positions are exact to a few roundings of the scene's size, which is
                // about 1; on a device that snaps vertices, to 1/512 of a texel on a slanted wall.
                const float apart = std::abs(two - expected);
                worst = std::max(worst, apart);
                wrong += !(apart <= (test::computes_like_cpp() ? 0x1p-18f : 0x1p-12f)) ||
                         second.colour(0, face, x, y) != kWallColours[wall];
            }
    // At the outline of the ball some facets already face away while their smooth normals do not.
    EXPECT_LE(wrong, hidden / 100) << "worst distance " << worst;
    const double sine = kOccludingBallRadius / length(kOccludingBallCentre - centre),
                 expected = 2 * f64::kPi * (1 - std::sqrt(1 - sine * sine));
    EXPECT_NEAR(solid_angle, expected, .02 * expected) << hidden << " texels of ball";
}

/// Two mirrors face each other in a box that emits radiance 1. No reflection between the mirrors
/// may be brighter than the box, even where the second layer of a capture is empty.
TEST(Layered, ParallelMirrorsAreAsBrightAsInRayTracing) {
    scene::Scene scene{.name = "corridor"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)}),
                      mirror = test::add_material(
                          scene, {.name = "mirror", .mirror = true, .reflectance = vec3(.8f)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), hot);
    test::add_quad(scene, "left", mirror, {-2, -2, -2}, {-2, -2, 4}, {-2, 2, 4}, {-2, 2, -2});
    test::add_quad(scene, "right", mirror, {2, -2, -2}, {2, 2, -2}, {2, 2, 4}, {2, -2, 4});
    scene.cameras.push_back(
        {.eye = {0, 0, -1.9}, .target = {1.9, .1, -1.2}, .vertical_fov_degrees = 60});
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace:depth=16",
                                                                  {96, 96});
    const measure::Mask seen = measure::mask_mirror_in_mirror(truth.hits);
    const double wanted = measure::mean_of(truth.hdr, measure::ValueRange::unclamped, seen).all;
    const auto judged = [&](const std::string& technique) {
        const session::TechniqueResult part = test::render_technique(
            scene, technique + ":continue=8,face=128", {96, 96}, 4);
        const double found = measure::mean_of(part.hdr, measure::ValueRange::unclamped, seen).all;
        std::cout << "[ MEASURED ] " << technique << ": " << found << " where rays say " << wanted
                  << "\n";
        EXPECT_LE(found, (technique == "layered" ? 1.01 : 1.03) * wanted);
        EXPECT_GE(found, wanted);
        for (const vec3& pixel : part.hdr.pixels) EXPECT_LE(pixel.x, 1.001f);
        return test::rmse_of_pictures(part.hdr, truth.hdr, seen);
    };
    EXPECT_LE(judged("layered"), judged("pyramid"));
}

TEST(Layered, SecondLayerLiesBehindTheFirstInEveryFormat) {
    constexpr std::uint32_t kCaptureFaceTexels = 32;
    for (const TexelFormat format : {TexelFormat::r32f, TexelFormat::r16f, TexelFormat::r8_unorm}) {
        const auto [first, second] = test::capture_both_depth_layers(test::make_lit_room(3, 1),
                                                                     kCaptureFaceTexels, format);
        std::size_t behind = 0;
        for (std::uint32_t mirror = 0; mirror < 3; ++mirror)
            for (int face = 0; face < 6; ++face)
                for (std::uint32_t y = 0; y < kCaptureFaceTexels; ++y)
                    for (std::uint32_t x = 0; x < kCaptureFaceTexels; ++x) {
                        const float one = first.distance(mirror, face, x, y, format),
                                    two = second.distance(mirror, face, x, y, format);
                        EXPECT_GE(two, one);
                        behind += format == TexelFormat::r8_unorm ? two < 1 : std::isfinite(two);
                    }
        EXPECT_GT(behind, 100u);
    }
}

TEST(Layered, LayeredSearchFindsTheWallWhereOneLayerShowsTheBall) {
    constexpr uvec2 kLayeredPictureSize{256, 256};
    const scene::Scene scene = make_hidden_wall_scene();
    const auto render = [&](const std::string& technique) {
        session::Request request = test::make_test_request(scene, {technique}, kLayeredPictureSize);
        request.warmup = 1;
        request.ambient = 0;
        return std::move(session::run(test::get_test_engine(), request).parts.front());
    };
    const session::TechniqueResult truth = render("raytrace:depth=4");
    const measure::Picture parallax = render("parallax").hdr, secant = render("secant").hdr,
                           layered = render("layered").hdr;
    // Classify each pixel as a wall, 0 to 5, or the ball, 6, by the nearest colour, because lookups
    // mix colours at edges.
    const auto seen = [](const vec3& colour) {
        std::size_t nearest = 6;
        for (std::size_t i = 0; i < 6; ++i)
            if (distance(colour, kWallColours[i]) <
                distance(colour, nearest == 6 ? kBallColour : kWallColours[nearest]))
                nearest = i;
        return nearest;
    };
    std::size_t mirror = 0, hidden = 0, found = 0, wrong_secant = 0, wrong_layered = 0;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (!measure::first_mirror(truth.hits[i])) continue;
        const std::size_t wanted = seen(truth.hdr.pixels[i]);
        ++mirror;
        wrong_secant += seen(secant.pixels[i]) != wanted;
        wrong_layered += seen(layered.pixels[i]) != wanted;
        if (wanted == 6 || (seen(parallax.pixels[i]) != 6 && seen(secant.pixels[i]) != 6)) continue;
        ++hidden;
        found += seen(layered.pixels[i]) == wanted;
    }
    std::cout << "[ MEASURED ] parallax or secant show the ball at " << hidden
              << " pixels of wall, of which layered finds " << found << "; wrong of " << mirror
              << ": secant " << wrong_secant << ", layered " << wrong_layered << "\n";
    EXPECT_GT(hidden, 50u);
    EXPECT_GE(found, hidden * 98 / 100);
    EXPECT_LE(wrong_layered, wrong_secant / 4);
}

// The distance by which the second layer must lie behind the first covers the rounding of eight
// bits. It must not depend on the number that is given as range.
TEST(Layered, RangeOfEightBitDistancesDoesNotChangeThePeel) {
    const session::TechniqueResult truth = test::render_technique(scene::make_cornell(),
                                                                  "raytrace:depth=16", {256, 256});
    const auto error = [&](const std::string& range) {
        return test::rmse_of_pictures(
            test::render_technique(scene::make_cornell(),
                                   "layered:face=128,distance=unorm8,range=" + range, {256, 256}, 4)
                .hdr,
            truth.hdr, measure::mask_mirrors(truth.hits));
    };
    // On the device the built-in scene is divided by 1024. With a range of 1024 world units, stored
    // distances therefore equal distances in scene units. A range of 1023 avoids this special case.
    const double beside = error("1023"), at = error("1024");
    std::cout << "[ MEASURED ] rmse at a range of 1023: " << beside << ", 1024: " << at << "\n";
    // Ignoring the rounding of eight bits changes the error by 1 %.
    EXPECT_NEAR(at, beside, .005 * beside);
}

TEST(Layered, SceneIsRenderedTwicePerMirror) {
    const session::TechniqueResult part = test::render_technique(
        scene::make_cornell(), "layered:face=16,shadow_map=16", {16, 16});
    EXPECT_EQ(part.scene_passes, 2 * 4 + 2);
}

} // namespace
