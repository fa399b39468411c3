// Where captures are kept: cube arrays of one size and format each. Where one holds them all, as nearly always,
// mirror n's is its cube n. Builds with ARRAYS have several, and a table of which cube of which is a mirror's; since
// not every device can index textures by what it computes, a switch chooses among constants.
#ifndef CATOPTRIC_CAPTURES_GLSL
#define CATOPTRIC_CAPTURES_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

#ifdef ARRAYS

layout(set = 0, binding = 6) uniform textureCubeArray colour_cubes[kMostArrays];
layout(set = 0, binding = 7) uniform textureCubeArray distance_cubes[kMostArrays];
layout(set = 0, binding = 17) uniform textureCubeArray surface_cubes[kMostArrays]; // see lib/surface.glsl
layout(set = 0, binding = 8) uniform sampler linear_texels;
layout(set = 0, binding = 18) uniform sampler nearest_texels;
layout(set = 0, binding = 19, scalar) readonly buffer CapturePlaces { CapturePlace places[]; };

#define COLOUR_CUBES(i) samplerCubeArray(colour_cubes[i], linear_texels)
#define DISTANCE_CUBES(i) samplerCubeArray(distance_cubes[i], linear_texels)
#define DISTANCE_CUBES_NEAREST(i) samplerCubeArray(distance_cubes[i], nearest_texels)
#define SURFACE_CUBES(i) samplerCubeArray(surface_cubes[i], nearest_texels)
// Faces of cubes as layers, or what was made of them: a uniform of a technique's own, and how it is read.
#define FACES(name) texture2DArray name[kMostArrays]
#define FACES_OF(name, i) sampler2DArray(name[i], nearest_texels)
#define WHOLE_FACES(name) utexture2DArray name[kMostArrays]
#define WHOLE_FACES_OF(name, i) usampler2DArray(name[i], nearest_texels)
// The end of a function: READ of the array that has the mirror's capture.
#define RETURN_OF_ARRAY(mirror, READ)                                                                                  \
    switch (places[mirror].array) {                                                                                    \
    case 1u: return READ(1);                                                                                           \
    case 2u: return READ(2);                                                                                           \
    case 3u: return READ(3);                                                                                           \
    case 4u: return READ(4);                                                                                           \
    case 5u: return READ(5);                                                                                           \
    case 6u: return READ(6);                                                                                           \
    case 7u: return READ(7);                                                                                           \
    default: return READ(0);                                                                                           \
    }

uint cube_of(uint mirror) { return places[mirror].cube; }
bool is_captured(uint mirror) { return places[mirror].array < kMostArrays; }
// Scene units of a stored 1: 1 for float formats, the range for unorm8.
float stored_unit_of(uint mirror) { return places[mirror].stored_unit; }
// With unorm8 a stored 1 is the end of the range, whatever lies there.
bool range_ends_of(uint mirror) { return places[mirror].range_ends != 0u; }

#else

layout(set = 0, binding = 6) uniform samplerCubeArray colour_cubes;
layout(set = 0, binding = 7) uniform samplerCubeArray distance_cubes;
layout(set = 0, binding = 8) uniform samplerCubeArray distance_cubes_nearest;
layout(set = 0, binding = 17) uniform samplerCubeArray surface_cubes;

#define COLOUR_CUBES(i) colour_cubes
#define DISTANCE_CUBES(i) distance_cubes
#define DISTANCE_CUBES_NEAREST(i) distance_cubes_nearest
#define SURFACE_CUBES(i) surface_cubes
#define FACES(name) sampler2DArray name
#define FACES_OF(name, i) name
#define WHOLE_FACES(name) usampler2DArray name
#define WHOLE_FACES_OF(name, i) name
#define RETURN_OF_ARRAY(mirror, READ) return READ(0);

layout(constant_id = STORED_UNIT_CONSTANT) const float stored_unit = 1.0;
layout(constant_id = RANGE_ENDS_CONSTANT) const uint range_ends = 0u;

uint cube_of(uint mirror) { return mirror; }
bool is_captured(uint mirror) { return true; }
float stored_unit_of(uint mirror) { return stored_unit; }
bool range_ends_of(uint mirror) { return range_ends != 0u; }

#endif

// The layer of a cube's first face, where faces are layers.
uint first_face_of(uint mirror) { return 6u * cube_of(mirror); }

#endif
