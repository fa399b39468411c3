#include "bvh/box.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <array>

namespace catoptric::bvh {

namespace {

BoundingBox bounds_of(const vec4* stored) {
    return box_of(vec3(stored[0]), vec3(stored[1]), vec3(stored[2]), number_of(stored[2].w));
}

/// Returns the bounds of a child, from the corners and nodes below it.
BoundingBox child_bounds(const Bvh& bvh, std::uint32_t child, const BoundingBox& core) {
    BoundingBox box;
    if (f32::bvh_is_inner(child)) {
        const vec4* node = &bvh.nodes[4 * std::size_t{f32::bvh_index(child)}];
        for (int side = 0; side < 2; ++side)
            box.add(BoundingBox{vec3(node[2 * side]), vec3(node[2 * side + 1])});
        return box;
    }
    for (std::uint32_t i = 0; i < f32::bvh_count(child); ++i) {
        const BoundingBox triangle = bounds_of(
            &bvh.triangles[3 * std::size_t{f32::bvh_index(child) + i}]);
        box.add(padded(triangle, pad_of(triangle, core)));
    }
    return box;
}

/// Returns the cost of one child. The cost of a node is the sum over its two children.
double cost_of_child(std::uint32_t child, const BoundingBox& box) {
    return area(box) *
           (f32::bvh_is_inner(child) ? kTraversalCost : static_cast<double>(f32::bvh_count(child)));
}

/// Compares bits, because 0 and -0 count as different here.
bool same_bits(const vec3& a, const vec3& b) {
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

/// Writes the new corners of the triangle at `place`, in the order of the leaves. Returns whether
/// they changed.
bool move(Bvh& bvh, std::size_t place, std::span<const Triangle> triangles) {
    vec4* texel = &bvh.triangles[3 * place];
    const std::size_t number = number_of(texel[1].w);
    check(number < triangles.size(), Failure::internal, "a hierarchy of ", triangles.size(),
          " triangles is refitted to number ", number);
    const Triangle& t = triangles[number];
    const std::array corners{t.a, t.b, t.c};
    bool moved = false;
    for (std::size_t k = 0; k < 3; ++k) {
        if (same_bits(vec3(texel[k]), corners[k])) continue;
        texel[k] = vec4(corners[k], texel[k].w);
        moved = true;
    }
    check(!moved || is_finite(t), Failure::internal,
          "a hierarchy is refitted to finite triangles, number ", number, " is none");
    return moved;
}

void move_box(Bvh& bvh, std::uint32_t place, const BoundingBox& slack) {
    vec4* texel = &bvh.nodes[4 * std::size_t{place / 2}];
    vec4 &lo = texel[2 * (place % 2)], &hi = texel[2 * (place % 2) + 1];
    const std::uint32_t child = bits(texel[place % 2].w);
    const BoundingBox box = child_bounds(bvh, child, slack);
    bvh.cost += cost_of_child(child, box) - cost_of_child(child, {vec3(lo), vec3(hi)});
    lo = vec4(box.lo, lo.w);
    hi = vec4(box.hi, hi.w);
}

} // namespace

Reach reach_of(const Bvh& bvh, std::span<const char> objects) {
    Reach reach;
    std::vector<char> moves(triangle_count(bvh)), holds(node_count(bvh));
    for (std::uint32_t place = 0; place < moves.size(); ++place) {
        if (!objects[number_of(bvh.triangles[3 * std::size_t{place}].w)]) continue;
        moves[place] = 1;
        reach.triangles.push_back(place);
    }
    const auto is_reached = [&](std::uint32_t child) {
        if (f32::bvh_is_inner(child)) return holds[f32::bvh_index(child)] != 0;
        const auto first = moves.begin() + f32::bvh_index(child);
        return std::any_of(first, first + f32::bvh_count(child), [](char c) { return c != 0; });
    };
    // Nodes precede their descendants, so the loop runs backwards.
    for (auto node = static_cast<std::uint32_t>(node_count(bvh)); node-- > 1;) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            if (!is_reached(bits(bvh.nodes[4 * std::size_t{node} + side].w))) continue;
            reach.boxes.push_back(2 * node + side);
            holds[node] = 1;
        }
    }
    return reach;
}

IndexRange refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core,
                 const Reach* reach) {
    IndexRange run;
    const auto move_one = [&](std::size_t place) {
        if (move(bvh, place, triangles))
            run = {run.end == 0 ? 3 * place : run.first, 3 * place + 3};
    };
    if (reach)
        std::ranges::for_each(reach->triangles, move_one);
    else
        for (std::size_t place = 0; place < triangle_count(bvh); ++place) move_one(place);
    BoundingBox slack = core;
    if (slack.empty())
        for (std::size_t i = 0; i < bvh.triangles.size(); i += 3)
            slack.add(bounds_of(&bvh.triangles[i]));
    // The padding of far triangles depends on the core, so a new core changes every box.
    if (reach && vec3(bvh.nodes[0]) == slack.lo && vec3(bvh.nodes[1]) == slack.hi)
        for (const std::uint32_t place : reach->boxes) move_box(bvh, place, slack);
    else
        for (auto place = 2 * static_cast<std::uint32_t>(node_count(bvh)); place-- > 2;)
            move_box(bvh, place, slack);
    bvh.nodes[0] = vec4(slack.lo, bvh.nodes[0].w);
    bvh.nodes[1] = vec4(slack.hi, bvh.nodes[1].w);
    return run;
}

double cost(const Bvh& bvh) {
    double sum = 0;
    for (std::size_t node = 1; node < node_count(bvh); ++node) {
        const vec4* texel = &bvh.nodes[4 * node];
        for (int side = 0; side < 2; ++side) {
            sum += cost_of_child(bits(texel[side].w),
                                 {vec3(texel[2 * side]), vec3(texel[2 * side + 1])});
        }
    }
    return sum;
}

} // namespace catoptric::bvh
