#pragma once

#include "render/captured.hpp"
#include "render/passes.hpp"
#include "support/device.hpp"
#include "support/scenes.hpp"

#include <ostream>

namespace catoptric {

/// How a test's parameter is shown.
inline void PrintTo(Format format, std::ostream* out) { *out << name_of(format); }

} // namespace catoptric

/// Cube captures as numbers.
namespace test {

using render::Captured;

/// Captures every mirror once, without shadows; the other mirrors are black.
inline Captured capture(const scene::Scene& scene, std::uint32_t face, Format distance,
                        double range_world = 1, bool staged = false) {
    auto& [device, pipelines] = bench(staged);
    return render::capture(device, pipelines, scene, face, distance, range_world);
}

} // namespace test
