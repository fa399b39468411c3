// Pure mathematics of both worlds: no textures, no globals. Compiled as GLSL, as C++ float and as
// C++ double (engine/core/shader_math.hpp). Comparisons are written so that NaN is a miss.
#if !defined(CATOPTRIC_MATH_GLSL) || defined(__cplusplus)
#define CATOPTRIC_MATH_GLSL

#ifndef __cplusplus
#define real float
#define INLINE
#define OUT(type) out type
const real kUnitRoundoff = 5.9604644775390625e-8; // 2^-24
const real kSplitter = 4097.0;                    // 2^12 + 1: halves of a float's 24 bits

real next_up(real x) {
    if (x == 0.0) return uintBitsToFloat(1u);
    return intBitsToFloat(floatBitsToInt(x) + (x > 0.0 ? 1 : -1));
}
real next_down(real x) { return -next_up(-x); }
#endif

const real kLargest = real(3.402823466e38); // of a float: anything above stands for "infinite"
const real kPi = real(3.14159265358979323846);
const real kShadowRayEnd = real(1) - real(1) / real(8192); // shadow rays end this far to the light

// Higham's gamma: relative error bound of n roundings.
INLINE real gamma_bound(int n) {
    return real(n) * kUnitRoundoff / (real(1) - real(n) * kUnitRoundoff);
}

// isnan is asked for by name: shader compilers may turn !(a <= b) into a > b, which NaN answers otherwise.
INLINE bool is_finite(real x) { return !isnan(x) && abs(x) <= kLargest; }
INLINE bool is_finite(vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
INLINE real largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// The rest by what it is about; each may use those above it.
#include "lib/math/light.glsl"
#include "lib/math/environment.glsl"
#include "lib/math/surface.glsl"
#include "lib/math/ray.glsl"
#include "lib/math/leaving.glsl"
#include "lib/math/object_space.glsl"
#include "lib/math/capture.glsl"
#include "lib/math/bvh.glsl"

#endif
