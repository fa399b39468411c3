// Part three of the report: the corrected direction is worth its distances, unless they are stored in
// eight bits of a range of 200.
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{512, 512};
constexpr int kFrames = 8; // deeper bounces have arrived

TEST(Parallax, HalvesTheErrorOfTheUncorrectedDirection) {
    const scene::Scene scene = scene::cornell_mirrors();
    const app::Part truth = test::render(scene, "raytrace:depth=16", kSize);
    const measure::Picture reuse = test::render(scene, "reuse", kSize, kFrames).hdr;
    const measure::Picture parallax = test::render(scene, "parallax", kSize, kFrames).hdr;
    const auto expect_share = [&](const std::string& where, const measure::Mask& mask, double most) {
        const double with = test::rmse(parallax, truth.hdr, mask), without = test::rmse(reuse, truth.hdr, mask);
        std::cout << "[ MEASURED ] " << where << ": rmse " << with << " (parallax), " << without << " (reuse), share " << with / without << "\n";
        EXPECT_LE(with, most * without) << where;
    };
    expect_share("all mirrors", measure::mirrors(truth.hits), .50);
    for (std::uint32_t ball = 1; ball <= 4; ++ball)
        expect_share("ball " + std::to_string(ball), measure::of_mirror(truth.hits, ball), .65);
}

TEST(Parallax, DistancesClampedAt200AreWorseThanNone) {
    const scene::Scene scene = scene::cornell_mirrors();
    const app::Part truth = test::render(scene, "raytrace:depth=16", kSize);
    const measure::Mask mask = measure::mirrors(truth.hits);
    const auto error = [&](const std::string& technique) {
        const double value = test::rmse(test::render(scene, technique, kSize, kFrames).hdr, truth.hdr, mask);
        std::cout << "[ MEASURED ] " << technique << ": rmse " << value << " on mirror pixels\n";
        return value;
    };
    const double reuse = error("reuse"), r32f = error("parallax"), r16f = error("parallax:distance=r16f");
    const double near = error("parallax:distance=unorm8,range=200"), far = error("parallax:distance=unorm8,range=1000");
    EXPECT_GT(near, reuse);
    EXPECT_LT(far, reuse);
    EXPECT_NEAR(r16f, r32f, .05 * r32f);
}

} // namespace
