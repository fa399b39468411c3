// Which kinds of lights a scene has, and what is known of them.
#ifndef CATOPTRIC_LIGHTS_GLSL
#define CATOPTRIC_LIGHTS_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: some light has no surface, or two sides.
layout(constant_id = LIGHT_KINDS_CONSTANT) const uint light_kinds = 0u;
// 1: there is one light, whose data are at hand: no loop (docs/performance.md).
layout(constant_id = ONE_LIGHT_CONSTANT) const uint one_light = 0u;

#ifndef CATOPTRIC_DRAWN_GLSL // of a compute shader, which reads them once for all lanes as long as none went another way
Light only_light = lights[0];
Light first_light() { return only_light; }
float ambient_of_frame = frame.value.ambient;
float ambient() { return ambient_of_frame; }
uint shadow_face_count() { return frame.value.shadow_faces; }
#endif

Light light_at(uint light) {
    if (one_light != 0u) return first_light();
    return lights[light];
}
bool is_directional(uint light) { return light_kinds != 0u && light_at(light).kind == kLightDirectional; }

#endif
