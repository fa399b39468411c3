// The ray tracer with exact spheres against a page of double precision.
#include "stress/double_tracer.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

struct Case {
    const char* name;
    int mirrors, lights;
    friend void PrintTo(const Case& test_case, std::ostream* out) { *out << test_case.name; }
};
class Analytic : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Rooms, Analytic,
                         testing::Values(Case{"one_ball", 1, 1},
                                         Case{"three_balls_two_lamps", 3, 2}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(Analytic, EqualsTheDoublePrecisionTracer) {
    constexpr uvec2 kSize{128, 128};
    constexpr int kDepth = 8;
    const scene::Scene room = test::room(GetParam().mirrors, GetParam().lights);
    const measure::Picture picture = test::render(room, "raytrace:sphere=exact,depth=8", kSize).hdr;
    const stress::DoubleTracer tracer(room, .05);
    std::vector<double> differences;
    for (std::uint32_t y = 0; y < kSize.y; ++y)
        for (std::uint32_t x = 0; x < kSize.x; ++x) {
            const dvec3 wanted = tracer.pixel(room.cameras.front(), kSize, x, y, kDepth);
            const dvec3 difference = abs(
                dvec3(picture.at(static_cast<int>(x), static_cast<int>(y))) - wanted);
            differences.push_back(std::max({difference.x, difference.y, difference.z}) /
                                  (1 + std::max({wanted.x, wanted.y, wanted.z})));
        }
    std::ranges::sort(differences);
    // Each reflection of a ray at a ball spreads its error by about 2 distances / radius, here up
    // to 10, from 2^-23; what is behind, the light's 1/t^2 stretches again.
    constexpr double kBound = 1e-4;
    const auto apart = static_cast<std::size_t>(differences.end() -
                                                std::ranges::upper_bound(differences, kBound));
    std::cout << "[ MEASURED ] median " << differences[differences.size() / 2] << ", 99 % "
              << differences[differences.size() * 99 / 100] << ", 99.9 % "
              << differences[differences.size() * 999 / 1000] << ", above " << kBound << ": "
              << apart << " pixels\n";
    EXPECT_LE(differences[differences.size() / 2], 1e-6);
    EXPECT_LE(apart, 4u); // a pixel whose middle lies on an edge
}

} // namespace
