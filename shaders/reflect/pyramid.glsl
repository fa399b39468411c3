// The pyramid of distances: for each face of each capture levels 1, 2, ... of cells that cover 2^level
// texels an edge, cut off at the face's end. A cell holds the least and the largest distance of its
// texels and of the ring of one texel around them, across the face's edges too: a bilinear lookup
// anywhere in the cell takes its four texels from there, so the two bound it.
// All levels lie side by side in one layer a face; a texel packs both bounds as halves, rounded outwards.
#ifndef CATOPTRIC_PYRAMID_GLSL
#define CATOPTRIC_PYRAMID_GLSL

// Cells along an edge.
int level_edge(int face, int level) { return (face + (1 << level) - 1) >> level; }

// The topmost level: one cell a face. At least 1.
int top_level(int face) { return face <= 2 ? 1 : findMSB(uint(face - 1)) + 1; }

// Where the level begins: edges of full levels are halved, so their sum stays below the first.
int level_column(int face, int level) {
    int full = 1 << top_level(face);
    return full - (full >> (level - 1));
}

const uint kHalfInfinity = 0x7c00u;
const float kLargestStoredHalf = 65504.0, kSmallestHalf = 6.103515625e-5;

// `low` is +infinity where there is nothing at all, `high` where there is nothing somewhere.
uint pack_bounds(float low, float high) {
    uint a = kHalfInfinity, b = kHalfInfinity;
    if (!isinf(low)) {
        low = low < kSmallestHalf ? 0.0 : min(low, kLargestStoredHalf);
        a = packHalf2x16(vec2(low, 0)) & 0xffffu;
        if (unpackHalf2x16(a).x > low) --a;
    }
    if (!isinf(high) && high <= kLargestStoredHalf) {
        high = max(high, kSmallestHalf);
        b = packHalf2x16(vec2(high, 0)) & 0xffffu;
        if (unpackHalf2x16(b).x < high) ++b;
    }
    return a | b << 16u;
}

#endif
