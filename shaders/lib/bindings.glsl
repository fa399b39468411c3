// What every pass may see, under one number each. A shader that does not use a binding has not got it.
#ifndef CATOPTRIC_BINDINGS_GLSL
#define CATOPTRIC_BINDINGS_GLSL

#include "lib/math.glsl"
#include "shared.h"

// Uniform buffers where every invocation reads the same, uniform texel buffers where they do not: a software driver
// reads storage buffers lane by lane (docs/performance.md). Texels are laid out by engine/render/texels.hpp. Views are
// read by vertex shaders, for which texels were no cheaper.
layout(set = 0, binding = 0, scalar) uniform FrameBuffer { Frame value; } frame;
layout(set = 0, binding = 1, scalar) readonly buffer Views { View views[]; };
layout(set = 0, binding = 2) uniform samplerBuffer surface_texels;
layout(set = 0, binding = 3, scalar) uniform Lights { Light lights[kMaxLights]; };
layout(set = 0, binding = 4) uniform samplerBuffer probe_texels;
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
// 6, 7, 8, 17, 18, 19: captures, see lib/captures.glsl
#define BVH_NODES_BINDING 9
#define BVH_TRIANGLES_BINDING 10
#define NORMALS_BINDING 11
#define PICTURE_BINDING 12
#define COUNTERS_BINDING 14
#define HDR_BINDING 15
#define FIRST_LAYER_BINDING 16
#define MIRROR_NODES_BINDING 30 // see lib/next_mirror.glsl
// From 20 on a technique's own. See lib/material.glsl:
#define DETAILS_BINDING 40
#define ATTRIBUTES_BINDING 41
#define TEXELS_BINDING 42
// See lib/trace.glsl:
#define BVH_STORED_NODES_BINDING 43
#define BVH_STORED_TRIANGLES_BINDING 44

// Of an object.
Surface surface_of(uint object) {
    int i = int(kSurfaceTexels * object);
    vec4 albedo = texelFetch(surface_texels, i), sphere = texelFetch(surface_texels, i + 3);
    return Surface(albedo.rgb, texelFetch(surface_texels, i + 1).rgb, texelFetch(surface_texels, i + 2).rgb,
                   floatBitsToUint(albedo.w) & kBvhIdMask, sphere.xyz, sphere.w);
}

// Of a mirror, from 0. What is not used is not read.
Probe probe_at(uint mirror) {
    int i = int(kProbeTexels * mirror);
    vec4 sphere = texelFetch(probe_texels, i), centre = texelFetch(probe_texels, i + 1);
    return Probe(centre.xyz, sphere.xyz, sphere.w, texelFetch(probe_texels, i + 2).rgb,
                 texelFetch(probe_texels, i + 3).xyz, texelFetch(probe_texels, i + 4).xyz, uint(centre.w));
}

const uint kShadowNone = 0u, kShadowMap = 1u, kShadowRay = 2u;

#endif
