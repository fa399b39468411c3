#include "bvh/subtree.hpp"

#include <algorithm>

namespace catoptric::bvh {

namespace {

std::uint32_t make_leaf_word(std::size_t count, std::size_t first) {
    return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

class SubtreeBuilder {
public:
    SubtreeBuilder(const BuildWorkspace& work, std::size_t first, Subtree& subtree)
        : work_(work), first_(first), subtree_(subtree) {}

    std::uint32_t build_range(ReferenceRange part, std::uint32_t depth) {
        if (part.count > kMaxLeafTriangles && part.centres.is_point() && !part.is_heap) {
            part.count = remove_duplicate_triangles(work_.references_of(part), work_.input,
                                                    work_.copies)
                             .size();
            part.is_heap = true;
        }
        if (part.count <= work_.most &&
            (static_cast<double>(part.count) <= kNodeVisitCost || depth == kMaxTreeDepth))
            return append_leaf(part);
        if (part.count > kMaxSweepTriangles) return append_node(divide_range(part, depth), depth);
        const std::optional<SweepDivision> best = find_best_division_by_sweep(
            work_.references_of(part), max_triangles_below(work_, depth + 1));
        // Written so that NaN and zero areas make a leaf.
        const double whole = part.box.half_surface_area();
        const bool is_worth_it = best && kNodeVisitCost * whole + best->cost <
                                             whole * static_cast<double>(part.count);
        if (part.count <= work_.most && !is_worth_it) return append_leaf(part);
        return append_node(best ? cut_range(part, best->middle) : divide_in_halves(part), depth);
    }

private:
    std::uint32_t append_node(const SplitRanges& sides, std::uint32_t depth) {
        const std::size_t place = subtree_.nodes.size();
        subtree_.nodes.resize(place + 4, vec4(0));
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t child = build_range(sides[i], depth + 1);
            vec4* texel = &subtree_.nodes[place]; // taken after `add`, which reallocates the nodes
            texel[2 * i] = vec4(simd_to_vec3(sides[i].box.lo), texel[2 * i].w);
            texel[2 * i + 1] = vec4(simd_to_vec3(sides[i].box.hi), texel[2 * i + 1].w);
            texel[i].w = integer_to_float_word(child);
        }
        return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(place / 4 + 1);
    }

    std::uint32_t append_leaf(const ReferenceRange& part) {
        const TriangleReferences references = work_.references_of(part);
        std::ranges::sort(references, {}, &TriangleReference::triangle);
        const std::size_t first = first_ + subtree_.triangles;
        vec4* texel = work_.triangles + 3 * first;
        for (const TriangleReference& r : references) {
            const Triangle& t = work_.input[r.triangle()];
            *texel++ = vec4(t.a, id_to_float_word(t.object));
            *texel++ = vec4(t.b, r.lo[3]);
            *texel++ = vec4(t.c, id_to_float_word(t.flags));
        }
        subtree_.triangles += part.count;
        return make_leaf_word(part.count, first);
    }

    SplitRanges divide_range(const ReferenceRange& part, std::uint32_t depth) const {
        const TriangleReferences references = work_.references_of(part);
        const BinMapping binning(part.centres);
        SplitBins bins;
        bins.add_references(references, binning);
        const std::optional<BinSplit> best = find_best_split(bins,
                                                             max_triangles_below(work_, depth + 1));
        if (!best) return divide_in_halves(part);
        TriangleReference* into = work_.other_buffer_of(part).data();
        std::array<SimdBox, 2> centres;
        best->scatter_references(references, binning, {into, into + bins.left_count(*best)},
                                 centres);
        return partition_ranges(part, bins, *best, centres);
    }

    SplitRanges divide_in_halves(const ReferenceRange& part) const {
        return cut_range(part, part.is_heap
                                   ? part.count / 2
                                   : partition_at_median(work_.references_of(part), part.centres));
    }

    SplitRanges cut_range(const ReferenceRange& part, std::size_t middle) const {
        SplitRanges sides{ReferenceRange{part.first, 0, part.in_second, part.is_heap},
                          ReferenceRange{part.first + middle, 0, part.in_second, part.is_heap}};
        const TriangleReferences references = work_.references_of(part);
        for (std::size_t i = 0; i < part.count; ++i) sides[i < middle ? 0 : 1].add(references[i]);
        return sides;
    }

    const BuildWorkspace& work_;
    std::size_t first_;
    Subtree& subtree_;
};

} // namespace

Subtree build_subtree(const BuildWorkspace& work, const ReferenceRange& part, std::uint32_t depth) {
    Subtree subtree;
    subtree.nodes.reserve(4 * part.count / 2);
    subtree.root = SubtreeBuilder(work, part.first, subtree).build_range(part, depth);
    return subtree;
}

} // namespace catoptric::bvh
