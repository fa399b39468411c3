#include "bvh/box.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <array>

namespace catoptric::bvh {

namespace {

BoundingBox stored_bounds(const vec4* stored) {
    return triangle_bounds(vec3(stored[0]), vec3(stored[1]), vec3(stored[2]),
                           unpack_number(stored[2].w));
}

/// Returns the bounds of a child, from the corners and nodes below it.
BoundingBox child_bounds(const Bvh& bvh, std::uint32_t child, const BoundingBox& core) {
    BoundingBox box;
    if (f32::is_bvh_word_inner_node(child)) {
        const vec4* node = &bvh.nodes[4 * std::size_t{f32::bvh_word_index(child)}];
        for (int side = 0; side < 2; ++side)
            box.add(BoundingBox{vec3(node[2 * side]), vec3(node[2 * side + 1])});
        return box;
    }
    for (std::uint32_t i = 0; i < f32::bvh_word_triangle_count(child); ++i) {
        const BoundingBox triangle = stored_bounds(
            &bvh.triangles[3 * std::size_t{f32::bvh_word_index(child) + i}]);
        box.add(expand(triangle, box_padding(triangle, core)));
    }
    return box;
}

/// Returns the cost of one child. The cost of a node is the sum over its two children.
double child_cost(std::uint32_t child, const BoundingBox& box) {
    return surface_area(box) * (f32::is_bvh_word_inner_node(child)
                                    ? kNodeVisitCost
                                    : static_cast<double>(f32::bvh_word_triangle_count(child)));
}

/// 0 and -0 count as different.
bool have_same_bits(const vec3& a, const vec3& b) {
    return float_to_bits(a.x) == float_to_bits(b.x) && float_to_bits(a.y) == float_to_bits(b.y) &&
           float_to_bits(a.z) == float_to_bits(b.z);
}

/// Writes the new corners of the triangle at `place`, in the order of the leaves. Returns whether
/// they changed.
bool write_triangle(Bvh& bvh, std::size_t place, std::span<const Triangle> triangles) {
    vec4* texel = &bvh.triangles[3 * place];
    const std::size_t number = unpack_number(texel[1].w);
    check(number < triangles.size(), Failure::internal, "refit of a BVH: wanted numbers below ",
          triangles.size(), ", found triangle ", number);
    const Triangle& t = triangles[number];
    const std::array corners{t.a, t.b, t.c};
    bool moved = false;
    for (std::size_t k = 0; k < 3; ++k) {
        if (have_same_bits(vec3(texel[k]), corners[k])) continue;
        texel[k] = vec4(corners[k], texel[k].w);
        moved = true;
    }
    check(!moved || is_finite(t), Failure::internal,
          "refit of a BVH: wanted finite coordinates, triangle ", number, " has others");
    return moved;
}

void refit_box(Bvh& bvh, std::uint32_t place, const BoundingBox& slack) {
    vec4* texel = &bvh.nodes[4 * std::size_t{place / 2}];
    vec4 &lo = texel[2 * (place % 2)], &hi = texel[2 * (place % 2) + 1];
    const std::uint32_t child = float_to_bits(texel[place % 2].w);
    const BoundingBox box = child_bounds(bvh, child, slack);
    bvh.cost += child_cost(child, box) - child_cost(child, {vec3(lo), vec3(hi)});
    lo = vec4(box.lo, lo.w);
    hi = vec4(box.hi, hi.w);
}

} // namespace

RefitRegion find_refit_region(const Bvh& bvh, std::span<const char> objects) {
    RefitRegion reach;
    std::vector<char> moves(count_triangles(bvh)), holds(count_nodes(bvh));
    for (std::uint32_t place = 0; place < moves.size(); ++place) {
        if (!objects[unpack_number(bvh.triangles[3 * std::size_t{place}].w)]) continue;
        moves[place] = 1;
        reach.triangles.push_back(place);
    }
    const auto is_reached = [&](std::uint32_t child) {
        if (f32::is_bvh_word_inner_node(child)) return holds[f32::bvh_word_index(child)] != 0;
        const auto first = moves.begin() + f32::bvh_word_index(child);
        return std::any_of(first, first + f32::bvh_word_triangle_count(child),
                           [](char c) { return c != 0; });
    };
    // Nodes precede their descendants, so the loop runs backwards.
    for (auto node = static_cast<std::uint32_t>(count_nodes(bvh)); node-- > 1;) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            if (!is_reached(float_to_bits(bvh.nodes[4 * std::size_t{node} + side].w))) continue;
            reach.boxes.push_back(2 * node + side);
            holds[node] = 1;
        }
    }
    return reach;
}

IndexRange refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core,
                 const RefitRegion* reach) {
    IndexRange run;
    const auto move_one = [&](std::size_t place) {
        if (write_triangle(bvh, place, triangles))
            run = {run.end == 0 ? 3 * place : run.first, 3 * place + 3};
    };
    if (reach)
        std::ranges::for_each(reach->triangles, move_one);
    else
        for (std::size_t place = 0; place < count_triangles(bvh); ++place) move_one(place);
    BoundingBox slack = core;
    if (slack.empty())
        for (std::size_t i = 0; i < bvh.triangles.size(); i += 3)
            slack.add(stored_bounds(&bvh.triangles[i]));
    // The padding of far triangles depends on the core, so a new core changes every box.
    if (reach && vec3(bvh.nodes[0]) == slack.lo && vec3(bvh.nodes[1]) == slack.hi)
        for (const std::uint32_t place : reach->boxes) refit_box(bvh, place, slack);
    else
        for (auto place = 2 * static_cast<std::uint32_t>(count_nodes(bvh)); place-- > 2;)
            refit_box(bvh, place, slack);
    bvh.nodes[0] = vec4(slack.lo, bvh.nodes[0].w);
    bvh.nodes[1] = vec4(slack.hi, bvh.nodes[1].w);
    return run;
}

double sah_cost(const Bvh& bvh) {
    double sum = 0;
    for (std::size_t node = 1; node < count_nodes(bvh); ++node) {
        const vec4* texel = &bvh.nodes[4 * node];
        for (int side = 0; side < 2; ++side) {
            sum += child_cost(float_to_bits(texel[side].w),
                              {vec3(texel[2 * side]), vec3(texel[2 * side + 1])});
        }
    }
    return sum;
}

} // namespace catoptric::bvh
