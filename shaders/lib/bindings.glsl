// What every pass may see, under one number each. A shader that does not use a binding has not got it.
#ifndef CATOPTRIC_BINDINGS_GLSL
#define CATOPTRIC_BINDINGS_GLSL

#include "lib/math.glsl"
#include "lib/texels.glsl"
#include "shared.h"

// Uniform buffers where every invocation reads the same, lists of lib/texels.glsl where they do not, laid out by
// engine/render/texels.hpp. Views are read by vertex shaders, for which texels were no cheaper.
layout(set = 0, binding = 0, scalar) uniform FrameBuffer { Frame value; } frame;
layout(set = 0, binding = 1, scalar) readonly buffer Views { View views[]; };
#ifdef VERTEX_STAGE // which reads them at one place for all lanes
#define STORED_FOR_VERTICES true
#else
#define STORED_FOR_VERTICES false
#endif
TEXEL_LIST(2, surface_texels, vec4, samplerBuffer, STORED_FOR_VERTICES)
layout(set = 0, binding = 3, scalar) uniform Lights { Light lights[kMaxLights]; };
TEXEL_LIST(4, probe_texels, vec4, samplerBuffer, STORED_FOR_VERTICES)
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
// 6, 7, 8, 17, 18, 19: captures, see lib/captures.glsl
#define BVH_NODES_BINDING 9
#define BVH_TRIANGLES_BINDING 10
#define NORMALS_BINDING 11
#define PICTURE_BINDING 12
#define PLACEMENTS_BINDING 13 // by object, see lib/vertex.glsl
#define COUNTERS_BINDING 14
#define HDR_BINDING 15
#define FIRST_LAYER_BINDING 16
#define MIRROR_NODES_BINDING 30 // see lib/next_mirror.glsl
// From 20 on a technique's own. See lib/material.glsl:
#define DETAILS_BINDING 40
#define ATTRIBUTES_BINDING 41
#define TEXELS_BINDING 42
// From 64 on what lib/texels.glsl keeps in storage buffers.

// Of an object.
Surface surface_of(uint object) {
    uint i = kSurfaceTexels * object;
    vec4 albedo = surface_texels_at(i), emission = surface_texels_at(i + 1u), sphere = surface_texels_at(i + 3u);
    return Surface(albedo.rgb, emission.rgb, surface_texels_at(i + 2u).rgb, floatBitsToUint(albedo.w) & kBvhIdMask,
                   floatBitsToUint(emission.w) & kBvhIdMask, sphere.xyz, sphere.w);
}

// Of a mirror, from 0. What is not used is not read.
Probe probe_at(uint mirror) {
    uint i = kProbeTexels * mirror;
    vec4 sphere = probe_texels_at(i), centre = probe_texels_at(i + 1u);
    return Probe(centre.xyz, sphere.xyz, sphere.w, probe_texels_at(i + 2u).rgb, probe_texels_at(i + 3u).xyz,
                 probe_texels_at(i + 4u).xyz, uint(centre.w));
}

const uint kShadowNone = 0u, kShadowMap = 1u, kShadowRay = 2u;

#endif
