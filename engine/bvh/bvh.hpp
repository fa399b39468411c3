#pragma once

#include "core/shader_math.hpp"

#include <span>
#include <vector>

/// A bounding volume hierarchy over the triangles of a frame, laid out for shaders/lib/trace.glsl.
namespace catoptric::bvh {

/// One triangle in scene units.
struct Triangle {
    vec3 a{0}, b{0}, c{0};
    std::uint32_t object = 0; ///< below 2^29; a hit returns it
    std::uint32_t flags =
        0; ///< kHiddenFromCameraFlag | kCastsNoShadowFlag | kStandsForSphereFlag
           ///< | kOneSidedFlag | kAlphaMaskedFlag | kSpherePrimitiveFlag | kTintsShadowFlag
};

inline constexpr std::uint32_t kHiddenFromCameraFlag =
    f32::kBvhHiddenFromCamera; ///< camera rays pass through
inline constexpr std::uint32_t kCastsNoShadowFlag =
    f32::kBvhCastsNoShadow; ///< shadow rays pass through
inline constexpr std::uint32_t kStandsForSphereFlag =
    f32::kBvhStandsForSphere; ///< stands for an exact sphere
/// Rays that skip this flag hit the triangle from the front only.
inline constexpr std::uint32_t kOneSidedFlag = f32::kBvhOneSided;
/// Flag of triangles that alpha masks may cut out in part.
inline constexpr std::uint32_t kAlphaMaskedFlag = f32::kBvhAlphaMasked;
/// Flag of glass that shadow rays pass, and that attenuates their light.
inline constexpr std::uint32_t kTintsShadowFlag = f32::kBvhTintsShadow;
/// A sphere in place of a triangle: see `make_sphere`.
inline constexpr std::uint32_t kSpherePrimitiveFlag = f32::kBvhSpherePrimitive;
inline constexpr std::uint32_t kMaxTreeDepth = f32::kBvhMaxDepth;
inline constexpr std::uint32_t kMaxLeafTriangles = 4;
/// The most kCastsNoShadowFlag triangles that get a subtree of their own.
inline constexpr std::size_t kMaxShadowless = 256;

/// Returns a sphere that takes the place of a triangle. Only walks with TRACE_BALLS set
/// (shaders/lib/trace.glsl) can intersect spheres.
inline Triangle make_sphere(const vec3& centre, float radius, std::uint32_t object,
                            std::uint32_t flags) {
    return {centre, vec3(radius, 0, 0), vec3(0), object, flags | kSpherePrimitiveFlag};
}

/// The two arrays of a hierarchy, in the layout that the device reads.
///
/// `nodes` has four vec4 a node. Each w holds the bits of a word (see below):
///   node 0, the header:  lo.xyz of the core, number of kept triangles
///                        hi.xyz of the core, number of nodes including the header
///                        a vec4 of zeros (see tlas.hpp)
///                        words at which walks begin (see below), 0, 0
///   node 1, the root, and all other nodes hold the boxes of their two children:
///                        lo.xyz of child 0, word of child 0
///                        hi.xyz of child 0, word of child 1
///                        lo.xyz of child 1, 0
///                        hi.xyz of child 1, 0
///   An absent child has the empty box (lo = +inf, hi = -inf) and the word kBvhEmptyChild.
///
/// `triangles` has three vec4 a triangle, in the order of the leaves:
///                        a.xyz, object index               (of a sphere: its centre)
///                        b.xyz, original triangle number   (of a sphere: its radius, 0, 0)
///                        c.xyz, flags
///
/// Words. Bit 31 is clear, bit 30 is set, and bits 27 to 29 are never all set. Read
/// as a float, a word is therefore never denormal, infinite or NaN, and no device changes its bits.
/// A child's word holds its triangle count in bits 27..29 and the place of its first triangle in
/// bits 0..26. Count 0 means an inner node, whose place is in bits 0..26 (0: no child). All other
/// words hold their number in bits 0..28.
///
/// Walks begin at the first word of the header. If there are triangles that cast no shadow, but at
/// most kMaxShadowless, the first word is the root's first child, with all triangles that cast
/// shadows, and the second word is the root's other child. Shadow rays walk the first child alone.
/// Other rays walk it before the second child. Otherwise the first word is the root, and the second
/// word is kBvhEmptyChild.
struct Bvh {
    std::vector<vec4> nodes;
    std::vector<vec4> triangles;
    std::size_t dropped = 0; ///< triangles left out because a coordinate is not finite
    std::size_t copies = 0; ///< triangles left out as copies of one with a lower number (see build)
    /// Node of the first instance's record (bvh/tlas.hpp); 0: no instances. The record of instance
    /// i begins kBvhNodesPerInstance * i nodes later.
    std::uint32_t first_record = 0;
    double cost = 0; ///< result of `sah_cost`; `refit` updates it incrementally
};

/// Builds a hierarchy with the binned surface area heuristic. Where a path would grow deeper than
/// kMaxTreeDepth, halves the triangles by number instead. The same input always gives the same
/// tree.
///
/// Copies: if more than kMaxLeafTriangles triangles share a centre, those with equal corners,
/// object and flags count as one. The copy with the lowest number stays. Without this rule, walks
/// past thousands of copies would take too long.
///
/// Costs O(n log^2 n) for any input: .4 s on one thread for a million triangles.
///
/// `core`: the bounds of most of the scene; empty: of all of it. The walk widens all boxes by
/// roundings of that size. The boxes of triangles farther out are wider themselves. A single
/// distant triangle therefore does not slow down every ray.
/// `leaf`: the most triangles in a leaf, 1 to kMaxLeafTriangles.
/// `threads`: the most threads to use; 0: as many as the machine runs at once. The tree does not
/// depend on it.
/// Throws `Failure::exhausted` above 2^27 - 1 triangles.
Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core = {},
          std::uint32_t leaf = kMaxLeafTriangles, unsigned threads = 0);

