// The distance pyramid. Each face of each capture has levels 1, 2, ... of cells. A cell covers 2^level x 2^level
// texels, cut off at the face's end. A cell holds the least and the largest distance of its texels and of the ring of
// one texel around them. The ring continues across the face's edges. A bilinear lookup in the cell reads its four
// texels from this
// area, so the two distances bound its result.
// All levels of a face lie side by side in one array layer. A texel holds both bounds as 16-bit floats, rounded
// outwards.
#ifndef CATOPTRIC_PYRAMID_GLSL
#define CATOPTRIC_PYRAMID_GLSL

// Returns the number of cells along an edge of a level, for a face with `face` texels along its edge.
int cells_along_level_edge(int face, int level) { return (face + (1 << level) - 1) >> level; }

// Returns the number of the topmost level, at least 1. The topmost level has one cell for the face.
int top_pyramid_level(int face) { return face <= 2 ? 1 : findMSB(uint(face - 1)) + 1; }

// Returns the column at which a level begins in its layer. Each level is half as wide as the level below, so all levels
// fit into twice the width of level 1.
int first_column_of_level(int face, int level) {
    int full = 1 << top_pyramid_level(face);
    return full - (full >> (level - 1));
}

const uint kHalfInfinity = 0x7c00u;
const float kSmallestNormalHalf = 6.103515625e-5;

// Packs the least and the largest distance of a cell into a word, as halves that are rounded down and up. `low` is
// +infinity if the cell shows no surface at all, `high` is +infinity if some texel shows no surface. Rounds by the bits,
// because a compiler may take unpackHalf2x16(packHalf2x16(x)) for x and then see no rounding error (NVIDIA 580).
uint pack_distance_bounds(float low, float high) {
    // A float has 13 more bits of mantissa than a half, and the biases of their exponents differ by 112.
    const uint lost_bits = 13u, exponent_change = 112u << 10;
    uint a = kHalfInfinity, b = kHalfInfinity;
    if (!isinf(low))
        a = low < kSmallestNormalHalf ? 0u : (floatBitsToUint(min(low, kLargestHalf)) >> lost_bits) - exponent_change;
    if (!isinf(high) && high <= kLargestHalf)
        b = ((floatBitsToUint(max(high, kSmallestNormalHalf)) + (1u << lost_bits) - 1u) >> lost_bits) - exponent_change;
    return a | b << 16u;
}

#endif
