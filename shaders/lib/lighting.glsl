// The one shading of both worlds. The including shader defines
//   float light_visible(uint light, vec3 position, vec3 normal, vec3 direction, float distance)
// before it includes this; it is asked only where both cosines are positive.
#ifndef CATOPTRIC_LIGHTING_GLSL
#define CATOPTRIC_LIGHTING_GLSL

#include "lib/bindings.glsl"

vec3 shade(Surface surface, vec3 position, vec3 normal) {
    vec3 direct = vec3(0);
    for (uint light = 0u; light < frame.value.light_count; ++light) {
        vec3 direction;
        float distance, factor;
        if (surface.albedo == vec3(0) ||
            !light_term(position, normal, lights[light].position, lights[light].normal, direction, distance, factor))
            continue;
        float visible = light_visible(light, position, normal, direction, distance);
        direct += lights[light].intensity * (factor * visible);
    }
    return lambert(surface.emission, surface.albedo, direct, frame.value.ambient);
}

#endif
