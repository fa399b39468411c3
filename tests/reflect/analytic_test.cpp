// Tests the ray tracer with exact spheres against a small ray tracer in double precision.
#include "stress/double_tracer.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

struct AnalyticCase {
    const char* name;
    int mirrors, lights;
    friend void PrintTo(const AnalyticCase& test_case, std::ostream* out) {
        *out << test_case.name;
    }
};
class AnalyticPictureTest : public testing::TestWithParam<AnalyticCase> {};
INSTANTIATE_TEST_SUITE_P(Rooms, AnalyticPictureTest,
                         testing::Values(AnalyticCase{"one_ball", 1, 1},
                                         AnalyticCase{"three_balls_two_lamps", 3, 2}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(AnalyticPictureTest, PictureEqualsTheDoublePrecisionTracer) {
    constexpr uvec2 kAnalyticPictureSize{128, 128};
    constexpr int kMaxReflections = 8;
    const scene::Scene room = test::make_lit_room(GetParam().mirrors, GetParam().lights);
    const measure::Picture picture =
        test::render_technique(room, "raytrace:sphere=exact,depth=8", kAnalyticPictureSize).hdr;
    const stress::DoubleTracer tracer(room, .05);
    std::vector<double> differences;
    for (std::uint32_t y = 0; y < kAnalyticPictureSize.y; ++y)
        for (std::uint32_t x = 0; x < kAnalyticPictureSize.x; ++x) {
            const dvec3 wanted = tracer.trace_pixel(room.cameras.front(), kAnalyticPictureSize, x,
                                                    y, kMaxReflections);
            const dvec3 difference = abs(
                dvec3(picture.at(static_cast<int>(x), static_cast<int>(y))) - wanted);
            differences.push_back(std::max({difference.x, difference.y, difference.z}) /
                                  (1 + std::max({wanted.x, wanted.y, wanted.z})));
        }
    std::ranges::sort(differences);
    // A reflection at a ball magnifies the error of a ray by about 2 distance / radius, here up to
    // 10. The error starts from a rounding of 2^-23, and the light's 1/t^2 falloff magnifies it
    // again.
    constexpr double kMaxAnalyticError = 1e-4;
    const auto apart = static_cast<std::size_t>(
        differences.end() - std::ranges::upper_bound(differences, kMaxAnalyticError));
    std::cout << "[ MEASURED ] median " << differences[differences.size() / 2] << ", 99 % "
              << differences[differences.size() * 99 / 100] << ", 99.9 % "
              << differences[differences.size() * 999 / 1000] << ", above " << kMaxAnalyticError
              << ": " << apart << " pixels\n";
    EXPECT_LE(differences[differences.size() / 2], 1e-6);
    EXPECT_LE(apart, 4u); // pixels whose centre lies on an edge
}

} // namespace
