// Draws all objects that are not mirrors, in captures and in the camera's view.
// #first leaves pixels to the ray tracer where the surface reflects, or a shadow map cannot tell whether a light reaches
// the surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#include "lib/first_hit.glsl"
#include "lib/lit.glsl"

#ifdef FIRST_HIT
layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;
layout(constant_id = TRACES_LOBES_CONSTANT) const uint traces_lobes = 0u; // 1: the tracer traces lobes
#endif

void main() {
    vec3 facet = details != 0u ? cross(dFdx(from_eye), dFdy(from_eye)) : vec3(0);
    if (peels != 0u && is_peeled_from_second_layer()) discard;
    discard_cut_out_fragments();
    vec3 n = normalize(normal);
    Surface surface = find_surface_at_fragment(n, facet);
    vec3 shown = shade_drawn_fragment(surface, n, facet);
    // A smooth surface that is no mirror reflects the environment only, no objects of the scene.
    if (details != 0u && surface.reflectance != vec3(0))
        shown += surface.reflectance * environment_radiance(reflect_above_facet(normalize(direction_from_viewer()), n,
            normalize(facet)));
    write_fragment_outputs(shown);
    if (has_blending != 0u && drawn_parts == kDrawBlendedParts) out_colour.a = fragment_alpha();
#ifdef FIRST_HIT
    bool reflects = details != 0u && surface.reflectance != vec3(0);
    if (traces_lobes != 0u) reflects = reflects || has_rough_lobe() || (has_clear_coats != 0u && clear_coat.strength > 0.0);
    if (has_glass != 0u && is_glass(surface.detail)) reflects = true; // rays pass through a surface of glass
    if (masks != 0u && has_blending != 0u && is_blended(drawn_material_parameters())) reflects = true; // rays go on behind it
    if (reflects || shadow_is_open) {
        out_colour = make_first_hit_words(uint(gl_PrimitiveID), drawn_object_index(), 0u, tracer);
        out_distance = float(tracer);
    }
#endif
}
