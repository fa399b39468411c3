#pragma once

#include "render/geometry.hpp"

#include <functional>
#include <optional>
#include <span>

namespace catoptric::render {

/// Boxes in a tree that is made once and follows them as they move.
class BoxTree {
public:
    BoxTree() = default;
    /// At most `leaf` boxes, at least 1, in what is not split further.
    explicit BoxTree(std::span<const Bounds<float>> boxes, std::uint32_t leaf = 4);
    /// The same boxes elsewhere. O(n).
    void refit(std::span<const Bounds<float>> boxes);
    /// Calls visit(box) for all boxes that may hold a point nearer to `point` than the root of
    /// `squared`, which visit lowers.
    template <typename Visit>
    void nearest(const vec3& point, const float& squared, Visit&& visit) const;

    /// A node of a walk without a stack: what the ray does not meet is left by going on at `past`.
    struct Step {
        Bounds<float> box;
        std::uint32_t past = 0;            ///< the node after all that is below this one
        std::optional<std::uint32_t> only; ///< its box, where it has just one
    };
    /// All nodes, parents before their children.
    std::vector<Step> steps() const;

private:
    struct Node {
        Bounds<float> box;
        std::uint32_t first = 0, count = 0; ///< of a leaf, in `order_`
        std::uint32_t second = 0;           ///< the other child; one is the next node
    };
    void add(std::span<const Bounds<float>> boxes, std::uint32_t first, std::uint32_t count);

    std::uint32_t leaf_ = 0;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_; ///< children after their parents
};

/// How near the nearest triangle of a scene is. Trees over objects and, from the first question
/// that comes near an object on, over its triangles: O(log n) a question, not over all triangles.
class Nearest {
public:
    /// Of a geometry laid out anew.
    void lay_out(const Geometry& geometry);
    /// The object's triangles have moved.
    void move(std::size_t object);

    /// Distance from a point to the nearest triangle, scene units: what looking at all of them
    /// finds. Objects where `skip(index, range)` are left out; infinity when nothing is left.
    /// An object in a shared mesh's space counts as at least as near as it is.
    float distance(const Geometry& geometry, const dvec3& point,
                   const std::function<bool(std::size_t, const DrawRange&)>& skip);

private:
    struct Part {
        std::optional<BoxTree> tree;
        bool moved = false;
    };
    void look_at(const Geometry& geometry, std::size_t object, const vec3& point, float& squared);
    void look_at_own(const Geometry& geometry, std::size_t object, const dvec3& point,
                     float& squared);

    BoxTree objects_;
    bool moved_ = false;
    std::vector<Part> parts_; ///< by object
};

/// A lower bound of the distance from the point to anything in the box, also as squared_distance
/// rounds it.
float gap_below(const vec3& point, const Bounds<float>& box);

template <typename Visit>
void BoxTree::nearest(const vec3& point, const float& squared, Visit&& visit) const {
    const auto may_be_nearer = [&](std::uint32_t node) {
        const float gap = gap_below(point, nodes_[node].box);
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
        const bool swap = gap_below(point, nodes_[node.second].box) <
                          gap_below(point, nodes_[place + 1].box);
        waiting.push_back(swap ? place + 1 : node.second);
        waiting.push_back(swap ? node.second : place + 1);
    }
}

} // namespace catoptric::render
