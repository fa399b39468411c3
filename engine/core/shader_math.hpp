#pragma once

#include "core/math.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

// shaders/lib/math.glsl, compiled as C++. `f32` computes as the shaders do, in float. `f64`
// computes in double, as a reference for tests. Needs -ffp-contract=off, which corresponds to
// `precise` in GLSL.

#define INLINE inline
#define OUT(type) type&
#define INOUT(type) type&
#define precise
#define CATOPTRIC_SHADER_PRELUDE(scalar, splitter)                                                 \
    using real = scalar;                                                                           \
    using vec3 = glm::vec<3, real>;                                                                \
    using uint = std::uint32_t;                                                                    \
    using glm::abs, glm::atan, glm::clamp, glm::cos, glm::exp2, glm::log2, glm::sin, glm::cross,   \
        glm::dot, glm::floor, glm::length, glm::max, glm::min, glm::mix, glm::normalize, glm::pow, \
        glm::smoothstep, glm::sqrt;                                                                \
    using std::isnan;                                                                              \
    const real kUnitRoundoff = std::numeric_limits<real>::epsilon() / 2;                           \
    const real kSplitter = splitter;                                                               \
    inline real next_up(real x) {                                                                  \
        return std::nextafter(x, std::numeric_limits<real>::infinity());                           \
    }                                                                                              \
    inline real next_down(real x) { return -next_up(-x); }

namespace catoptric::f32 {
CATOPTRIC_SHADER_PRELUDE(float, 0x1p12f + 1) // splits a float's 24 bits
#include "lib/math.glsl"
} // namespace catoptric::f32

namespace catoptric::f64 {
CATOPTRIC_SHADER_PRELUDE(double, 0x1p27 + 1) // splits a double's 53 bits
#include "lib/math.glsl"
} // namespace catoptric::f64

#undef CATOPTRIC_SHADER_PRELUDE
#undef precise
#undef OUT
#undef INOUT
#undef INLINE
#undef CATOPTRIC_MATH_GLSL
