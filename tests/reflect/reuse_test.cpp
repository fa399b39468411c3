// Tests that `reuse`, part two of the seed report, equals `naive`, part one, byte for byte: `reuse`
// gains one bounce a frame.
#include "scene/built_in.hpp"
#include "session/frames.hpp"
#include "support/rendering.hpp"

#include <cmath>
#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kReusePictureSize{512, 512};

TEST(Reuse, FrameKEqualsNaiveWithKBounces) {
    const scene::Scene scene = scene::make_cornell();
    session::Request request = test::make_test_request(scene, {"reuse:face=128"}, {256, 256});
    request.frames = 8;
    std::vector<session::TechniqueResult> reused;
    session::Session session(test::get_test_engine(), scene);
    for (session::FrameLoop frames(session, request); frames.render_next();)
        reused.push_back(frames.frame().read());
    ASSERT_EQ(reused.size(), 8u);
    for (std::size_t k = 1; k <= reused.size(); ++k) {
        const session::TechniqueResult& reuse = reused[k - 1];
        const session::TechniqueResult naive = test::render_technique(
            scene, "naive:face=128,bounces=" + std::to_string(k), request.size);
        EXPECT_TRUE(test::have_equal_pixel_bytes(reuse.hdr, naive.hdr)) << "frame " << k;
        EXPECT_TRUE(test::have_equal_pixel_bytes(reuse.display, naive.display)) << "frame " << k;
        EXPECT_EQ(reuse.scene_passes, 6);
        EXPECT_EQ(naive.scene_passes, 4 * static_cast<int>(k) + 2);
        if (k > 1 && k <= 5) {
            EXPECT_FALSE(test::have_equal_pixel_bytes(reuse.hdr, reused[k - 2].hdr))
                << "bounce " << k << " must show";
        }
    }
}

/// Sum of the squared differences of two pictures, clamped to [0,1], over a mask.
struct SquaredChangeSum {
    double sum = 0, largest_pixel = 0;
    std::size_t pixels = 0;
    double root_mean_square(bool without_largest) const {
        return std::sqrt((sum - (without_largest ? largest_pixel : 0)) /
                         (3.0 * static_cast<double>(pixels)));
    }
};

SquaredChangeSum sum_squared_change(const measure::Picture& a, const measure::Picture& b,
                                    const measure::Mask& mask) {
    SquaredChangeSum result;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (!mask[i]) continue;
        const vec3 d = glm::clamp(a.pixels[i], vec3(0), vec3(1)) -
                       glm::clamp(b.pixels[i], vec3(0), vec3(1));
        const double square = dot(d, d);
        result.sum += square, ++result.pixels;
        result.largest_pixel = std::max(result.largest_pixel, square);
    }
    return result;
}

/// From the fourth bounce on, only a few pixels change. The pixel in which the lamp appears last,
/// in ball 4, changes from 0 to 1 and outweighs all others. Single steps are therefore compared
/// without the pixel that changes most. The total is compared with this pixel.
TEST(Naive, EachBounceChangesThePictureLess) {
    const scene::Scene scene = scene::make_cornell();
    const measure::Mask mirrors = measure::mask_mirrors(
        test::render_technique(scene, "raytrace", kReusePictureSize).hits);
    measure::Picture last = test::render_technique(scene, "naive:bounces=0", kReusePictureSize).hdr;
    std::vector<SquaredChangeSum> steps;
    for (int k = 0; k <= 4; ++k) {
        const measure::Picture next = test::render_technique(
                                          scene, "naive:bounces=" + std::to_string(k + 1),
                                          kReusePictureSize)
                                          .hdr;
        steps.push_back(sum_squared_change(last, next, mirrors));
        std::cout << "[ MEASURED ] naive:" << k << " to naive:" << k + 1 << ": rmse "
                  << steps.back().root_mean_square(false) << ", "
                  << steps.back().root_mean_square(true)
                  << " without the pixel that changes most\n";
        EXPECT_GT(steps.back().root_mean_square(false), 0);
        if (k > 0) {
            EXPECT_GE(steps[static_cast<std::size_t>(k) - 1].root_mean_square(true),
                      2.5 * steps.back().root_mean_square(true))
                << k;
        }
        last = next;
    }
    EXPECT_GE(steps.front().root_mean_square(false),
              std::pow(2.5, 4) * steps.back().root_mean_square(false));
}

TEST(Naive, ScenePassesEqualThoseOfTheSeedReport) {
    const int expected[] = {2, 6, 10, 14, 18};
    for (int i = 0; i <= 4; ++i)
        EXPECT_EQ(test::render_technique(scene::make_cornell(),
                                         "naive:face=16,bounces=" + std::to_string(i), {16, 16})
                      .scene_passes,
                  expected[i]);
    for (const char* technique : {"reuse:face=16", "parallax:face=16"})
        EXPECT_EQ(test::render_technique(scene::make_cornell(), technique, {16, 16}).scene_passes,
                  6);
}

} // namespace
