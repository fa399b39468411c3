#include "embree_tree.hpp"

#include "bvh/box.hpp"

#include <embree3/rtcore_builder.h>

#include <vector>

namespace peers {

using namespace catoptric;
using bvh::BoundingBox;

namespace {

constexpr unsigned kMaxEmbreeTreeDepth = 48; // greatest tree depth that Embree's builder accepts
constexpr std::size_t kMaxSplitPrimitivesPerTriangle =
    2; // most primitives per triangle after splits

struct EmbreeTreeNode {
    std::size_t triangles = 0; ///< number of triangles of a leaf; 0: an inner node
    BoundingBox boxes[2];
    EmbreeTreeNode* children[2] = {};
};

double compute_bvh_node_sah_cost(const EmbreeTreeNode& node) {
    double sum = 0;
    for (int side = 0; side < 2; ++side) {
        const EmbreeTreeNode& child = *node.children[side];
        const bool is_leaf = child.triangles > 0;
        sum += bvh::surface_area(node.boxes[side]) *
                   (is_leaf ? static_cast<double>(child.triangles) : bvh::kNodeVisitCost) +
               (is_leaf ? 0 : compute_bvh_node_sah_cost(child));
    }
    return sum;
}

BoundingBox embree_bounds_to_bounding_box(const RTCBounds& bounds) {
    return {{bounds.lower_x, bounds.lower_y, bounds.lower_z},
            {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
}

RTCBounds bounding_box_to_embree_bounds(const BoundingBox& box) {
    return {box.lo.x, box.lo.y, box.lo.z, 0, box.hi.x, box.hi.y, box.hi.z, 0};
}

EmbreeTreeNode* allocate_embree_bvh_node(RTCThreadLocalAllocator allocator) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(EmbreeTreeNode), alignof(EmbreeTreeNode)))
        EmbreeTreeNode;
}

/// Splits a primitive at a plane: computes the boxes of the triangle's parts on both sides of the
/// plane, clipped to the primitive's box.
void split_primitive_at_plane(const RTCBuildPrimitive* primitive, unsigned axis_number, float place,
                              RTCBounds* left, RTCBounds* right, void* triangles) {
    const auto axis = static_cast<glm::length_t>(axis_number);
    const bvh::Triangle& t = static_cast<const bvh::Triangle*>(triangles)[primitive->primID];
    const vec3 corners[] = {t.a, t.b, t.c};
    BoundingBox sides[2];
    for (int i = 0; i < 3; ++i) {
        const vec3 from = corners[i], to = corners[(i + 1) % 3];
        if (from[axis] <= place) sides[0].add(from);
        if (from[axis] >= place) sides[1].add(from);
        if ((from[axis] < place) == (to[axis] < place)) continue;
        vec3 between = from + (to - from) * ((place - from[axis]) / (to[axis] - from[axis]));
        between[axis] = place;
        sides[0].add(between), sides[1].add(between);
    }
    const vec3 lo(primitive->lower_x, primitive->lower_y, primitive->lower_z),
        hi(primitive->upper_x, primitive->upper_y, primitive->upper_z);
    for (BoundingBox& side : sides) side = {max(side.lo, lo), min(side.hi, hi)};
    *left = bounding_box_to_embree_bounds(sides[0]),
    *right = bounding_box_to_embree_bounds(sides[1]);
}

void set_embree_bvh_build_arguments(RTCBuildArguments& arguments) {
    arguments.maxDepth = kMaxEmbreeTreeDepth;
    arguments.maxLeafSize = bvh::kMaxLeafTriangles;
    arguments.traversalCost = static_cast<float>(bvh::kNodeVisitCost);
    arguments.createNode = [](RTCThreadLocalAllocator allocator, unsigned, void*) -> void* {
        return allocate_embree_bvh_node(allocator);
    };
    arguments.setNodeChildren = [](void* node, void** children, unsigned, void*) {
        for (int side = 0; side < 2; ++side)
            static_cast<EmbreeTreeNode*>(node)->children[side] = static_cast<EmbreeTreeNode*>(
                children[side]);
    };
    arguments.setNodeBounds = [](void* node, const RTCBounds** bounds, unsigned, void*) {
        for (int side = 0; side < 2; ++side)
            static_cast<EmbreeTreeNode*>(node)->boxes[side] = embree_bounds_to_bounding_box(
                *bounds[side]);
    };
    arguments.createLeaf = [](RTCThreadLocalAllocator allocator, const RTCBuildPrimitive*,
                              std::size_t count, void*) -> void* {
        EmbreeTreeNode* const leaf = allocate_embree_bvh_node(allocator);
        leaf->triangles = count;
        return leaf;
    };
    arguments.splitPrimitive = split_primitive_at_plane;
}

} // namespace

double compute_embree_bvh_sah_cost(const EmbreeDevice& device,
                                   std::span<const bvh::Triangle> triangles,
                                   RTCBuildQuality quality) {
    std::vector<RTCBuildPrimitive> primitives(kMaxSplitPrimitivesPerTriangle * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const bvh::Triangle& t = triangles[i];
        const BoundingBox box = bvh::triangle_bounds(t.a, t.b, t.c, t.flags);
        primitives[i] = {box.lo.x, box.lo.y, box.lo.z, 0,
                         box.hi.x, box.hi.y, box.hi.z, static_cast<unsigned>(i)};
    }
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    set_embree_bvh_build_arguments(arguments);
    arguments.buildQuality = quality;
    arguments.bvh = rtcNewBVH(device.embree_device_handle());
    arguments.primitives = primitives.data();
    arguments.primitiveCount = triangles.size();
    arguments.primitiveArrayCapacity = primitives.size();
    // Only `split_primitive_at_plane` reads the triangles.
    arguments.userPtr = const_cast<bvh::Triangle*>(triangles.data());
    const auto* root = static_cast<const EmbreeTreeNode*>(rtcBuildBVH(&arguments));
    device.throw_on_embree_error();
    // A root that is a leaf needs no walk.
    const double cost = root->triangles > 0 ? 0 : compute_bvh_node_sah_cost(*root);
    rtcReleaseBVH(arguments.bvh);
    return cost;
}

} // namespace peers
