// How lights of each kind shine. engine/scene/light_kind.hpp has the same kinds for the scene and its files.
#ifndef CATOPTRIC_LIGHT_KINDS_GLSL
#define CATOPTRIC_LIGHT_KINDS_GLSL

#include "lib/lights.glsl"

// Returns the share of its intensity that a light without a surface emits at an angle with this cosine to its axis
// (LightKind::share). A kind with a fall-off of its own has a case here.
float emitted_share(uint light, float cosine) {
    return cone_share(cosine, light_at(light).cos_outer, light_at(light).sharpness);
}

// Computes direction, distance and factor of a light as light_term does, for lights of every kind.
bool sample_light(uint light, vec3 position, vec3 normal, out vec3 direction, out float distance, out float factor) {
    if (is_directional(light)) return parallel_term(normal, light_at(light).forward, direction, distance, factor);
    bool of_two_sides = light_kinds != 0u && light_at(light).kind == kLightOfTwoSides;
    vec3 light_normal = of_two_sides ? vec3(0) : light_at(light).normal;
    if (!light_term(position, normal, light_at(light).position, light_normal, direction, distance, factor)) return false;
    if (light_kinds == 0u) return true;
    if (of_two_sides)
        factor *= mean_cosine(direction, light_at(light).right, light_at(light).down, light_at(light).forward,
                              light_at(light).normal);
    float cosine = -dot(direction, light_at(light).forward);
    factor *= range_share(distance, light_at(light).reach) * emitted_share(light, cosine);
    return factor > 0.0;
}

#endif
