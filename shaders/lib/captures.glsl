// The cube arrays that hold captures. All captures in an array have one size and one format. Usually one array holds
// all captures, and mirror n's capture is cube n. With several arrays, a table gives each mirror its array and cube.
// Some devices cannot index textures by a computed number, so a chain of comparisons selects the array by a constant.
#ifndef CATOPTRIC_CAPTURES_GLSL
#define CATOPTRIC_CAPTURES_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

layout(set = 0, binding = 6) uniform textureCubeArray colour_cubes[kMaxCubeArrays];
layout(set = 0, binding = 7) uniform textureCubeArray distance_cubes[kMaxCubeArrays];
// The surface cubes hold, for each texel, the number of the captured mirror or object, and its normal
// (lib/surface.glsl).
layout(set = 0, binding = 17) uniform textureCubeArray surface_cubes[kMaxCubeArrays];
layout(set = 0, binding = 8) uniform sampler linear_texels;
layout(set = 0, binding = 18) uniform sampler nearest_texels;
// The capture table is a uniform buffer, because the software driver reads storage buffers with a branch. Arithmetic
// around a branch is rounded differently from arithmetic in shaders that do not read the table.
// The binding number puts the table after frame, lights and sky. Mesa 22.3's software driver crashes if a shader uses a
// value from a constant index of the fourth uniform buffer. Indices into this table are computed.
layout(set = 0, binding = 31, scalar) uniform Captures { CaptureLookupTable captures; };

#define COLOUR_CUBES(i) samplerCubeArray(colour_cubes[i], linear_texels)
#define DISTANCE_CUBES(i) samplerCubeArray(distance_cubes[i], linear_texels)
#define DISTANCE_CUBES_NEAREST(i) samplerCubeArray(distance_cubes[i], nearest_texels)
#define SURFACE_CUBES(i) samplerCubeArray(surface_cubes[i], nearest_texels)
// FACES declares a technique's texture array with one layer for each cube face, and FACES_OF reads such an array.
// UINT_FACES and UINT_FACES_OF do the same for arrays of unsigned integers.
#define FACES(name) texture2DArray name[kMaxCubeArrays]
#define FACES_OF(name, i) sampler2DArray(name[i], nearest_texels)
#define UINT_FACES(name) utexture2DArray name[kMaxCubeArrays]
#define UINT_FACES_OF(name, i) usampler2DArray(name[i], nearest_texels)
// 1: a table gives each mirror its array of captures, and its cube in that array. 0: mirror n's capture is cube n of
// the only array. The engine specialises shaders before the driver sees them. Comparisons with absent arrays therefore
// cost nothing, and a shader without a table has no binding for a table.
layout(constant_id = HAS_CAPTURE_TABLE_CONSTANT) const uint has_capture_table = 0u;
layout(constant_id = ARRAY_COUNT_CONSTANT) const uint array_count = 1u;
// The scene units of the stored distance 1, if they are the same in all arrays; 0: the arrays differ.
layout(constant_id = STORED_UNIT_CONSTANT) const float stored_unit = 1.0;
// Without a table of captures: 1 if the stored distance 1 is the end of the range, as in unorm8.
layout(constant_id = RANGE_ENDS_CONSTANT) const uint range_ends = 0u;

uint capture_array_of_mirror(uint mirror) { return captures.places[mirror] >> 16u; }
bool is_capture_in_array(uint mirror, uint array) { return capture_array_of_mirror(mirror) == array; }
// Ends a function: returns READ(i), where array i holds the mirror's capture.
#define RETURN_OF_ARRAY(mirror, READ)                                                                                  \
    if (array_count > 1u && is_capture_in_array(mirror, 1u)) return READ(1);                                           \
    if (array_count > 2u && is_capture_in_array(mirror, 2u)) return READ(2);                                           \
    if (array_count > 3u && is_capture_in_array(mirror, 3u)) return READ(3);                                           \
    if (array_count > 4u && is_capture_in_array(mirror, 4u)) return READ(4);                                           \
    if (array_count > 5u && is_capture_in_array(mirror, 5u)) return READ(5);                                           \
    if (array_count > 6u && is_capture_in_array(mirror, 6u)) return READ(6);                                           \
    if (array_count > 7u && is_capture_in_array(mirror, 7u)) return READ(7);                                           \
    return READ(0);

uint cube_index_of_mirror(uint mirror) {
    if (has_capture_table == 0u) return mirror;
    return captures.places[mirror] & 0xffffu;
}
bool has_mirror_capture(uint mirror) {
    if (has_capture_table == 0u) return true;
    return capture_array_of_mirror(mirror) < kMaxCubeArrays;
}
// Returns the scene units of the stored distance 1: 1 for float formats, the range for unorm8.
float stored_distance_unit(uint mirror) {
    if (has_capture_table == 0u || stored_unit > 0.0) return stored_unit;
    return captures.arrays[capture_array_of_mirror(mirror)].stored_unit;
}
// Returns whether the stored distance 1 is the end of the range, as in unorm8, so that a surface may be farther away.
bool has_distance_limit(uint mirror) {
    if (has_capture_table == 0u) return range_ends != 0u;
    return captures.arrays[capture_array_of_mirror(mirror)].range_ends != 0u;
}

// Returns the layer of the first face of a mirror's capture in texture arrays whose layers are cube faces.
uint first_face_layer_of_mirror(uint mirror) { return 6u * cube_index_of_mirror(mirror); }

#endif
