// Shading that the rasteriser and the ray tracer share. Before the include, a shader defines the function
//   float visible_share_of_light(uint light, vec3 position, vec3 normal, vec3 direction, float distance)
// that returns the visible share of a light, and with tints_shadows sets light_tint. Shading calls visible_share_of_light only
// if the cosines at light and surface are both positive.
// A shader that defines DRAWS_ENVIRONMENT_DIRECTIONS also defines the constant environment_shadows and the functions
//   uint environment_direction_count()
//   bool draw_environment_direction(uint i, vec3 normal, out vec3 direction, out vec3 radiance)
// for the environment's light with shadows. `radiance` is the radiance from the drawn direction over the density of the
// direction, times the cosine, over the count. The number of the light is then kEnvironmentLight.
// A shader that defines USES_AMBIENT_OCCLUSION also defines the function
//   float visible_hemisphere_share_here()
// that returns the share of the hemisphere above the surface that near surfaces leave visible, weighted by the cosine.
// Shading calls it only with has_ambient_occlusion.
#ifndef CATOPTRIC_LIGHTING_GLSL
#define CATOPTRIC_LIGHTING_GLSL

#ifdef USES_AMBIENT_OCCLUSION
#include "lib/ambient_occlusion.glsl"
#endif
#include "lib/bindings.glsl"
#include "lib/environment.glsl"
#include "lib/glass_shadow.glsl"
#include "lib/light_kinds.glsl"
#include "lib/light_probes.glsl"
#include "lib/material.glsl"

#ifndef DRAWS_ENVIRONMENT_DIRECTIONS
const uint environment_shadows = 0u;
uint environment_direction_count() { return 0u; }
bool draw_environment_direction(uint i, vec3 normal, out vec3 direction, out vec3 radiance) { return false; }
#endif

// Returns the direction from the surface to the viewer in the tangent space of `normal`. An interpolated normal that
// points away from the viewer counts as if it pointed to the viewer.
vec3 to_viewer_in_tangent_space(vec3 normal, vec3 tangent, vec3 bitangent, vec3 to_viewer) {
    // The least cosine between normal and viewer. The lobe's formula divides by this cosine. The bound is a view from
    // 0.06 degrees above the surface.
    const float kMinViewCosine = 1e-3;
    return normalize(vec3(dot(tangent, to_viewer), dot(bitangent, to_viewer), max(abs(dot(normal, to_viewer)), kMinViewCosine)));
}

// Returns the share of light that reaches a surface of which the share `visible` of the environment is visible. The
// surfaces that hide the rest reflect light as well. If they have the same albedo and receive as much light, the share is
// nearly this polynomial (Jimenez et al., "Practical Realtime Strategies for Accurate Indirect Occlusion", 2016, section 5).
vec3 share_with_light_between_surfaces(vec3 visible, vec3 albedo) {
    vec3 cubic = 2.0404 * albedo - 0.3324, square = -4.7951 * albedo + 0.6417, linear = 2.7552 * albedo + 0.6903;
    return clamp(((cubic * visible + square) * visible + linear) * visible, visible, vec3(1));
}

// Returns the irradiance of the environment and the ambient light at a surface, as far as light probes see them.
vec3 irradiance_of_seen_environment(vec3 position, vec3 normal, vec3 albedo) {
    // Smallest positive 16-bit float, 2^-24. The images of light probes hold no smaller irradiance.
    const float kSmallestHalf = 5.9604644775390625e-8;
    vec4 seen = interpolate_light_probes(position, normal);
    vec3 whole = environment_irradiance(normal), visible = clamp(seen.rgb / max(whole, vec3(kSmallestHalf)), vec3(0), vec3(1));
    return whole * share_with_light_between_surfaces(visible, albedo) +
           kPi * frame_ambient_light() * share_with_light_between_surfaces(vec3(seen.w), albedo);
}

// Returns the mean light of the environment and the ambient light that arrives in a lobe of that roughness. Objects do not
// occlude this light (split sum: Karis, "Real Shading in Unreal Engine 4", 2013).
vec3 mean_environment_light_in_lobe(float roughness, vec3 normal, vec3 to_viewer) {
    vec3 light = vec3(light_probe_content == kLightProbesOfSurfaces ? 0.0 : frame_ambient_light());
    if (environment_kind != kNoEnvironment) light += environment_lobe_radiance(reflect(-to_viewer, normal), roughness);
    return light;
}