/// A half-open range of indices: `first` is included, `end` is not.
struct IndexRange {
    std::size_t first = 0, end = 0;
    bool operator==(const IndexRange&) const = default;
};

/// The parts of a tree that a refit must visit when some objects move.
struct RefitRegion {
    std::vector<std::uint32_t> triangles; ///< places in the order of the leaves, ascending
    std::vector<std::uint32_t> boxes; ///< 2 * node + side; descendants come before their ancestors
};

/// Returns the triangles of the moving objects and the boxes that hold some of them. `objects`: by
/// object index, non-zero for an object that may move. Costs O(n).
RefitRegion find_refit_region(const Bvh& bvh, std::span<const char> objects);

/// Updates the boxes of a tree after its triangles have moved. The structure of the tree stays.
/// `triangles`: the list given to `build`, in the same order, with the new positions.
/// `reach`: the parts of all objects that may have moved; null: all objects may have moved.
/// Returns the range of Bvh::triangles that holds every changed element. A refitted tree and a
/// rebuilt tree give the same hits. Costs O(size of `reach`); refitting everything costs a tenth of
/// a build. Throws `Failure::internal` if a triangle that was finite no longer is.
IndexRange refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core = {},
                 const RefitRegion* reach = nullptr);

/// Returns the cost of traversing the tree that the surface area heuristic expects for a ray, times
/// the surface area of the whole tree. The value rises as triangles of a refitted tree move away
/// from their neighbours. Takes O(n).
double sah_cost(const Bvh& bvh);

/// Writes the two words of the tree's header that say at which nodes rays begin their traversal.
void write_start(Bvh& bvh, std::uint32_t casters, std::uint32_t others);

std::size_t count_nodes(const Bvh& bvh);     ///< including the header
std::size_t count_triangles(const Bvh& bvh); ///< number of triangles that the build kept

} // namespace catoptric::bvh
