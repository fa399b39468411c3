// Access to the lights of a scene.
#ifndef CATOPTRIC_LIGHTS_GLSL
#define CATOPTRIC_LIGHTS_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: some light has no surface, or is a lamp that emits on both sides.
layout(constant_id = LIGHT_KINDS_CONSTANT) const uint light_kinds = 0u;
// 1: the scene has exactly one light, whose data are in variables, so that shading needs no loop (docs/performance.md).
layout(constant_id = ONE_LIGHT_CONSTANT) const uint one_light = 0u;
// 1: paths (lib/paths.glsl) find the light of lamps, of the environment and of other surfaces, so shading adds none of it.
layout(constant_id = TRACES_PATHS_CONSTANT) const uint traces_paths = 0u;

// Number by which shading asks for the visible share of the environment in one direction.
const uint kEnvironmentLight = 0xffffffffu;

#ifndef CATOPTRIC_DRAWN_GLSL // a compute shader reads light data once for all lanes, as long as no lanes have diverged
Light only_light = lights[0];
Light read_first_light() { return only_light; }
float ambient_of_frame = frame.value.ambient;
float frame_ambient_light() { return ambient_of_frame; }
uint shadow_face_count() { return frame.value.shadow_faces; }
#endif

Light read_light(uint light) {
    if (one_light != 0u) return read_first_light();
    return lights[light];
}
// Returns whether the light has a surface, which rays and captures show.
bool is_light_a_lamp(uint light) {
    return read_light(light).kind == kLightKindTwoSidedLamp || read_light(light).kind == kLightKindLamp;
}
bool is_directional_light(uint light) { return light_kinds != 0u && read_light(light).kind == kLightKindDirectional; }

#endif
