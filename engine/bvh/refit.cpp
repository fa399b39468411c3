#include "bvh/box.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <array>

namespace catoptric::bvh {

namespace {

Box bounds_of(const vec4* stored) {
    return box_of(vec3(stored[0]), vec3(stored[1]), vec3(stored[2]), number_of(stored[2].w));
}

/// Box of what a child's word stands for, from corners and nodes below it.
Box child_bounds(const Bvh& bvh, std::uint32_t child, const Box& core) {
    Box box;
    if (f32::bvh_is_inner(child)) {
        const vec4* node = &bvh.nodes[4 * std::size_t{f32::bvh_index(child)}];
        for (int side = 0; side < 2; ++side)
            box.add(Box{vec3(node[2 * side]), vec3(node[2 * side + 1])});
        return box;
    }
    for (std::uint32_t i = 0; i < f32::bvh_count(child); ++i) {
        const Box triangle = bounds_of(&bvh.triangles[3 * std::size_t{f32::bvh_index(child) + i}]);
        box.add(padded(triangle, pad_of(triangle, core)));
    }
    return box;
}

/// Of one child: a node's two add up.
double cost_of_child(std::uint32_t child, const Box& box) {
    return area(box) *
           (f32::bvh_is_inner(child) ? kTraversalCost : static_cast<double>(f32::bvh_count(child)));
}

/// A zero that changes its sign is another.
bool same_bits(const vec3& a, const vec3& b) {
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

/// Puts the triangle at `place`, in the order of the leaves, where it is now. Whether it stood
/// elsewhere.
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

/// Boxes of children that hold something that moved; of all, where `all`.
void move_boxes(Bvh& bvh, const std::vector<char>& moved, const Box& slack, bool all) {
    std::vector<char> changed(node_count(bvh));
    const auto has_changed = [&](std::uint32_t child) {
        if (f32::bvh_is_inner(child)) return changed[f32::bvh_index(child)] != 0;
        const auto first = moved.begin() + f32::bvh_index(child);
        return std::any_of(first, first + f32::bvh_count(child), [](char c) { return c != 0; });
    };
    // A node comes before what is below it.
    for (std::size_t node = node_count(bvh); node-- > 1;) {
        vec4* texel = &bvh.nodes[4 * node];
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t child = bits(texel[side].w);
            if (!all && !has_changed(child)) continue;
            const Box box = child_bounds(bvh, child, slack);
            bvh.cost += cost_of_child(child, box) -
                        cost_of_child(child, {vec3(texel[2 * side]), vec3(texel[2 * side + 1])});
            texel[2 * side] = vec4(box.lo, texel[2 * side].w);
            texel[2 * side + 1] = vec4(box.hi, texel[2 * side + 1].w);
            changed[node] = 1;
        }
    }
}

} // namespace

Run refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core,
          std::span<const char> objects) {
    std::vector<char> moved(triangle_count(bvh));
    Run run;
    for (std::size_t place = 0; place < moved.size(); ++place) {
        if (!objects.empty() && !objects[number_of(bvh.triangles[3 * place].w)]) continue;
        if (!move(bvh, place, triangles)) continue;
        moved[place] = 1;
        run = {run.end == 0 ? 3 * place : run.first, 3 * place + 3};
    }
    Box slack = core;
    if (slack.empty())
        for (std::size_t i = 0; i < bvh.triangles.size(); i += 3)
            slack.add(bounds_of(&bvh.triangles[i]));
    move_boxes(bvh, moved, slack, vec3(bvh.nodes[0]) != slack.lo || vec3(bvh.nodes[1]) != slack.hi);
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
