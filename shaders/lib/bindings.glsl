// What every pass may see, under one number each. A shader that does not use a binding has not got it.
#ifndef CATOPTRIC_BINDINGS_GLSL
#define CATOPTRIC_BINDINGS_GLSL

#include "lib/math.glsl"
#include "shared.h"

// Uniform buffers where every invocation reads the same; storage buffers are no faster there (docs/performance.md).
layout(set = 0, binding = 0, scalar) uniform FrameBuffer { Frame value; } frame;
layout(set = 0, binding = 1, scalar) readonly buffer Views { View views[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Surfaces { Surface surfaces[]; };
layout(set = 0, binding = 3, scalar) uniform Lights { Light lights[kMaxLights]; };
layout(set = 0, binding = 4, scalar) readonly buffer Probes { Probe probes[]; };
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
// 6, 7, 8, 17, 18, 19: captures, see lib/captures.glsl
#define BVH_NODES_BINDING 9
#define BVH_TRIANGLES_BINDING 10
#define NORMALS_BINDING 11
#define PICTURE_BINDING 12
#define HITS_BINDING 13
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

const uint kShadowNone = 0u, kShadowMap = 1u, kShadowRay = 2u;

#endif
