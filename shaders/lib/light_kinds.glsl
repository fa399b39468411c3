// How lights of each kind shine. engine/scene/light_kind.hpp has the same kinds for the scene and its files.
#ifndef CATOPTRIC_LIGHT_KINDS_GLSL
#define CATOPTRIC_LIGHT_KINDS_GLSL

#include "lib/lights.glsl"

// Returns the share of its intensity that a light without a surface emits at an angle with this cosine to its axis
// (LightKind::share). A kind with a fall-off of its own has a case here.
float emitted_intensity_share(uint light, float cosine) {
    return spot_attenuation(cosine, read_light(light).cos_outer, read_light(light).sharpness);
}

// Computes the direction to a light, the light's distance, and the factor by which its emission becomes irradiance.
// Handles lights of every kind, as compute_point_light_factor handles points.
bool sample_light_of_any_kind(uint light, vec3 position, vec3 normal, out vec3 direction, out float distance, out float factor) {
    if (is_directional_light(light)) return compute_directional_light_factor(normal, read_light(light).forward, direction,
        distance, factor);
    bool of_two_sides = light_kinds != 0u && read_light(light).kind == kLightKindTwoSidedLamp;
    vec3 light_normal = of_two_sides ? vec3(0) : read_light(light).normal;
    if (!compute_point_light_factor(position, normal, read_light(light).position, light_normal, direction, distance,
        factor)) return false;
    if (light_kinds == 0u) return true;
    if (of_two_sides)
        factor *= mean_lamp_facet_cosine(direction, read_light(light).right, read_light(light).down, read_light(light).forward,
                              read_light(light).normal);
    float cosine = -dot(direction, read_light(light).forward);
    factor *= range_attenuation(distance, read_light(light).reach) * emitted_intensity_share(light, cosine);
    return factor > 0.0;
}

#endif
