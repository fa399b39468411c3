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
// Uniform, not storage: a software driver reads that without a branch, and what is computed around a branch it rounds
// otherwise than what is computed around none.
// The last uniform buffer of all, since Mesa 22.3's software driver writes beyond a table of its own, and crashes, where
// what is stored or decided comes from a constant place in the fourth; places in this one are computed.
layout(set = 0, binding = 31, scalar) uniform Captures { CaptureTable captures; };

#define COLOUR_CUBES(i) samplerCubeArray(colour_cubes[i], linear_texels)
#define DISTANCE_CUBES(i) samplerCubeArray(distance_cubes[i], linear_texels)
#define DISTANCE_CUBES_NEAREST(i) samplerCubeArray(distance_cubes[i], nearest_texels)
#define SURFACE_CUBES(i) samplerCubeArray(surface_cubes[i], nearest_texels)
// Faces of cubes as layers, or what was made of them: a uniform of a technique's own, and how it is read.
#define FACES(name) texture2DArray name[kMostArrays]
#define FACES_OF(name, i) sampler2DArray(name[i], nearest_texels)
#define WHOLE_FACES(name) utexture2DArray name[kMostArrays]
#define WHOLE_FACES_OF(name, i) usampler2DArray(name[i], nearest_texels)
// Arrays that there are: what is decided here costs nothing, and leaves the compiler with the code of the other builds.
layout(constant_id = ARRAY_COUNT_CONSTANT) const uint array_count = kMostArrays;
layout(constant_id = STORED_UNIT_CONSTANT) const float stored_unit = 0.0; // 0: not the same for all
uint array_of(uint mirror) { return captures.places[mirror] >> 16u; }
bool is_in(uint mirror, uint array) { return array < array_count && array_of(mirror) == array; }
// The end of a function: READ of the array that has the mirror's capture.
#define RETURN_OF_ARRAY(mirror, READ)                                                                                  \
    if (is_in(mirror, 1u)) return READ(1);                                                                             \
    if (is_in(mirror, 2u)) return READ(2);                                                                             \
    if (is_in(mirror, 3u)) return READ(3);                                                                             \
    if (is_in(mirror, 4u)) return READ(4);                                                                             \
    if (is_in(mirror, 5u)) return READ(5);                                                                             \
    if (is_in(mirror, 6u)) return READ(6);                                                                             \
    if (is_in(mirror, 7u)) return READ(7);                                                                             \
    return READ(0);

uint cube_of(uint mirror) { return captures.places[mirror] & 0xffffu; }
bool is_captured(uint mirror) { return array_of(mirror) < kMostArrays; }
// Scene units of a stored 1: 1 for float formats, the range for unorm8.
float stored_unit_of(uint mirror) { return stored_unit > 0.0 ? stored_unit : captures.arrays[array_of(mirror)].stored_unit; }
// With unorm8 a stored 1 is the end of the range, whatever lies there.
bool range_ends_of(uint mirror) { return captures.arrays[array_of(mirror)].range_ends != 0u; }

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
