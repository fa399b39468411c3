// Shading that the rasteriser and the ray tracer share. Before the include, a shader defines the function
//   float light_visible(uint light, vec3 position, vec3 normal, vec3 direction, float distance)
// that returns the visible share of a light. Shading calls light_visible only if the cosines at light and surface are
// both positive.
#ifndef CATOPTRIC_LIGHTING_GLSL
#define CATOPTRIC_LIGHTING_GLSL

#include "lib/bindings.glsl"
#include "lib/environment.glsl"
#include "lib/light_kinds.glsl"

// Returns the diffuse and emitted radiance of a surface point. `facet` points along the triangle's normal and has any
// length. A zero `facet` makes `normal` alone decide how much light counts (facet_normal_for_shading).
vec3 shade_surface(Surface surface, vec3 position, vec3 normal, vec3 facet) {
    vec3 direct = vec3(0);
    uint all = one_light != 0u ? 1u : frame.value.light_count;
    uint count = surface.albedo == vec3(0) ? 0u : all;
    uint light = 0u;
    if (count_work != 0u) add_work(kWorkLights, count);
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        vec3 direction;
        float distance, factor;
        bool is_lit = light < count && sample_light(light, position, normal, direction, distance, factor);
        if (details != 0u && is_lit && facet != vec3(0)) {
            factor *= facet_light_share(direction, normal, facet);
            is_lit = factor > 0.0;
        }
        if (is_lit) {
            float visible = light_visible(light, position, normal, direction, distance);
            direct += read_light(light).intensity * (factor * visible);
        }
        ++light;
    } while (one_light == 0u && light < count);
    if (environment_kind != kNoEnvironment) direct += environment_irradiance(normal);
    return lambert(surface.emission, surface.albedo, direct, ambient_light());
}

#endif
