#include "bvh/subtree.hpp"

#include <algorithm>

namespace catoptric::bvh {

namespace {

std::uint32_t leaf_word(std::size_t count, std::size_t first) {
    return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

class SubtreeBuilder {
public:
    SubtreeBuilder(const BuildWorkspace& work, std::size_t first, Subtree& subtree)
        : work_(work), first_(first), subtree_(subtree) {}

    std::uint32_t build(ReferenceRange part, std::uint32_t depth) {
        if (part.count > kMaxLeafTriangles && part.centres.is_point() && !part.has_single_centre) {
            part.count = remove_copies(work_.references(part), work_.input, work_.copies).size();
            part.has_single_centre = true;
        }
        if (part.count <= work_.most &&
            (static_cast<double>(part.count) <= kNodeVisitCost || depth == kMaxTreeDepth))
            return append_leaf(part);
        if (part.count > kMaxSweepTriangles) return append_node(split_by_sah(part, depth), depth);
        const std::optional<SweptSplit> best = find_swept_split(
            work_.references(part), max_triangles_below(work_, depth + 1));
        // The comparison is written so that NaN and zero areas make a leaf.
        const double whole = part.box.half_area();
        const bool is_worth_it = best && kNodeVisitCost * whole + best->cost <
                                             whole * static_cast<double>(part.count);
        if (part.count <= work_.most && !is_worth_it) return append_leaf(part);
        return append_node(best ? split_at(part, best->middle) : split_in_halves(part), depth);
    }

private:
    std::uint32_t append_node(const SplitRanges& sides, std::uint32_t depth) {
        const std::size_t place = subtree_.nodes.size();
        subtree_.nodes.resize(place + 4, vec4(0));
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t child = build(sides[i], depth + 1);
            vec4* texel = &subtree_.nodes[place]; // taken after the recursion,
                                                  // which reallocates the nodes
            texel[2 * i] = vec4(to_vec3(sides[i].box.lo), texel[2 * i].w);
            texel[2 * i + 1] = vec4(to_vec3(sides[i].box.hi), texel[2 * i + 1].w);
            texel[i].w = pack_word(child);
        }
        return f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(place / 4 + 1);
    }

    std::uint32_t append_leaf(const ReferenceRange& part) {
        const TriangleReferences references = work_.references(part);
        std::ranges::sort(references, {}, &TriangleReference::number);
        const std::size_t first = first_ + subtree_.triangles;
        vec4* texel = work_.triangles + 3 * first;
        for (const TriangleReference& r : references) {
            const Triangle& t = work_.input[r.number()];
            *texel++ = vec4(t.a, pack_number(t.object));
            *texel++ = vec4(t.b, r.lo[3]);
            *texel++ = vec4(t.c, pack_number(t.flags));
        }
        subtree_.triangles += part.count;
        return leaf_word(part.count, first);
    }

    SplitRanges split_by_sah(const ReferenceRange& part, std::uint32_t depth) const {
        const TriangleReferences references = work_.references(part);
        const Binning binning(part.centres);
        SplitBins bins;
        bins.add(references, binning);
        const std::optional<BinnedSplit> best = find_binned_split(
            bins, max_triangles_below(work_, depth + 1));
        if (!best) return split_in_halves(part);
        TriangleReference* into = work_.scratch(part).data();
        std::array<SimdBox, 2> centres;
        best->scatter(references, binning, {into, into + bins.left_count(*best)}, centres);
        return make_split_ranges(part, bins, *best, centres);
    }

    SplitRanges split_in_halves(const ReferenceRange& part) const {
        return split_at(part, part.has_single_centre
                                  ? part.count / 2
                                  : partition_at_median(work_.references(part), part.centres));
    }

    SplitRanges split_at(const ReferenceRange& part, std::size_t middle) const {
        SplitRanges sides{
            ReferenceRange{part.first, 0, part.in_second, part.has_single_centre},
            ReferenceRange{part.first + middle, 0, part.in_second, part.has_single_centre}};
        const TriangleReferences references = work_.references(part);
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
    subtree.root = SubtreeBuilder(work, part.first, subtree).build(part, depth);
    return subtree;
}

} // namespace catoptric::bvh
