#include "bvh/box.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"

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
        Box triangle = bounds_of(&bvh.triangles[3 * std::size_t{f32::bvh_index(child) + i}]);
        const float pad = pad_of(triangle, core);
        triangle.lo -= pad, triangle.hi += pad;
        box.add(triangle);
    }
    return box;
}

} // namespace

void refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core) {
    for (std::size_t i = 0; i < bvh.triangles.size(); i += 3) {
        const std::size_t number = number_of(bvh.triangles[i + 1].w);
        check(number < triangles.size() && is_finite(triangles[number]), Failure::internal,
              "a hierarchy is refitted to finite triangles, number ", number, " is none");
        const Triangle& t = triangles[number];
        const std::array corners{t.a, t.b, t.c};
        for (std::size_t k = 0; k < 3; ++k)
            bvh.triangles[i + k] = vec4(corners[k], bvh.triangles[i + k].w);
    }
    Box slack = core;
    if (slack.empty())
        for (std::size_t i = 0; i < bvh.triangles.size(); i += 3)
            slack.add(bounds_of(&bvh.triangles[i]));
    // A node comes before what is below it.
    for (std::size_t node = node_count(bvh); node-- > 1;) {
        vec4* texel = &bvh.nodes[4 * node];
        for (int side = 0; side < 2; ++side) {
            const Box box = child_bounds(bvh, bits(texel[side].w), slack);
            texel[2 * side] = vec4(box.lo, texel[2 * side].w);
            texel[2 * side + 1] = vec4(box.hi, texel[2 * side + 1].w);
        }
    }
    bvh.nodes[0] = vec4(slack.lo, bvh.nodes[0].w);
    bvh.nodes[1] = vec4(slack.hi, bvh.nodes[1].w);
}

double cost(const Bvh& bvh) {
    double sum = 0;
    for (std::size_t node = 1; node < node_count(bvh); ++node) {
        const vec4* texel = &bvh.nodes[4 * node];
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t child = bits(texel[side].w);
            const Box box{vec3(texel[2 * side]), vec3(texel[2 * side + 1])};
            sum += area(box) * (f32::bvh_is_inner(child)
                                    ? kTraversalCost
                                    : static_cast<double>(f32::bvh_count(child)));
        }
    }
    return sum;
}

} // namespace catoptric::bvh