// Returns the radiance of a surface point that lights, ambient light and the environment cause, and its emission:
// diffuse light, and highlights of lights without a surface. Rays and captures show all other reflections.
// `facet` points along the triangle's normal and has any length. A zero `facet` makes `normal` alone decide how much
// light counts (find_facet_normal_for_shading). `to_viewer` is a unit vector. `reflects` says whether rays or captures show
// what the surface reflects. If they do not, a rough lobe also reflects the environment, and the metal part is lit by
// lamps as if it were diffuse.
vec3 shade_surface(Surface surface, vec3 position, vec3 normal, vec3 facet, vec3 to_viewer, bool reflects) {
    vec3 direct = vec3(0), by_lamps = vec3(0), highlights = vec3(0), coat_highlights = vec3(0);
    uint all = one_light != 0u ? 1u : frame.value.light_count;
    bool is_rough = has_lobes != 0u && has_rough_lobe();
    bool has_rough_coat = has_clear_coats != 0u && has_lobes != 0u && clear_coat.strength > 0.0 && clear_coat.roughness > kMaxSharpRoughness;
    if (has_clear_coats != 0u && clear_coat.strength > 0.0) reflects = clear_coat.is_base_shown;
    uint count = surface.albedo == vec3(0) && !is_rough && !has_rough_coat ? 0u : all;
    float alpha = 1.0;
    vec3 tangent, bitangent, to_eye;
    if (has_lobes != 0u) {
        alpha = roughness_to_alpha(specular_lobe.roughness);
        tangent_frame(normal, tangent, bitangent);
        to_eye = to_viewer_in_tangent_space(normal, tangent, bitangent, to_viewer);
    }
    uint light = 0u, end = count;
    if (environment_shadows != 0u && surface.albedo != vec3(0)) end += environment_direction_count();
    if (count_work != 0u) add_to_work_count(kWorkLightEvaluations, end);
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        vec3 direction;
        float distance, factor;
        vec3 intensity = vec3(0);
        bool is_environment = environment_shadows != 0u && light >= count, is_lit = false;
        if (environment_shadows != 0u && is_environment) {
            is_lit = light < end && draw_environment_direction(light - count, normal, direction, intensity);
            distance = kLargestFloat, factor = 1.0;
        } else is_lit = light < count && !(traces_paths != 0u && is_light_a_lamp(light)) &&
                      sample_light_of_any_kind(light, position, normal, direction, distance, factor);
        if (details != 0u && is_lit && facet != vec3(0)) {
            factor *= facet_light_share(direction, normal, facet);
            is_lit = factor > 0.0;
        }
        if (is_lit) {
            if (tints_shadows != 0u) light_tint = vec3(1);
            float visible = visible_share_of_light(is_environment ? kEnvironmentLight : light, position, normal, direction, distance);
            if (!is_environment) intensity = read_light(light).intensity;
            vec3 irradiance = intensity * (factor * visible);
            if (tints_shadows != 0u && !is_glass(surface.detail)) irradiance *= light_tint;
            direct += irradiance;
            if (has_clear_coats != 0u && has_rough_coat && !is_environment && !is_light_a_lamp(light)) {
                vec3 to_light = vec3(dot(tangent, direction), dot(bitangent, direction), dot(normal, direction));
                coat_highlights += irradiance / to_light.z * evaluate_lobe(roughness_to_alpha(clear_coat.roughness), vec3(kClearCoatF0), vec3(1), to_eye, to_light);
            }
            if (has_lobes != 0u && is_rough && !is_environment) {
                vec3 to_light = vec3(dot(tangent, direction), dot(bitangent, direction), dot(normal, direction));
                if (is_light_a_lamp(light)) by_lamps += irradiance;
                else highlights += irradiance / to_light.z * evaluate_lobe(alpha, specular_lobe.f0, specular_lobe.f90, to_eye, to_light);
            }
        }
        ++light;
    } while ((one_light == 0u || environment_shadows != 0u) && light < end);
    bool has_ambient = traces_paths == 0u && light_probe_content == 0u;
    vec3 share = vec3(1);
    bool is_occluded = false;
#ifdef USES_AMBIENT_OCCLUSION
    if (has_ambient_occlusion != 0u) {
        is_occluded = true;
        // The surfaces behind glass are seen instead of the glass, and share its pixels.
        if (!is_glass(surface.detail)) share = share_with_light_between_surfaces(vec3(visible_hemisphere_share_here()), surface.albedo);
    }
#endif
    if (light_probe_content != 0u && traces_paths == 0u) {
        if (surface.albedo != vec3(0))
            direct += share * (light_probe_content == kLightProbesOfEnvironment ? irradiance_of_seen_environment(position, normal, surface.albedo)
                                                                               : interpolate_light_probes(position, normal).rgb);
    } else if (is_occluded) {
        has_ambient = false;
        direct += share * ((environment_shadows == 0u ? environment_irradiance(normal) : vec3(0)) + kPi * frame_ambient_light());
    } else if (environment_kind != kNoEnvironment && traces_paths == 0u && environment_shadows == 0u) {
        direct += environment_irradiance(normal);
    }
    vec3 result = lambertian_radiance(surface.emission, surface.albedo, direct, has_ambient ? frame_ambient_light() : 0.0);
    if (has_lobes != 0u && is_rough) {
        result += specular_lobe.gain * highlights;
        if (!reflects)
            result += specular_lobe.stand_in / kPi * by_lamps +
                      specular_lobe_albedo(dot(normal, to_viewer)) * mean_environment_light_in_lobe(specular_lobe.roughness, normal, to_viewer);
    }
    if (has_clear_coats != 0u && has_rough_coat) {
        result += clear_coat.strength * coat_highlights;
        if (!clear_coat.is_shown)
            result += rough_clear_coat_albedo(dot(normal, to_viewer)) * mean_environment_light_in_lobe(clear_coat.roughness, normal, to_viewer);
    }
    return result;
}

#endif
