#pragma once

#include "scene/built_in.hpp"
#include "support/rendering.hpp"

#include <iomanip>
#include <iostream>

/// Compares ray tracing of the built-in scene with figures of two independent renderers. Ambient
/// light is 0, the size is 512x512, and balls are meshes.
namespace test {

inline session::TechniqueResult trace_cornell_mirrors(int depth, int samples) {
    session::Request asked = make_test_request(
        scene::make_cornell(),
        {"raytrace:depth=" + std::to_string(depth) + ",samples=" + std::to_string(samples)},
        {512, 512});
    asked.ambient = 0;
    return std::move(session::run(get_test_engine(), asked).parts.front());
}

/// Expects that `found` differs from `wanted` by at most `share` times `wanted`, and prints both
/// numbers.
inline void expect_share_of_pixels_within(const std::string& what, double found, double wanted,
                                          double share) {
    std::cout << "[ MEASURED ] " << what << ": " << std::setprecision(8) << found << ", outside "
              << wanted << ", " << std::setprecision(3) << std::showpos
              << 100 * (found / wanted - 1) << std::noshowpos << " %\n";
    EXPECT_NEAR(found, wanted, share * wanted) << what;
}

} // namespace test
