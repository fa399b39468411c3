// Which kinds of lights a scene has.
#ifndef CATOPTRIC_LIGHTS_GLSL
#define CATOPTRIC_LIGHTS_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: some light has no surface.
layout(constant_id = LIGHT_KINDS_CONSTANT) const uint light_kinds = 0u;
// 1: there is one light. Its data are then at places that the compiler knows, which a software driver loads once for all
// lanes; by a loop's counter it loads each number of each lane.
layout(constant_id = ONE_LIGHT_CONSTANT) const uint one_light = 0u;

bool is_directional(uint light) { return light_kinds != 0u && lights[light].directional != 0u; }

#endif
