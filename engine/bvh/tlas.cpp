#include "bvh/tlas.hpp"

#include "bvh/box.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace catoptric::bvh {

namespace {

constexpr double kBoxRoundingError = 0x1p-22; // relative error of a box that becomes float

BoundingBox stored_core(const Bvh& tree) { return {vec3(tree.nodes[0]), vec3(tree.nodes[1])}; }

/// Returns the bounds of everything below a node.
BoundingBox node_bounds(const Bvh& bvh, std::size_t node) {
    BoundingBox box;
    for (std::size_t side = 0; side < 2; ++side)
        box.add(BoundingBox{vec3(bvh.nodes[4 * node + 2 * side]),
                            vec3(bvh.nodes[4 * node + 2 * side + 1])});
    return box;
}

/// Appends a tree without its header. Returns the word of its root.
std::uint32_t append_tree(Bvh& into, const Bvh& part) {
    const auto nodes = static_cast<std::uint32_t>(count_nodes(into) - 1),
               triangles = static_cast<std::uint32_t>(count_triangles(into));
    for (std::size_t node = 1; node < count_nodes(part); ++node)
        for (std::size_t k = 0; k < 4; ++k) {
            vec4 texel = part.nodes[4 * node + k];
            const std::uint32_t child = float_to_bits(texel.w);
            if (k < 2 && child != f32::kBvhEmptyChild)
                texel.w = std::bit_cast<float>(
                    child + (f32::is_bvh_word_inner_node(child) ? nodes : triangles));
            into.nodes.push_back(texel);
        }
    into.triangles.insert(into.triangles.end(), part.triangles.begin(), part.triangles.end());
    into.dropped += part.dropped, into.copies += part.copies;
    return f32::kBvhNormalFloatBit | (nodes + 1);
}

void add_record(Bvh& bvh, const BvhInstance& instance, std::uint32_t root) {
    const dmat3 own_from_scene = glm::inverse(instance.scene_from_own);
    const vec3 centre(instance.centre);
    const auto row = [&](int i) {
        return vec3(own_from_scene[0][i], own_from_scene[1][i], own_from_scene[2][i]);
    };
    const BoundingBox own = stored_core(*instance.tree);
    const std::array<vec4, 4 * f32::kBvhNodesPerInstance> texels{
        vec4(row(0), std::bit_cast<float>(root)),
        vec4(row(1), pack_word(instance.object)),
        vec4(row(2), pack_word(instance.shift)),
        vec4(centre, pack_word(instance.flags)),
        vec4(vec3(instance.scene_from_own[0]), 0),
        vec4(vec3(instance.scene_from_own[1]), 0),
        vec4(vec3(instance.scene_from_own[2]), 0),
        vec4(float_rounding_error(instance.centre), 0),
        vec4(own.lo, 0),
        vec4(own.hi, instance.radius)};
    bvh.nodes.insert(bvh.nodes.end(), texels.begin(), texels.end());
}

/// Returns the bounds of the instance in scene units, padded for rounding to float. The bounds
/// include the exact sphere, if the instance has one.
BoundingBox instance_bounds(const BvhInstance& instance) {
    BoundingBox own = stored_core(*instance.tree);
    if (instance.radius > 0) own.add(BoundingBox{vec3(-instance.radius), vec3(instance.radius)});
    Bounds<double> box;
    for (int corner = 0; corner < 8; ++corner)
        box.add(instance.centre +
                instance.scene_from_own * dvec3((corner & 1 ? own.lo : own.hi).x,
                                                (corner & 2 ? own.lo : own.hi).y,
                                                (corner & 4 ? own.lo : own.hi).z));
    const dvec3 pad = kBoxRoundingError * glm::max(glm::abs(box.lo), glm::abs(box.hi));
    return {vec3(box.lo - pad), vec3(box.hi + pad)};
}

/// Builds the tree over the instances' boxes, one in each leaf. Each leaf word refers to a record.
Bvh build_instance_tree(std::span<const BvhInstance> instances, const BoundingBox& core,
                        double times, std::uint32_t first_record) {
    std::vector<Triangle> boxes;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        BoundingBox box = instance_bounds(instances[i]);
        const vec3 beyond = max(max(core.lo - box.lo, box.hi - core.hi), vec3(0));
        const vec3 size = max(abs(box.lo), abs(box.hi));
        if (f32::largest_vector_component(beyond) > 0) { // outside the slack by which traversal
                                                         // widens boxes
            const float pad = static_cast<float>(times) * 2 * f32::rounding_error_gamma_bound(16) *
                              f32::largest_vector_component(size + core.extent());
            box.lo -= pad, box.hi += pad;
        }
        boxes.push_back({box.lo, box.hi, box.hi, static_cast<std::uint32_t>(i), 0});
    }
    Bvh top = build(boxes, core, 1);
    check(top.dropped == 0, Failure::exhausted, "an instance has bounds that are not finite");
    for (std::size_t node = 1; node < count_nodes(top); ++node)
        for (std::size_t side = 0; side < 2; ++side) {
            float& child = top.nodes[4 * node + side].w;
            const std::uint32_t leaf = float_to_bits(child);
            if (leaf == f32::kBvhEmptyChild || f32::is_bvh_word_inner_node(leaf)) continue;
            const std::uint32_t number = unpack_number(
                top.triangles[3 * f32::bvh_word_index(leaf) + 1].w);
            child = pack_word(f32::kBvhInstanceMarker << f32::kBvhCountShift |
                              (first_record + f32::kBvhNodesPerInstance * number));
        }
    top.triangles.clear();
    return top;
}

