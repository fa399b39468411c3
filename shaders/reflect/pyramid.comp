// Computes one level of the distance pyramid: level 1 from the captured distances, other levels from the level below.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"
#include "reflect/pyramid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20) uniform samplerCubeArray distances; // captured distances of one array of captures
layout(set = 0, binding = 21, r32ui) uniform uimage2DArray bounds;
layout(push_constant, scalar) uniform Push { int level; };
layout(constant_id = OWN_CONSTANTS) const uint from_cells = 0u;

// Returns the initial values of a least and a largest distance, before any distance is known.
vec2 make_empty_distance_bounds() { return vec2(uintBitsToFloat(0x7f800000u), 0); }

// Returns the bounds over the 4x4 texels of a level 1 cell and its ring of neighbours, by four gathers. Across the
// edges of cube faces, a gather reads the same texels as a bilinear lookup. Beyond a corner of the cube no texel
// exists, and the value that a gather returns can only widen the bounds.
vec2 distance_bounds_of_texels(ivec2 cell, int layer, int face) {
    vec2 bound = make_empty_distance_bounds();
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = min(2 * cell + 2 * ivec2(i & 1, i >> 1), ivec2(face));
        vec2 place = vec2(2 * corner) / float(face) - 1.0;
        count_work_once(kWorkDistanceLookups);
        vec4 d = textureGather(distances, vec4(cube_direction(layer % 6, vec3(place, 1)), layer / 6));
        bound.x = min(bound.x, min(min(d.x, d.y), min(d.z, d.w)));
        bound.y = max(bound.y, max(max(d.x, d.y), max(d.z, d.w)));
    }
    return bound;
}

// Returns the bounds over the 2x2 cells of the level below. Cells beyond the face's end repeat the last cells.
vec2 distance_bounds_of_cells(ivec2 cell, int layer, int face) {
    vec2 bound = make_empty_distance_bounds();
    int below = cells_along_level_edge(face, level - 1), column = first_column_of_level(face, level - 1);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
            ivec2 child = min(2 * cell + ivec2(x, y), ivec2(below - 1));
            vec2 d = unpackHalf2x16(imageLoad(bounds, ivec3(column + child.x, child.y, layer)).r);
            bound = vec2(min(bound.x, d.x), max(bound.y, d.y));
        }
    return bound;
}

void main() {
    int face = textureSize(distances, 0).x, layer = int(gl_WorkGroupID.z);
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    vec2 bound = from_cells == 0u ? distance_bounds_of_texels(cell, layer, face) : distance_bounds_of_cells(cell, layer, face);
    if (max(cell.x, cell.y) < cells_along_level_edge(face, level))
        imageStore(bounds, ivec3(first_column_of_level(face, level) + cell.x, cell.y, layer), uvec4(pack_distance_bounds(bound.x, bound.y)));
}
