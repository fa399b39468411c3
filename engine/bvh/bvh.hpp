#pragma once

#include "core/shader_math.hpp"

#include <span>
#include <vector>

/// A bounding volume hierarchy over the triangles of a frame, laid out for shaders/lib/trace.glsl.
namespace catoptric::bvh {

/// One triangle in scene units.
struct Triangle {
    vec3 a{0}, b{0}, c{0};
    std::uint32_t object = 0; ///< below 2^29; comes back with a hit
    std::uint32_t flags = 0;  ///< kHidden | kShadowless | kSphere | kOneSided | kMasked | kBall
};

inline constexpr std::uint32_t kHidden = f32::kBvhHidden;         ///< camera rays pass through
inline constexpr std::uint32_t kShadowless = f32::kBvhShadowless; ///< shadow rays pass through
inline constexpr std::uint32_t kSphere = f32::kBvhSphere;         ///< stands for an exact sphere
inline constexpr std::uint32_t kOneSided = f32::kBvhOneSided; ///< where skipped: met in front alone
inline constexpr std::uint32_t kMasked = f32::kBvhMasked;     ///< parts of it may be cut out
inline constexpr std::uint32_t kBall = f32::kBvhBall;         ///< no triangle: see `sphere`
inline constexpr std::uint32_t kMaxDepth = f32::kBvhMaxDepth;
inline constexpr std::uint32_t kMaxLeaf = 4; ///< triangles in a leaf

/// A sphere in a triangle's place, for walks that know spheres (TRACE_BALLS of
/// shaders/lib/trace.glsl).
inline Triangle sphere(const vec3& centre, float radius, std::uint32_t object,
                       std::uint32_t flags) {
    return {centre, vec3(radius, 0, 0), vec3(0), object, flags | kBall};
}

/// The two arrays that the device reads as they stand.
///
/// `nodes`, four vec4 each; w is a word's bits (see below):
///   node 0, the header:  lo.xyz of the core, number of kept triangles
///                        hi.xyz of the core, number of nodes with the header
///                        two times zero
///   node 1, the root, and all others hold their two children's boxes:
///                        lo.xyz of child 0, word of child 0
///                        hi.xyz of child 0, word of child 1
///                        lo.xyz of child 1, 0
///                        hi.xyz of child 1, 0
///   An absent child has the empty box (lo = +inf, hi = -inf) and the word kBvhNothing.
///
/// `triangles`, three vec4 each, in the order of the leaves:
///                        a.xyz, object index               (of a ball: its centre)
///                        b.xyz, original triangle number   (its radius, 0, 0)
///                        c.xyz, flags
///
/// Words. Bit 31 is clear, bit 30 set and bit 29 clear or followed by clear ones, so that no word,
/// read as a float, is denormal, infinite or NaN and none is changed on its way. A child's word has
/// its triangle count in bits 27..29 and its first triangle's place in bits 0..26; count 0 means an
/// inner node, and then bits 0..26 are that node's place (0: nothing there). The other words have
/// their number in bits 0..28.
struct Bvh {
    std::vector<vec4> nodes;
    std::vector<vec4> triangles;
    std::size_t dropped = 0; ///< triangles left out because a coordinate is not finite
    std::size_t copies = 0;  ///< left out as copies of one with a lower number (see build)
    double cost = 0; ///< what the function of that name says; `refit` keeps it by what it changes
};

/// Binned surface area heuristic; where a path would grow deeper than kMaxDepth, halves by number.
/// Of more than kMaxLeaf triangles around one centre, those with the same corners, object and flags
/// count as one, the lowest number: walks past thousands of copies would not end in time.
/// Same input, same output. O(n log^2 n) whatever the input, .4 s of one thread for a million
/// triangles. `core`: where most of it is; the walk widens all boxes by roundings of that size.
/// Boxes of triangles that lie farther out are wider themselves, so that one of them does not cost
/// every ray. Empty: all is. `leaf`: triangles in a leaf, 1 to kMaxLeaf. `threads`: at most so
/// many, on which the tree does not depend; 0: as many as the machine runs at once. Throws
/// `Failure::exhausted` above 2^27 - 1 triangles.
Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core = {},
          std::uint32_t leaf = kMaxLeaf, unsigned threads = 0);

/// From the first to before `end`.
struct Run {
    std::size_t first = 0, end = 0;
    bool operator==(const Run&) const = default;
};

/// What of a tree is to be looked at when some objects move.
struct Reach {
    std::vector<std::uint32_t> triangles; ///< places in the order of the leaves, rising
    std::vector<std::uint32_t> boxes;     ///< 2 * node + side, those below before those above
};

/// Triangles of the objects, by number whether they may move, and the boxes that hold some. O(n).
Reach reach_of(const Bvh& bvh, std::span<const char> objects);

/// The same tree over the same triangles elsewhere: `triangles` as they were given to `build`, in
/// the same order, moved. `reach`: of all objects that may have moved; null: all have. Returns the
/// run of Bvh::triangles outside of which none did. What a ray meets does not depend on whether a
/// tree was built or refitted. O(what is reached), a tenth of a build for all. Throws
/// `Failure::internal` where a triangle that was finite is not.
Run refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core = {},
          const Reach* reach = nullptr);

/// What the surface area heuristic expects of a ray's walk, times the area of the whole: rises as
/// the triangles of a refitted tree move away from their neighbours. O(n).
double cost(const Bvh& bvh);

std::size_t node_count(const Bvh& bvh);     ///< with the header
std::size_t triangle_count(const Bvh& bvh); ///< kept ones

} // namespace catoptric::bvh
