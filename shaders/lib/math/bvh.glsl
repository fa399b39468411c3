// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Constants of the BVH's memory layout, which engine/bvh/bvh.hpp explains.

const int kBvhMaxDepth = 30; // most inner nodes on a path, so most stack entries for one tree
// bit set in every word, so that a word read as a float is no denormal and no NaN
const uint kBvhNormalFloatBit = 0x40000000u;
const uint kBvhCountShift = 27u; // position of a child's triangle count in its word; count 0: inner node
const uint kBvhIndexMask = 0x07ffffffu;
const uint kBvhRoot = 0x40000001u;  // the child word of the root, node 1
const uint kBvhEmptyChild = 0x40000000u;
const uint kBvhIdMask = 0x1fffffffu;  // bits of a word that hold a number, such as a triangle's
const uint kBvhHiddenFromCamera = 1u; // flag: camera rays pass through the triangle
const uint kBvhCastsNoShadow = 2u;    // flag: shadow rays pass through the triangle, which belongs to a lamp
const uint kBvhStandsForSphere = 4u;  // flag: the triangle's mesh approximates an exact sphere
const uint kBvhOneSided = 8u;         // flag: camera and mirror rays pass through from behind
const uint kBvhAlphaMasked = 16u;     // flag: an alpha test may cut parts of the triangle out
// Flag: a sphere takes the triangle's place: corner a is its centre, b.x its radius.
const uint kBvhSpherePrimitive = 32u;
const uint kBvhTintsShadow = 64u; // flag: glass, which attenuates the light of shadow rays that pass through

const uint kBvhInstanceMarker = 5u; // triangle count that marks an instance, whose record is at the word's node
// stack entry that marks the return from an instance to the scene's tree
const uint kBvhReturnFromInstance = 0x70000000u;
const uint kBvhNodesPerInstance = 3u; // nodes that the record of an instance takes
const int kBvhMaxStack = 62; // most stack entries: paths of two trees, the root above the first, kBvhReturnFromInstance

INLINE uint bvh_word_triangle_count(uint word) { return (word & ~kBvhNormalFloatBit) >> kBvhCountShift; }
INLINE uint bvh_word_index(uint word) { return word & kBvhIndexMask; }
INLINE bool is_bvh_word_inner_node(uint word) { return bvh_word_triangle_count(word) == 0u && bvh_word_index(word) != 0u; }
