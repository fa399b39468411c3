// One level of the pyramid, from the captured distances (level 1) or from the level below.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"
#include "reflect/pyramid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20) uniform sampler2DArray distance_faces;
layout(set = 0, binding = 21, r32ui) uniform uimage2DArray bounds;
layout(push_constant, scalar) uniform Push { int level; };

const int kTile = 18; // texels under a work group's cells, and the ring around them
shared float tile[kTile * kTile];

// A texel of the layer's face, or beyond one of its edges the texel that a seamless lookup takes there:
// on the face next to it, the same number along the common edge. Beyond a corner there is none.
float texel(ivec2 at, int layer, int face) {
    bvec2 inside = equal(at, clamp(at, ivec2(0), ivec2(face - 1)));
    if (all(inside)) return texelFetch(distance_faces, ivec3(at, layer), 0).r;
    vec2 place = (vec2(2 * at) + 1.0) / float(face) - 1.0;
    // Stretched along the edge, so that the seen point lies on the other face at the same place.
    float out_by = 1.0 + 1.0 / float(face);
    if (inside.x) place.x *= out_by;
    if (inside.y) place.y *= out_by;
    vec3 direction = cube_direction(layer % 6, vec3(place, 1));
    int other = cube_face(direction);
    vec3 there = cube_coordinates(other, direction);
    ivec2 found = ivec2(floor((there.xy / there.z * 0.5 + 0.5) * float(face)));
    return texelFetch(distance_faces, ivec3(clamp(found, ivec2(0), ivec2(face - 1)), layer - layer % 6 + other), 0).r;
}

bool is_corner(ivec2 at, int face) {
    bvec2 outside = notEqual(at, clamp(at, ivec2(0), ivec2(face - 1)));
    return all(outside);
}

// Reads the tile whose first texel is `first`; what does not exist repeats a texel that does.
void read_tile(ivec2 first, int layer, int face) {
    for (uint i = gl_LocalInvocationIndex; i < uint(kTile * kTile); i += 64u) {
        ivec2 at = min(first + ivec2(int(i) % kTile, int(i) / kTile), ivec2(face));
        if (is_corner(at, face)) at.x = clamp(at.x, 0, face - 1);
        tile[i] = texel(at, layer, face);
    }
    barrier();
}

void main() {
    int face = textureSize(distance_faces, 0).x, layer = int(gl_WorkGroupID.z);
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    float low = uintBitsToFloat(0x7f800000u), high = 0.0;
    if (level == 1) {
        read_tile(2 * 8 * ivec2(gl_WorkGroupID.xy) - 1, layer, face);
        ivec2 corner = 2 * ivec2(gl_LocalInvocationID.xy);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                float d = tile[(corner.y + y) * kTile + corner.x + x];
                low = min(low, d);
                high = max(high, d);
            }
    } else {
        int below = level_edge(face, level - 1), column = level_column(face, level - 1);
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) {
                ivec2 child = 2 * cell + ivec2(x, y);
                if (max(child.x, child.y) >= below) continue;
                vec2 d = unpackHalf2x16(imageLoad(bounds, ivec3(column + child.x, child.y, layer)).r);
                low = min(low, d.x);
                high = max(high, d.y);
            }
    }
    if (max(cell.x, cell.y) < level_edge(face, level))
        imageStore(bounds, ivec3(level_column(face, level) + cell.x, cell.y, layer), uvec4(pack_bounds(low, high)));
}
