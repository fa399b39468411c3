// Tests of ablations: rows drawn with some causes of error removed, alone and in combination. In
// these scenes the causes are known, so with all of them removed no error may be left.
#include "shared.h"
#include "study/causes.hpp"
#include "support/boxes.hpp"

#include <iostream>

namespace {

using namespace catoptric;
using namespace catoptric::shared;

constexpr uvec2 kAblationPictureSize{48, 48};

std::vector<measure::Picture> render_with_ablation_masks(const session::Request& request,
                                                         const std::vector<std::uint32_t>& masks) {
    std::vector<measure::Picture> pictures;
    session::Session session(test::get_test_engine(), request.scene);
    study::render_ablated(
        session, request, masks,
        [&](std::size_t, const measure::Picture& picture) { pictures.push_back(picture); });
    return pictures;
}

/// Renders a row with each mask of removed causes and compares the pictures with ray tracing. The
/// first entry of the result has no cause removed.
std::vector<test::PixelComparison> compare_with_causes_removed(const scene::Scene& scene,
                                                               const std::string& technique,
                                                               std::vector<std::uint32_t> masks,
                                                               const std::string& shadow = "none",
                                                               int frames = 1) {
    const session::TechniqueResult truth = test::render_technique(
        scene, "raytrace:depth=16,shadow=" + shadow, kAblationPictureSize);
    session::Request request = test::make_test_request(scene, {technique}, kAblationPictureSize);
    request.warmup = frames - 1;
    masks.insert(masks.begin(), 0);
    std::vector<test::PixelComparison> result;
    for (const measure::Picture& picture : render_with_ablation_masks(request, masks))
        result.push_back(test::compare_pixels_of_mirrors(picture, truth));
    std::cout << "[ MEASURED ] " << scene.name << ", " << technique << ": of " << result[0].pixels
              << " off, by mask";
    for (std::size_t i = 0; i < masks.size(); ++i)
        std::cout << (i > 0 ? ", " : " ") << masks[i] << ": " << result[i].off;
    std::cout << "\n";
    return result;
}

constexpr std::uint32_t kFirstOrderCauseMask = kAblateDirection | kAblateHiddenPoints |
                                               kAblateTexelColour;
// Number of wrong pixels to allow, whose centre lies next to an outline or an edge.
constexpr std::size_t kAllowedOutlinePixels = 3;

// In an empty box each reflected ray meets one wall. With exact distances the search must find that
// point.
TEST(Mended, ExactDistancesMakeASearchExactInAnEmptyBox) {
    const auto found = compare_with_causes_removed(
        test::make_coloured_box({}), "secant:steps=8,face=2,distance=unorm8,range=60,shadow=none",
        {kAblateTexelColour, kAblateDistance, kAblateDistance | kAblateTexelColour});
    EXPECT_GT(found[1].off, 8u) << "distances are wrong";
    EXPECT_GT(found[2].off, 100u) << "texels are coarse";
    EXPECT_LE(found[3].off, kAllowedOutlinePixels);
}

// With these causes removed, neither distances nor colours come from the captures.
TEST(Mended, PicturesDoNotDependOnTheCaptureEdge) {
    const session::TechniqueResult truth = test::render_technique(
        test::make_coloured_box({}), "raytrace:shadow=none", kAblationPictureSize);
    std::vector<measure::Picture> pictures;
    for (const std::string face : {"2", "64"}) {
        session::Request request = test::make_test_request(test::make_coloured_box({}),
                                                           {"parallax:shadow=none,face=" + face},
                                                           kAblationPictureSize);
        pictures.push_back(
            render_with_ablation_masks(request, {kAblateDistance | kAblateTexelColour}).front());
        // Parallax takes one step to the surface, which is not exact.
        EXPECT_LE(
            test::compare_pixels_of_mirrors(pictures.back(), truth).share_of_off_mirror_pixels(),
            .02);
    }
    EXPECT_TRUE(test::have_equal_pixel_bytes(pictures[0], pictures[1]));
}

TEST(Mended, DirectionAndTexelsAreTheOnlyCausesInAnEmptyBox) {
    const auto found = compare_with_causes_removed(
        test::make_coloured_box({}), "reuse:face=8,shadow=none",
        {kAblateDirection, kAblateTexelColour, kAblateDirection | kAblateTexelColour,
         kAblateHiddenPoints, kAblateMirrorReflections | kAblateSelfReflection});
    EXPECT_GT(found[1].off, 100u);
    EXPECT_GT(found[2].off, 60u);
    EXPECT_LE(found[3].off, kAllowedOutlinePixels);
    EXPECT_EQ(found[4].off, found[0].off) << "nothing is hidden";
    EXPECT_EQ(found[5].off, found[0].off) << "and there is no second mirror";
    const auto open = compare_with_causes_removed(
        test::make_coloured_box({}, true), "reuse:face=8,shadow=none", {kFirstOrderCauseMask});
    EXPECT_LE(open[1].off, kAllowedOutlinePixels) << "nothing is seen where it is open";
}

// Three boards stand in front of the walls. No direction from the ball's centre shows the points
// that the boards hide.
TEST(Mended, ExactDirectionDoesNotShowHiddenPoints) {
    for (const std::string technique : {"reuse:", "secant:steps=8,"}) {
        const auto found = compare_with_causes_removed(
            test::make_coloured_box({{-1.2, .2, -.6}, {1.9, .6, -.3}, {.2, -1.6, -.4}}),
            technique + "face=32,shadow=none",
            {kAblateDirection | kAblateTexelColour, kAblateHiddenPoints, kFirstOrderCauseMask});
        EXPECT_GT(found[1].off, 20u);
        EXPECT_LE(found[2].off + 10, found[0].off);
        EXPECT_LE(found[3].off, kAllowedOutlinePixels);
    }
    // These boards lie in front of the floor and the ceiling, a fifth of the way to the middle of
    // the box.
    scene::Scene scene = test::make_coloured_box({});
    for (const double y : {-2.4, 2.4})
        for (const double x : {-1.1, .7, 2.5})
            test::add_glowing_board(scene, {0, .1f, 0}, {x, y, -.6}, {.5, 0, 0}, {0, 0, 1.2});
    const auto close = compare_with_causes_removed(
        scene, "reuse:face=32,shadow=none",
        {kAblateDirection | kAblateTexelColour, kFirstOrderCauseMask});
    EXPECT_GT(close[1].off, 8u);
    EXPECT_LE(close[2].off, kAllowedOutlinePixels);
    // Exact texels replace those of the layer that was looked up, which may be the second layer.
    const auto layered = compare_with_causes_removed(
        test::make_coloured_box({{-1.2, .2, -.6}, {1.9, .6, -.3}, {.2, -1.6, -.4}}),
        "layered:face=128,shadow=none", {kAblateTexelColour});
    EXPECT_LE(layered[1].off, layered[0].off);
}

TEST(Mended, MirrorsInMirrorsShowWhatTheEyeSees) {
    const auto once = compare_with_causes_removed(
        test::make_three_ball_scene(), "secant:steps=8,continue=0,face=32,shadow=none",
        {kFirstOrderCauseMask, kFirstOrderCauseMask | kAblateMirrorReflections,
         kAblateMirrorReflections});
    EXPECT_GT(once[1].off, 100u) << "without history mirrors are black in captures";
    EXPECT_LE(once[2].off, kAllowedOutlinePixels);
    EXPECT_LT(5 * once[3].off, once[0].off);
    // Points that the second mirror's centre does not see must still be darkened by both mirrors'
    // reflectances.
    scene::Scene scene = test::make_three_ball_scene();
    scene.name = "three balls and boards";
    for (const dvec3& centre : {dvec3(1.2, -1.5, .3), dvec3(1.2, .1, 1.9), dvec3(-1.25, -1.9, .6),
                                dvec3(-1.25, 1.2, .3), dvec3(1.3, 1.5, .2), dvec3(-1.2, -.3, 2.3)})
        test::add_glowing_board(scene, {.1f, 0, 0}, centre, {.35, 0, 0},
                                {0, centre.z > 1 ? .35 : 0, centre.z > 1 ? 0 : .35});
    const auto followed = compare_with_causes_removed(
        scene, "secant:steps=8,continue=8,face=32,shadow=none",
        {kAblateDirection | kAblateTexelColour, kFirstOrderCauseMask,
         kFirstOrderCauseMask | kAblateMirrorReflections});
    EXPECT_LE(followed[2].off, 2 * kAllowedOutlinePixels);
    EXPECT_GT(followed[1].off, 20u);
    EXPECT_LE(followed[3].off, kAllowedOutlinePixels);
}

scene::Scene make_mirror_corner_scene() {
    scene::Scene scene{.name = "corner"};
    test::add_bright_box(scene, {-4, -3, -5}, {4, 3, 5});
    test::add_mesh(scene, test::make_hollow_corner(), test::add_halving_mirror(scene, 0));
    scene.cameras.push_back(
        {.eye = {.1, .2, -2.9}, .target = {-.4, 0, 1.5}, .vertical_fov_degrees = 45});
    return scene;
}

TEST(Mended, OwnReflectionOfAMirrorIsRestored) {
    const auto found = compare_with_causes_removed(
        make_mirror_corner_scene(), "secant:steps=8,continue=0,face=32,shadow=none",
        {kFirstOrderCauseMask | kAblateMirrorReflections, kAblateSelfReflection});
    EXPECT_GT(found[1].off, 200u);
    EXPECT_LE(found[2].off, kAllowedOutlinePixels);
}

TEST(Mended, ShadowRaysReplaceTheShadowMap) {
    scene::Scene scene = test::make_lit_room(1, 1);
    scene.cameras.front() = {
        .eye = {-.3, -.7, -1.8}, .target = {-.9, -1.2, .3}, .vertical_fov_degrees = 42};
    for (const std::string map : {"shadow_map=8", "shadow=none"}) {
        const auto found = compare_with_causes_removed(
            scene, "secant:steps=8,face=64," + map,
            {kFirstOrderCauseMask, kFirstOrderCauseMask | kAblateShadows, kAblateShadows}, "ray");
        EXPECT_GT(found[1].off, 30u);
        EXPECT_LE(found[2].off, kAllowedOutlinePixels);
        EXPECT_LT(5 * found[3].off, found[0].off);
    }
}

} // namespace
