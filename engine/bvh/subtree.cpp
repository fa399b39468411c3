#include "bvh/subtree.hpp"

#include <algorithm>

namespace catoptric::bvh {

namespace {

std::uint32_t encode_leaf_child_word(std::size_t count, std::size_t first) {
    return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

class BvhSubtreeBuilder {
public:
    BvhSubtreeBuilder(const BvhBuildWorkspace& work, std::size_t first, BvhSubtree& subtree)
        : build_workspace_(work), first_(first), subtree_(subtree) {}

    std::uint32_t build_subtree_of_range(TriangleReferenceSpanRange part, std::uint32_t depth) {
        if (part.count > kMaxLeafTriangles && part.centres.is_single_point() &&
            !part.has_single_centre) {
            part.count = remove_duplicate_triangles(build_workspace_.references_of_range(part),
                                                    build_workspace_.input, build_workspace_.copies)
                             .size();
            part.has_single_centre = true;
        }
        if (part.count <= build_workspace_.most &&
            (static_cast<double>(part.count) <= kBvhNodeVisitCost || depth == kMaxTreeDepth))
            return append_bvh_leaf(part);
        if (part.count > kMaxSweepTriangles)
            return append_bvh_inner_node(split_range_by_sah(part, depth), depth);
        const std::optional<SweptSahSplit> best = find_best_sah_split_by_sweep(
            build_workspace_.references_of_range(part),
            max_triangles_below_tree_depth(build_workspace_, depth + 1));
        // The comparison is written so that NaN and zero areas make a leaf.
        const double whole = part.box.half_surface_area();
        const bool is_worth_it = best && kBvhNodeVisitCost * whole + best->cost <
                                             whole * static_cast<double>(part.count);
        if (part.count <= build_workspace_.most && !is_worth_it) return append_bvh_leaf(part);
        return append_bvh_inner_node(best ? split_triangle_range_at(part, best->middle)
                                          : split_range_in_halves(part),
                                     depth);
    }

private:
    std::uint32_t append_bvh_inner_node(const SplitTriangleRanges& sides, std::uint32_t depth) {
        const std::size_t place = subtree_.nodes.size();
        subtree_.nodes.resize(place + 4, vec4(0));
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t child = build_subtree_of_range(sides[i], depth + 1);
            vec4* texel = &subtree_.nodes[place]; // taken after the recursion,
                                                  // which reallocates the nodes
            texel[2 * i] = vec4(simd_to_vec3(sides[i].box.lo), texel[2 * i].w);
            texel[2 * i + 1] = vec4(simd_to_vec3(sides[i].box.hi), texel[2 * i + 1].w);
            texel[i].w = pack_word(child);
        }
        return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(place / 4 + 1);
    }

    std::uint32_t append_bvh_leaf(const TriangleReferenceSpanRange& part) {
        const TriangleReferences references = build_workspace_.references_of_range(part);
        std::ranges::sort(references, {}, &TriangleReference::triangle_index_of_reference);
        const std::size_t first = first_ + subtree_.triangles;
        vec4* texel = build_workspace_.triangles + 3 * first;
        for (const TriangleReference& r : references) {
            const Triangle& t = build_workspace_.input[r.triangle_index_of_reference()];
            *texel++ = vec4(t.a, pack_number(t.object));
            *texel++ = vec4(t.b, r.lo[3]);
            *texel++ = vec4(t.c, pack_number(t.flags));
        }
        subtree_.triangles += part.count;
        return encode_leaf_child_word(part.count, first);
    }

    SplitTriangleRanges split_range_by_sah(const TriangleReferenceSpanRange& part,
                                           std::uint32_t depth) const {
        const TriangleReferences references = build_workspace_.references_of_range(part);
        const CentroidToBinMapping binning(part.centres);
        SahSplitBins bins;
        bins.add_references(references, binning);
        const std::optional<BinnedSahSplit> best = find_best_binned_sah_split(
            bins, max_triangles_below_tree_depth(build_workspace_, depth + 1));
        if (!best) return split_range_in_halves(part);
        TriangleReference* into = build_workspace_.scratch_buffer_of_range(part).data();
        std::array<SimdBox, 2> centres;
        best->scatter_references_to_sides(
            references, binning, {into, into + bins.left_triangle_count_of_split(*best)}, centres);
        return make_split_ranges(part, bins, *best, centres);
    }

    SplitTriangleRanges split_range_in_halves(const TriangleReferenceSpanRange& part) const {
        return split_triangle_range_at(
            part, part.has_single_centre
                      ? part.count / 2
                      : partition_triangles_at_median(build_workspace_.references_of_range(part),
                                                      part.centres));
    }

    SplitTriangleRanges split_triangle_range_at(const TriangleReferenceSpanRange& part,
                                                std::size_t middle) const {
        SplitTriangleRanges sides{
            TriangleReferenceSpanRange{part.first, 0, part.in_second, part.has_single_centre},
            TriangleReferenceSpanRange{part.first + middle, 0, part.in_second,
                                       part.has_single_centre}};
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

BvhSubtree build_subtree(const BvhBuildWorkspace& work, const TriangleReferenceSpanRange& part,
                         std::uint32_t depth) {
    BvhSubtree subtree;
    subtree.nodes.reserve(4 * part.count / 2);
    subtree.root = BvhSubtreeBuilder(work, part.first, subtree).build_subtree_of_range(part, depth);
    return subtree;
}

} // namespace catoptric::bvh
