// Bindings that all passes share. Each resource has one binding number in all shaders. A shader's pipeline layout has
// only the bindings that the shader uses.
#ifndef CATOPTRIC_BINDINGS_GLSL
#define CATOPTRIC_BINDINGS_GLSL

#include "lib/math.glsl"
#include "lib/texels.glsl"
#include "lib/work.glsl"
#include "shared.h"

// Data that all invocations read at the same index is in uniform buffers. Data that they read at different indices is
// in texel lists (lib/texels.glsl), laid out by engine/render/texels.hpp. Views are in a storage buffer, because vertex
// shaders read them, for which texel lists were not cheaper.
layout(set = 0, binding = 0, scalar) uniform FrameBuffer { Frame value; } frame;
layout(set = 0, binding = 1, scalar) readonly buffer Views { View views[]; };
#ifdef VERTEX_STAGE // a vertex shader reads a list at one index for all lanes, so storage buffers are cheap
#define STORED_FOR_VERTICES true
#else
#define STORED_FOR_VERTICES false
#endif
TEXEL_LIST(2, surface_texels, vec4, samplerBuffer, STORED_FOR_VERTICES)
layout(set = 0, binding = 3, scalar) uniform Lights { Light lights[kMaxLights]; };
TEXEL_LIST(4, probe_texels, vec4, samplerBuffer, STORED_FOR_VERTICES)
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
// lib/captures.glsl declares the bindings 6, 7, 8, 17, 18 and 31 for captures.
#define BVH_NODES_BINDING 9
#define BVH_TRIANGLES_BINDING 10
#define NORMALS_BINDING 11
#define PICTURE_BINDING 12
#define PLACEMENTS_BINDING 13 // one Placement for each object (lib/vertex.glsl)
#define COUNTERS_BINDING 14
#define HDR_BINDING 15
#define FIRST_LAYER_BINDING 16
#define FIRST_HITS_BINDING 19 // places of triangles in the BVH (lib/whitted.glsl)
#define MIRROR_NODES_BINDING 30 // tree over the mirrors' bounds (lib/next_mirror.glsl)
// lib/rough.glsl uses the bindings 32 and 33, and lib/light_probes.glsl 34 to 36.
#define GLASS_DEPTHS_BINDING 37  // optical depths of glass (lib/shadow.glsl)
#define SHADOW_DEPTHS_BINDING 38 // the shadow map without comparison (lib/soft_shadow.glsl, glass_shadow.frag)
#define GLASS_BACKS_BINDING 39   // back faces of glass in the camera's view (lib/refraction.glsl)
// Bindings 20 to 27 belong to techniques and single passes, and 28 and 29 to lib/environment.glsl. lib/material.glsl uses
// the bindings 40 to 42:
#define DETAILS_BINDING 40
#define ATTRIBUTES_BINDING 41
#define TEXELS_BINDING 42
// lib/work.glsl uses binding 43.
#define OPAQUE_PICTURE_BINDING 44 // the camera's view without glass (lib/opaque_picture.glsl)
#define OPAQUE_LEVELS_BINDING 45  // its box-filtered levels
#define LAMP_EXTENTS_BINDING 46   // a LampExtent for each light (lib/soft_shadow.glsl)
#define AMBIENT_OCCLUSION_BINDING 47 // share of light that near surfaces let through (lib/ambient_occlusion.glsl)
#define LAMPS_BINDING 48             // triangles that emit light (lib/lamps.glsl)
// Bindings from 64 on are texel lists that lib/texels.glsl keeps in storage buffers.

// Reads the surface of an object.
Surface read_surface(uint object) {
    uint i = kTexelsPerSurface * object;
    vec4 albedo = surface_texels_at(i), emission = surface_texels_at(i + 1u), sphere = surface_texels_at(i + 3u);
    return Surface(albedo.rgb, emission.rgb, surface_texels_at(i + 2u).rgb, floatBitsToUint(albedo.w) & kBvhIdMask,
                   floatBitsToUint(emission.w) & kBvhIdMask, sphere.xyz, sphere.w);
}

// Reads the probe of a mirror, counted from 0. The compiler removes reads of members that the caller does not use.
Probe read_probe(uint mirror) {
    uint i = kTexelsPerProbe * mirror;
    vec4 sphere = probe_texels_at(i), centre = probe_texels_at(i + 1u), lowest = probe_texels_at(i + 3u);
    return Probe(centre.xyz, sphere.xyz, sphere.w, probe_texels_at(i + 2u).rgb, lowest.xyz, probe_texels_at(i + 4u).xyz,
                 uint(centre.w), uint(lowest.w));
}

const uint kShadowNone = 0u, kShadowMap = 1u, kShadowRay = 2u;

#endif
