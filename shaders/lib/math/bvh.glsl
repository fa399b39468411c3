// Part of lib/math.glsl, which alone includes it.
// Layout of the bounding volume hierarchy (engine/bvh/bvh.hpp says what it means).

const int kBvhMaxDepth = 30;        // inner nodes on a path, hence entries on a stack
const uint kBvhTag = 0x40000000u;   // set in every word: as a float it is neither denormal nor NaN
const uint kBvhCountShift = 27u;    // a child's triangle count; 0 for an inner node
const uint kBvhIndexMask = 0x07ffffffu;
const uint kBvhRoot = 0x40000001u;  // the child word of the root, node 1
const uint kBvhNothing = 0x40000000u;
const uint kBvhIdMask = 0x1fffffffu; // of a triangle's words
const uint kBvhHidden = 1u;          // flag: camera rays pass through
const uint kBvhShadowless = 2u;      // flag: shadow rays pass through (a light's own mesh)
const uint kBvhSphere = 4u;          // flag: stands for an exact sphere
const uint kBvhOneSided = 8u;        // flag: rays that see pass through from behind
const uint kBvhMasked = 16u;         // flag: parts of it may be cut out
const uint kBvhBall = 32u;           // flag: no triangle but a sphere: a is its centre, b.x its radius

const uint kBvhEnters = 5u;          // in place of a triangle count: a thing in its own space, recorded at that node
const uint kBvhReturns = 0x70000000u; // on the stack: the way back from there
const uint kBvhRecordNodes = 3u;     // that such a record takes
const int kBvhMaxStack = 62;         // two trees' paths, the node above the first and the way back

INLINE uint bvh_count(uint word) { return (word & ~kBvhTag) >> kBvhCountShift; }
INLINE uint bvh_index(uint word) { return word & kBvhIndexMask; }
INLINE bool bvh_is_inner(uint word) { return bvh_count(word) == 0u && bvh_index(word) != 0u; }