/// Appends like `append_tree`, for a tree whose leaf words already refer to records.
std::uint32_t append_top_level(Bvh& into, const Bvh& top) {
    const auto nodes = static_cast<std::uint32_t>(count_nodes(into) - 1);
    for (std::size_t i = 4; i < top.nodes.size(); ++i) {
        vec4 texel = top.nodes[i];
        if (i % 4 < 2 && f32::is_bvh_word_inner_node(float_to_bits(texel.w)))
            texel.w = std::bit_cast<float>(float_to_bits(texel.w) + nodes);
        into.nodes.push_back(texel);
    }
    return f32::kBvhNormalFloatBit | (nodes + 1);
}

} // namespace

vec3 float_rounding_error(const dvec3& v) {
    vec3 low;
    for (int i = 0; i < 3; ++i) {
        // The variable is `volatile`, because g++ 12 otherwise vectorises this loop and drops the
        // rounding to float.
        const volatile float high = static_cast<float>(v[i]);
        low[i] = static_cast<float>(v[i] - double{high});
    }
    return low;
}

double rounding_amplification(const dmat3& matrix) {
    const dmat3 inverse = glm::inverse(matrix);
    double most = 0;
    for (int row = 0; row < 3; ++row) {
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            for (int column = 0; column < 3; ++column)
                sum += std::abs(matrix[k][row]) * std::abs(inverse[column][k]);
        if (!(sum <= most)) most = sum;
    }
    // A singular matrix gives a sum that is not finite or is zero.
    return std::isfinite(most) && most > 0 ? most : std::numeric_limits<double>::infinity();
}

Bvh assemble_two_level(const Bvh& flat, std::span<const BvhInstance> instances) {
    if (instances.empty()) return flat;
    Bvh result;
    result.nodes.resize(8, vec4(0));
    const BoundingBox in_flat = node_bounds(flat, 1);
    const std::uint32_t flat_root = count_triangles(flat) > 0 ? append_tree(result, flat)
                                                              : f32::kBvhEmptyChild;
    std::map<const Bvh*, std::uint32_t> roots;
    double worst = 1;
    BoundingBox core = stored_core(flat);
    for (const BvhInstance& instance : instances) {
        worst = std::max(worst, rounding_amplification(instance.scene_from_own));
        if (count_triangles(flat) == 0 && flat.nodes[0].x > flat.nodes[1].x)
            core.add(instance_bounds(instance));
        if (!roots.contains(instance.tree))
            roots[instance.tree] = append_tree(result, *instance.tree);
    }
    const auto first_record = result.first_record = static_cast<std::uint32_t>(count_nodes(result));
    for (const BvhInstance& instance : instances)
        add_record(result, instance, roots.at(instance.tree));
    const double times = 1 + 4 * worst;
    const Bvh top = build_instance_tree(instances, core, times, first_record);
    const BoundingBox in_top = node_bounds(top, 1);
    const std::uint32_t top_root = append_top_level(result, top);
    check(
        count_nodes(result) <= f32::kBvhIndexMask && count_triangles(result) <= f32::kBvhIndexMask,
        Failure::exhausted, "bounding volume hierarchy wants ", count_nodes(result), " nodes and ",
        count_triangles(result), " triangles, its words hold ", f32::kBvhIndexMask, " each");
    result.nodes[0] = vec4(core.lo, pack_number(count_triangles(result)));
    result.nodes[1] = vec4(core.hi, pack_number(count_nodes(result)));
    result.nodes[2].x = static_cast<float>(times);
    write_start(result, f32::kBvhRoot, f32::kBvhEmptyChild);
    result.nodes[4] = vec4(in_flat.lo, std::bit_cast<float>(flat_root));
    result.nodes[5] = vec4(in_flat.hi, std::bit_cast<float>(top_root));
    result.nodes[6] = vec4(in_top.lo, 0);
    result.nodes[7] = vec4(in_top.hi, 0);
    return result;
}

} // namespace catoptric::bvh
