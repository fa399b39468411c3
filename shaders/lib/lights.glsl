// Which kinds of lights a scene has.
#ifndef CATOPTRIC_LIGHTS_GLSL
#define CATOPTRIC_LIGHTS_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: some light has no surface.
layout(constant_id = LIGHT_KINDS_CONSTANT) const uint light_kinds = 0u;
// 1: there is one light: no loop, and its data at places that the compiler knows, which saves a software driver about a
// twentieth of a frame with large captures (docs/performance.md).
layout(constant_id = ONE_LIGHT_CONSTANT) const uint one_light = 0u;

bool is_directional(uint light) { return light_kinds != 0u && lights[light].directional != 0u; }

#endif
