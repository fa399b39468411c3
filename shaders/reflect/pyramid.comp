// One level of the pyramid, from the captured distances (level 1) or from the level below.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/captures.glsl"
#include "reflect/pyramid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 21, r32ui) uniform uimage2DArray bounds;
layout(push_constant, scalar) uniform Push { int level; };
layout(constant_id = OWN_CONSTANTS) const uint from_cells = 0u;

// Least and largest of no distance at all.
vec2 no_bounds() { return vec2(uintBitsToFloat(0x7f800000u), 0); }

// The 4x4 texels of the cell and its ring, by four gathers. What those take across the edges of faces is
// what bilinear lookups take there; beyond a corner of the cube there is no texel, and whatever stands for
// it only widens the bounds.
vec2 bounds_of_texels(ivec2 cell, int layer, int face) {
    vec2 bound = no_bounds();
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = min(2 * cell + 2 * ivec2(i & 1, i >> 1), ivec2(face));
        vec2 place = vec2(2 * corner) / float(face) - 1.0;
        vec4 d = textureGather(distance_cubes, vec4(cube_direction(layer % 6, vec3(place, 1)), layer / 6));
        bound.x = min(bound.x, min(min(d.x, d.y), min(d.z, d.w)));
        bound.y = max(bound.y, max(max(d.x, d.y), max(d.z, d.w)));
    }
    return bound;
}

// The 2x2 cells of the level below; where the face ends, the last ones again.
vec2 bounds_of_cells(ivec2 cell, int layer, int face) {
    vec2 bound = no_bounds();
    int below = level_edge(face, level - 1), column = level_column(face, level - 1);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
            ivec2 child = min(2 * cell + ivec2(x, y), ivec2(below - 1));
            vec2 d = unpackHalf2x16(imageLoad(bounds, ivec3(column + child.x, child.y, layer)).r);
            bound = vec2(min(bound.x, d.x), max(bound.y, d.y));
        }
    return bound;
}

void main() {
    int face = textureSize(distance_cubes, 0).x, layer = int(gl_WorkGroupID.z);
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    vec2 bound = from_cells == 0u ? bounds_of_texels(cell, layer, face) : bounds_of_cells(cell, layer, face);
    if (max(cell.x, cell.y) < level_edge(face, level))
        imageStore(bounds, ivec3(level_column(face, level) + cell.x, cell.y, layer), uvec4(pack_bounds(bound.x, bound.y)));
}
