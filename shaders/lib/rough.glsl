// Reflections of rough surfaces that are looked up in captures. Either one look-up in a level of the capture that is as
// blurred as the surface's lobe (engine/reflect/rough.cpp), or several searches in directions drawn from the lobe.
#ifndef CATOPTRIC_ROUGH_GLSL
#define CATOPTRIC_ROUGH_GLSL

#include "lib/constants.glsl"
#include "lib/captures.glsl"

const uint kRoughNone = 0u, kRoughMips = 1u, kRoughPrefilter = 2u, kRoughRays = 3u;
layout(constant_id = ROUGH_CONSTANT) const uint rough = kRoughNone; // how rough surfaces are looked up, kRoughNone...
const bool has_levels = rough == kRoughMips || rough == kRoughPrefilter; // captures have blurred levels
layout(constant_id = LAW_CONSTANT) const uint distance_law = kLawNone;
layout(constant_id = LOBE_RAYS_CONSTANT) const uint lobe_rays = 1u; // searches of a rough surface, for kRoughRays
const uint kSearchSeed = 0x5ea4c4edu; // seed of the lobe's directions; the ray tracer's seeds are hashes

layout(set = 0, binding = 32) uniform textureCubeArray rough_cubes[kMaxCubeArrays]; // levels from 1 on of each capture
layout(set = 0, binding = 33) uniform sampler mipmapped_texels;

// Returns the colour in a direction at a level, from 1, of the mirror's capture.
vec3 capture_colour_at_level(uint mirror, vec3 direction, float level) {
#define ROUGH_COLOUR(i)                                                                                                \
    textureLod(samplerCubeArray(rough_cubes[i], mipmapped_texels), vec4(direction, cube_index_of_mirror(mirror)),      \
               level - 1.0)                                                                                            \
        .rgb
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, ROUGH_COLOUR)
}

// Returns the number of texels along a face's edge of the mirror's capture.
float colour_capture_edge(uint mirror) {
#define COLOUR_EDGE(i) float(textureSize(COLOUR_CUBES(i), 0).x)
    RETURN_OF_ARRAY(mirror, COLOUR_EDGE)
}

// Returns the level of a look-up of width `alpha` in the mirror's capture.
float rough_lookup_level(uint mirror, float alpha) {
    float edge = colour_capture_edge(mirror);
    return rough == kRoughMips ? box_level_of_alpha(alpha, edge) : capture_level_of_alpha(alpha, edge);
}

#endif
