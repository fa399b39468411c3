// Tests of `parallax`, part three of the seed report. The corrected direction must reduce the
// error, unless distances are stored in eight bits with a range of 200.
#include "core/mirror_id.hpp"
#include "scene/built_in.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kParallaxPictureSize{512, 512};
constexpr int kParallaxWarmupFrames =
    4; // enough frames for deeper bounces to arrive in the captures

TEST(Parallax, HalvesTheErrorOfUncorrectedDirections) {
    const scene::Scene scene = scene::make_cornell();
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace:depth=16",
                                                                  kParallaxPictureSize);
    const measure::Picture reuse =
        test::render_technique(scene, "reuse", kParallaxPictureSize, kParallaxWarmupFrames).hdr;
    const measure::Picture parallax =
        test::render_technique(scene, "parallax", kParallaxPictureSize, kParallaxWarmupFrames).hdr;
    const auto expect_share = [&](const std::string& where, const measure::Mask& mask,
                                  double most) {
        const double with = test::rmse_of_pictures(parallax, truth.hdr, mask),
                     without = test::rmse_of_pictures(reuse, truth.hdr, mask);
        std::cout << "[ MEASURED ] " << where << ": rmse " << with << " (parallax), " << without
                  << " (reuse), share " << with / without << "\n";
        EXPECT_LE(with, most * without) << where;
    };
    expect_share("all mirrors", measure::mask_mirrors(truth.hits), .50);
    for (std::uint32_t ball = 1; ball <= 4; ++ball)
        expect_share("ball " + std::to_string(ball),
                     measure::mask_one_mirror(truth.hits, MirrorId(ball)), .65);
}

// At the edge of an empty area some of the four texels of a lookup are infinite. Then the nearest
// texel decides whether the lookup misses. Otherwise the empty area would grow by a ring of texels,
// which would show in coarse captures.
TEST(Parallax, EmptyAreaIsNoLargerInCoarseCaptures) {
    scene::Scene scene{.name = "floor"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)});
    test::add_quad(scene, "floor", hot, {-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3});
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {.1, 2, .2}, 1);
    scene.cameras.push_back({.eye = {0, 3, -7}, .target = {0, 2, 0}, .vertical_fov_degrees = 30});
    const auto misses = [&](const std::string& technique) {
        session::Request request = test::make_test_request(scene, {technique}, {192, 192});
        request.with_lookup = true;
        double mirror = 0, miss = 0;
        const session::RunResult result = session::run(test::get_test_engine(), request);
        for (const vec4& pixel : result.parts.front().lookup) {
            if (!(pixel.w > 0)) continue;
            ++mirror;
            miss += (static_cast<int>(pixel.w) - 1) % 4 == 2;
        }
        return miss / mirror;
    };
    const double fine = misses("parallax:face=512"), coarse = misses("parallax:face=12");
    std::cout << "[ MEASURED ] share of misses: " << fine << " at face 512, " << coarse
              << " at face 12\n";
    EXPECT_GT(fine, .2);
    EXPECT_NEAR(coarse, fine, .02);
}

TEST(Parallax, DistancesClampedAt200AreWorseThanNoCorrection) {
    const scene::Scene scene = scene::make_cornell();
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace:depth=16",
                                                                  kParallaxPictureSize);
    const measure::Mask mask = measure::mask_mirrors(truth.hits);
    const auto error = [&](const std::string& technique) {
        const double value = test::rmse_of_pictures(
            test::render_technique(scene, technique, kParallaxPictureSize, kParallaxWarmupFrames)
                .hdr,
            truth.hdr, mask);
        std::cout << "[ MEASURED ] " << technique << ": rmse " << value << " on mirror pixels\n";
        return value;
    };
    const double reuse = error("reuse"), r32f = error("parallax"),
                 r16f = error("parallax:distance=r16f");
    const double near = error("parallax:distance=unorm8,range=200"),
                 far = error("parallax:distance=unorm8,range=1000");
    EXPECT_GT(near, reuse);
    EXPECT_LT(far, reuse);
    EXPECT_NEAR(r16f, r32f, .05 * r32f);
}

} // namespace
