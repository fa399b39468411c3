#include "skip_links.hpp"

#include "bvh/box.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace peers {

using namespace catoptric;

namespace {

constexpr float kBoxPlaneQuantisationSteps = 65535;

struct SkipLinkBvhWriter {
    const bvh::Bvh& tree;
    SkipLinkBvh& list;

    std::uint32_t pack_quantised_box_planes(float lo, float hi, float lowest) const {
        const auto step = [&](float rounded) {
            return static_cast<std::uint32_t>(
                std::clamp(rounded, 0.0f, kBoxPlaneQuantisationSteps));
        };
        return step(std::floor((lo - lowest) * list.steps) - 1) |
               step(std::ceil((hi - lowest) * list.steps) + 1) << 16;
    }

    void add_node(std::uint32_t word, const bvh::BoundingBox& box) {
        const std::size_t node = list.nodes.size();
        vec4& texel = list.nodes.emplace_back();
        for (glm::length_t axis = 0; axis < 3; ++axis)
            texel[axis] = std::bit_cast<float>(
                pack_quantised_box_planes(box.lo[axis], box.hi[axis], list.lowest[axis]));
        std::uint32_t link = 1u << 31 | f32::bvh_word_triangle_count(word) << 27 |
                             f32::bvh_word_index(word);
        if (f32::is_bvh_word_inner_node(word)) {
            append_skip_link_child_nodes(f32::bvh_word_index(word));
            link = static_cast<std::uint32_t>(list.nodes.size());
        }
        list.nodes[node].w = std::bit_cast<float>(link);
    }

    void append_skip_link_child_nodes(std::uint32_t node) {
        const vec4* texel = &tree.nodes[4 * std::size_t{node}];
        for (int side = 0; side < 2; ++side)
            add_node(std::bit_cast<std::uint32_t>(texel[side].w),
                     {vec3(texel[2 * side]), vec3(texel[2 * side + 1])});
    }
};

} // namespace

SkipLinkBvh convert_bvh_to_skip_links(const bvh::Bvh& tree) {
    SkipLinkBvh list;
    bvh::BoundingBox all;
    for (int texel = 4; texel < 8; ++texel) all.add(vec3(tree.nodes[texel]));
    list.lowest = all.lo;
    list.steps = kBoxPlaneQuantisationSteps / f32::largest_vector_component(all.extent());
    list.nodes.emplace_back();
    SkipLinkBvhWriter{tree, list}.append_skip_link_child_nodes(1);
    list.nodes.front().w = static_cast<float>(list.nodes.size());
    return list;
}

} // namespace peers
