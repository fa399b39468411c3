// Mathematics that the rasteriser and the ray tracer share, without textures and global variables. This file compiles
// as GLSL and as C++ with float and double (engine/core/shader_math.hpp). Comparisons with NaN give the answer "miss".
#if !defined(CATOPTRIC_MATH_GLSL) || defined(__cplusplus)
#define CATOPTRIC_MATH_GLSL

#ifndef __cplusplus
#define real float
#define INLINE
#define OUT(type) out type
#define INOUT(type) inout type
const real kUnitRoundoff = 5.9604644775390625e-8; // largest relative rounding error of a float, 2^-24
const real kSplitter = 4097.0;                    // 2^12 + 1: splits a float's 24 bits into two halves

real next_up(real x) {
    if (x == 0.0) return uintBitsToFloat(1u);
    return intBitsToFloat(floatBitsToInt(x) + (x > 0.0 ? 1 : -1));
}
real next_down(real x) { return -next_up(-x); }
#endif

const real kLargestFloat = real(3.402823466e38); // largest float; a larger value means infinite
const real kPi = real(3.14159265358979323846);
const real kShadowRayEnd = real(1) - real(1) / real(8192); // share of the way to the light at which a shadow ray ends

// Returns Higham's gamma_n, the bound of the relative error that n roundings cause.
INLINE real rounding_error_gamma_bound(int n) {
    return real(n) * kUnitRoundoff / (real(1) - real(n) * kUnitRoundoff);
}

// Calls isnan, because a shader compiler may turn !(a <= b) into a > b, and the two differ for NaN.
INLINE bool is_finite(real x) { return !isnan(x) && abs(x) <= kLargestFloat; }
INLINE bool is_finite(vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
INLINE real largest_vector_component(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Mathematics by topic. Each file may use the files before it.
#include "lib/math/light.glsl"
#include "lib/math/environment.glsl"
#include "lib/math/surface.glsl"
#include "lib/math/lobe.glsl"
#include "lib/math/glass.glsl"
#include "lib/math/random.glsl"
#include "lib/math/rough.glsl"
#include "lib/math/ray.glsl"
#include "lib/math/leaving.glsl"
#include "lib/math/object_space.glsl"
#include "lib/math/capture.glsl"
#include "lib/math/bvh.glsl"

#endif
