#pragma once

#include "render/geometry.hpp"

#include <functional>
#include <optional>
#include <span>

namespace catoptric::render {

/// A tree over boxes, built once and refitted when the boxes move.
class BoxTree {
public:
    BoxTree() = default;
    /// Builds a tree with at most `leaf` boxes, at least 1, in each leaf.
    explicit BoxTree(std::span<const Bounds<float>> boxes, std::uint32_t leaf = 4);
    /// Updates the tree for moved boxes. Costs O(n).
    void refit(std::span<const Bounds<float>> boxes);
    /// Calls visit(box) for every box that may hold a point nearer to `point` than
    /// sqrt(`squared`). `visit` lowers `squared`.
    template <typename Visit>
    void find_nearest(const vec3& point, const float& squared, Visit&& visit) const;

    /// A node of a tree that is traversed without a stack. If the ray misses the node's box,
    /// traversal continues at node `past`.
    struct Step {
        Bounds<float> box;
        std::uint32_t past = 0;            ///< the node after the whole subtree
        std::optional<std::uint32_t> only; ///< index of the box, if the node holds a single one
    };
    /// Returns all nodes, parents before their children.
    std::vector<Step> traversal() const;

private:
    struct Node {
        Bounds<float> box;
        std::uint32_t first = 0, count = 0; ///< range of a leaf in `order_`
        std::uint32_t second = 0;           ///< the second child; the first child is the next node
    };
    void add_boxes(std::span<const Bounds<float>> boxes, std::uint32_t first, std::uint32_t count);

    std::uint32_t max_boxes_per_leaf_ = 0;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_; ///< children after their parents
};

/// Distance queries to the nearest triangle of a scene. Keeps a tree over objects. Builds a tree
/// over an object's triangles at the first query that comes near the object. A query costs O(log
/// n).
class NearestTriangle {
public:
    /// Prepares for a new geometry layout.
    void set_geometry(const FrameGeometry& geometry);
    void record_move(std::size_t object);

    /// Returns the distance from a point to the nearest triangle, scene units. The result equals
    /// that of testing all triangles. Leaves out objects for which `skip(index, range)` holds.
    /// Returns infinity if none is left. For an object with an object space, the distance is a
    /// lower bound.
    float distance(const FrameGeometry& geometry, const dvec3& point,
                   const std::function<bool(std::size_t, const DrawRange&)>& skip);

private:
    struct ObjectTree {
        std::optional<BoxTree> tree;
        bool moved = false;
    };
    void visit_triangles(const FrameGeometry& geometry, std::size_t object, const vec3& point,
                         float& squared);
    void visit_in_object_space(const FrameGeometry& geometry, std::size_t object,
                               const dvec3& point, float& squared);

    BoxTree objects_;
    bool moved_ = false;
    std::vector<ObjectTree> parts_; ///< tree of each object
};

/// Returns a lower bound of the distance from the point to the box. The bound also holds for the
/// rounded result of squared_distance.
float min_distance(const vec3& point, const Bounds<float>& box);

template <typename Visit>
void BoxTree::find_nearest(const vec3& point, const float& squared, Visit&& visit) const {
    const auto may_be_nearer = [&](std::uint32_t node) {
        const float gap = min_distance(point, nodes_[node].box);
        return !(gap * gap >= squared);
    };
    std::vector<std::uint32_t> waiting;
    if (!nodes_.empty()) waiting.push_back(0);
    while (!waiting.empty()) {
        const std::uint32_t place = waiting.back();
        waiting.pop_back();
        if (!may_be_nearer(place)) continue;
        const Node& node = nodes_[place];
        for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
        if (node.count > 0) continue;
        const bool swap = min_distance(point, nodes_[node.second].box) <
                          min_distance(point, nodes_[place + 1].box);
        waiting.push_back(swap ? place + 1 : node.second);
        waiting.push_back(swap ? node.second : place + 1);
    }
}

} // namespace catoptric::render
