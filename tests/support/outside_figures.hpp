#pragma once

#include "support/rendering.hpp"

#include <iomanip>
#include <iostream>

/// Ray tracing of the built-in scene beside figures of two independent renderers: ambient 0,
/// 512x512, balls as meshes.
namespace test {

inline app::Part trace(int depth, int samples) {
    app::Request asked = request(
        scene::cornell_mirrors(),
        {"raytrace:depth=" + std::to_string(depth) + ",samples=" + std::to_string(samples)},
        {512, 512});
    asked.ambient = 0;
    return std::move(app::run(engine(), asked).parts.front());
}

/// Expects `found` within a share of `wanted`, and prints both.
inline void expect_share(const std::string& what, double found, double wanted, double share) {
    std::cout << "[ MEASURED ] " << what << ": " << std::setprecision(8) << found << ", outside "
              << wanted << ", " << std::setprecision(3) << std::showpos
              << 100 * (found / wanted - 1) << std::noshowpos << " %\n";
    EXPECT_NEAR(found, wanted, share * wanted) << what;
}

} // namespace test
