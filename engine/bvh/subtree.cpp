#include "bvh/subtree.hpp"

#include <algorithm>

namespace catoptric::bvh {

namespace {

std::uint32_t leaf_word(std::size_t count, std::size_t first) {
    return f32::kBvhTag | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

class Builder {
public:
    Builder(const Workspace& work, std::size_t first, Subtree& subtree)
        : work_(work), first_(first), subtree_(subtree) {}

    std::uint32_t add(ReferenceRange part, std::uint32_t depth) {
        if (part.count > kMaxLeaf && part.centres.is_point() && !part.is_heap) {
            part.count = without_copies(work_.of(part), work_.input, work_.copies).size();
            part.is_heap = true;
        }
        if (part.count <= work_.most &&
            (static_cast<double>(part.count) <= kTraversalCost || depth == kMaxDepth))
            return add_leaf(part);
        if (part.count > kSweepCount) return add_node(divide(part, depth), depth);
        const std::optional<Division> best = sweep(work_.of(part), capacity(work_, depth + 1));
        // Written so that NaN and zero areas make a leaf.
        const double whole = part.box.half_area();
        const bool is_worth_it = best && kTraversalCost * whole + best->cost <
                                             whole * static_cast<double>(part.count);
        if (part.count <= work_.most && !is_worth_it) return add_leaf(part);
        return add_node(best ? cut(part, best->middle) : halves(part), depth);
    }

private:
    std::uint32_t add_node(const SplitParts& sides, std::uint32_t depth) {
        const std::size_t place = subtree_.nodes.size();
        subtree_.nodes.resize(place + 4, vec4(0));
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t child = add(sides[i], depth + 1);
            vec4* texel = &subtree_.nodes[place]; // taken after `add`, which reallocates the nodes
            texel[2 * i] = vec4(vector(sides[i].box.lo), texel[2 * i].w);
            texel[2 * i + 1] = vec4(vector(sides[i].box.hi), texel[2 * i + 1].w);
            texel[i].w = word(child);
        }
        return f32::kBvhTag | static_cast<std::uint32_t>(place / 4 + 1);
    }

    std::uint32_t add_leaf(const ReferenceRange& part) {
        const References references = work_.of(part);
        std::ranges::sort(references, {}, &TriangleReference::triangle);
        const std::size_t first = first_ + subtree_.triangles;
        vec4* texel = work_.triangles + 3 * first;
        for (const TriangleReference& r : references) {
            const Triangle& t = work_.input[r.triangle()];
            *texel++ = vec4(t.a, id_word(t.object));
            *texel++ = vec4(t.b, r.lo[3]);
            *texel++ = vec4(t.c, id_word(t.flags));
        }
        subtree_.triangles += part.count;
        return leaf_word(part.count, first);
    }

    SplitParts divide(const ReferenceRange& part, std::uint32_t depth) const {
        const References references = work_.of(part);
        const Binning binning(part.centres);
        Bins bins;
        bins.add(references, binning);
        const std::optional<Split> best = best_split(bins, capacity(work_, depth + 1));
        if (!best) return halves(part);
        TriangleReference* into = work_.other(part).data();
        std::array<Extent, 2> centres;
        best->scatter(references, binning, {into, into + bins.left_count(*best)}, centres);
        return sides_of(part, bins, *best, centres);
    }

    SplitParts halves(const ReferenceRange& part) const {
        return cut(part, part.is_heap ? part.count / 2 : halve(work_.of(part), part.centres));
    }

    SplitParts cut(const ReferenceRange& part, std::size_t middle) const {
        SplitParts sides{ReferenceRange{part.first, 0, part.in_second, part.is_heap},
                         ReferenceRange{part.first + middle, 0, part.in_second, part.is_heap}};
        const References references = work_.of(part);
        for (std::size_t i = 0; i < part.count; ++i) sides[i < middle ? 0 : 1].add(references[i]);
        return sides;
    }

    const Workspace& work_;
    std::size_t first_;
    Subtree& subtree_;
};

} // namespace

Subtree build_subtree(const Workspace& work, const ReferenceRange& part, std::uint32_t depth) {
    Subtree subtree;
    subtree.nodes.reserve(4 * part.count / 2);
    subtree.root = Builder(work, part.first, subtree).add(part, depth);
    return subtree;
}

} // namespace catoptric::bvh
