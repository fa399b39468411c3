#include "skip_links.hpp"

#include "bvh/box.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace peers {

using namespace catoptric;

namespace {

constexpr float kSteps = 65535;

struct Writer {
    const bvh::Bvh& tree;
    SkipLinks& list;

    std::uint32_t planes(float lo, float hi, float lowest) const {
        const auto step = [&](float rounded) {
            return static_cast<std::uint32_t>(std::clamp(rounded, 0.0f, kSteps));
        };
        return step(std::floor((lo - lowest) * list.steps) - 1) |
               step(std::ceil((hi - lowest) * list.steps) + 1) << 16;
    }

    void add(std::uint32_t word, const bvh::BoundingBox& box) {
        const std::size_t node = list.nodes.size();
        vec4& texel = list.nodes.emplace_back();
        for (glm::length_t axis = 0; axis < 3; ++axis)
            texel[axis] = std::bit_cast<float>(
                planes(box.lo[axis], box.hi[axis], list.lowest[axis]));
        std::uint32_t link = 1u << 31 | f32::bvh_count(word) << 27 | f32::bvh_index(word);
        if (f32::bvh_is_inner(word)) {
            add_children(f32::bvh_index(word));
            link = static_cast<std::uint32_t>(list.nodes.size());
        }
        list.nodes[node].w = std::bit_cast<float>(link);
    }

    void add_children(std::uint32_t node) {
        const vec4* texel = &tree.nodes[4 * std::size_t{node}];
        for (int side = 0; side < 2; ++side)
            add(std::bit_cast<std::uint32_t>(texel[side].w),
                {vec3(texel[2 * side]), vec3(texel[2 * side + 1])});
    }
};

} // namespace

SkipLinks skip_links(const bvh::Bvh& tree) {
    SkipLinks list;
    bvh::BoundingBox all;
    for (int texel = 4; texel < 8; ++texel) all.add(vec3(tree.nodes[texel]));
    list.lowest = all.lo;
    list.steps = kSteps / f32::largest(all.extent());
    list.nodes.emplace_back();
    Writer{tree, list}.add_children(1);
    list.nodes.front().w = static_cast<float>(list.nodes.size());
    return list;
}

} // namespace peers
