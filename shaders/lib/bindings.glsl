// What every pass may see, under one number each. A shader that does not use a binding has not got it.
#ifndef CATOPTRIC_BINDINGS_GLSL
#define CATOPTRIC_BINDINGS_GLSL

#include "lib/math.glsl"
#include "shared.h"

// Uniform buffers where every invocation reads the same: a software driver loads them once.
layout(set = 0, binding = 0, scalar) uniform FrameBuffer { Frame value; } frame;
layout(set = 0, binding = 1, scalar) readonly buffer Views { View views[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Surfaces { Surface surfaces[]; };
layout(set = 0, binding = 3, scalar) uniform Lights { Light lights[kMaxLights]; };
layout(set = 0, binding = 4, scalar) readonly buffer Probes { Probe probes[]; };
layout(set = 0, binding = 5) uniform sampler2DArrayShadow shadow_map;
layout(set = 0, binding = 6) uniform samplerCubeArray colour_cubes;
layout(set = 0, binding = 7) uniform samplerCubeArray distance_cubes;
layout(set = 0, binding = 8) uniform samplerCubeArray distance_cubes_nearest;
#define BVH_NODES_BINDING 9
#define BVH_TRIANGLES_BINDING 10
#define NORMALS_BINDING 11
#define PICTURE_BINDING 12
#define HITS_BINDING 13
#define COUNTERS_BINDING 14
#define HDR_BINDING 15
#define FIRST_LAYER_BINDING 16
layout(set = 0, binding = 17) uniform samplerCubeArray surface_cubes; // number and normal, see lib/surface.glsl

const uint kShadowNone = 0u, kShadowMap = 1u, kShadowRay = 2u;

#endif
