#include "bvh/subtree.hpp"

#include <algorithm>

namespace catoptric::bvh {

namespace {

std::uint32_t make_leaf_word(std::size_t count, std::size_t first) {
    return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

class BvhSubtreeBuilder {
public:
    BvhSubtreeBuilder(const BvhBuildWorkspace& work, std::size_t first, BvhSubtree& subtree)
        : build_workspace_(work), first_(first), subtree_(subtree) {}

    std::uint32_t build_subtree_of_range(TriangleReferenceRange part, std::uint32_t depth) {
        if (part.count > kMaxLeafTriangles && part.centres.is_single_point() && !part.is_heap) {
            part.count = remove_duplicate_triangles(build_workspace_.references_of_range(part),
                                                    build_workspace_.input, build_workspace_.copies)
                             .size();
            part.is_heap = true;
        }
        if (part.count <= build_workspace_.most &&
            (static_cast<double>(part.count) <= kNodeVisitCost || depth == kMaxTreeDepth))
            return append_leaf(part);
        if (part.count > kMaxSweepTriangles)
            return append_node(divide_range_by_best_split(part, depth), depth);
        const std::optional<SweepSplit> best = find_best_division_by_sweep(
            build_workspace_.references_of_range(part),
            max_triangles_of_subtree(build_workspace_, depth + 1));
        // Written so that NaN and zero areas make a leaf.
        const double whole = part.box.half_surface_area();
        const bool is_worth_it = best && kNodeVisitCost * whole + best->cost <
                                             whole * static_cast<double>(part.count);
        if (part.count <= build_workspace_.most && !is_worth_it) return append_leaf(part);
        return append_node(best ? cut_range_at(part, best->middle) : divide_range_in_halves(part),
                           depth);
    }

private:
    std::uint32_t append_node(const SplitRanges& sides, std::uint32_t depth) {
        const std::size_t place = subtree_.nodes.size();
        subtree_.nodes.resize(place + 4, vec4(0));
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t child = build_subtree_of_range(sides[i], depth + 1);
            vec4* texel =
                &subtree_.nodes[place]; // taken after `add_reference`, which reallocates the nodes
            texel[2 * i] = vec4(simd_to_vec3(sides[i].box.lo), texel[2 * i].w);
            texel[2 * i + 1] = vec4(simd_to_vec3(sides[i].box.hi), texel[2 * i + 1].w);
            texel[i].w = integer_to_float_word(child);
        }
        return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(place / 4 + 1);
    }

    std::uint32_t append_leaf(const TriangleReferenceRange& part) {
        const TriangleReferences references = build_workspace_.references_of_range(part);
        std::ranges::sort(references, {}, &TriangleReference::triangle_number);
        const std::size_t first = first_ + subtree_.triangles;
        vec4* texel = build_workspace_.triangles + 3 * first;
        for (const TriangleReference& r : references) {
            const Triangle& t = build_workspace_.input[r.triangle_number()];
            *texel++ = vec4(t.a, index_to_float_word(t.object));
            *texel++ = vec4(t.b, r.lo[3]);
            *texel++ = vec4(t.c, index_to_float_word(t.flags));
        }
        subtree_.triangles += part.count;
        return make_leaf_word(part.count, first);
    }

    SplitRanges divide_range_by_best_split(const TriangleReferenceRange& part,
                                           std::uint32_t depth) const {
        const TriangleReferences references = build_workspace_.references_of_range(part);
        const SplitBinMapping binning(part.centres);
        SplitBins bins;
        bins.add_references(references, binning);
        const std::optional<BinSplit> best = find_best_split(
            bins, max_triangles_of_subtree(build_workspace_, depth + 1));
        if (!best) return divide_range_in_halves(part);
        TriangleReference* into = build_workspace_.other_buffer_of_range(part).data();
        std::array<SimdBox, 2> centres;
        best->scatter_references(references, binning, {into, into + bins.left_count(*best)},
                                 centres);
        return partition_range_by_split(part, bins, *best, centres);
    }

    SplitRanges divide_range_in_halves(const TriangleReferenceRange& part) const {
        return cut_range_at(
            part, part.is_heap ? part.count / 2
                               : partition_at_median(build_workspace_.references_of_range(part),
                                                     part.centres));
    }

    SplitRanges cut_range_at(const TriangleReferenceRange& part, std::size_t middle) const {
        SplitRanges sides{
            TriangleReferenceRange{part.first, 0, part.in_second, part.is_heap},
            TriangleReferenceRange{part.first + middle, 0, part.in_second, part.is_heap}};
        const TriangleReferences references = build_workspace_.references_of_range(part);
        for (std::size_t i = 0; i < part.count; ++i)
            sides[i < middle ? 0 : 1].add_reference(references[i]);
        return sides;
    }

    const BvhBuildWorkspace& build_workspace_;
    std::size_t first_;
    BvhSubtree& subtree_;
};

} // namespace

BvhSubtree build_subtree(const BvhBuildWorkspace& work, const TriangleReferenceRange& part,
                         std::uint32_t depth) {
    BvhSubtree subtree;
    subtree.nodes.reserve(4 * part.count / 2);
    subtree.root = BvhSubtreeBuilder(work, part.first, subtree).build_subtree_of_range(part, depth);
    return subtree;
}

} // namespace catoptric::bvh
