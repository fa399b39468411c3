#include "bvh/bvh.hpp"

#include "bvh/split.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace catoptric::bvh {
namespace {

constexpr std::uint32_t kMaxTriangles = f32::kBvhIndexMask;

std::uint32_t leaf_word(std::size_t count, std::size_t first) {
    return f32::kBvhTag | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

class Builder {
public:
    Builder(std::span<const Triangle> triangles, Bvh& bvh, std::uint32_t most)
        : triangles_(triangles), bvh_(bvh), most_(most) {}

    void add_root(References references) { add_node(without_copies(references, triangles_), 0); }

private:
    /// Appends the node over `references` and everything below it. `depth` of the root is 0.
    std::uint32_t add_node(References references, std::uint32_t depth) {
        const std::size_t place = bvh_.nodes.size();
        bvh_.nodes.resize(place + 4, vec4(0));
        const std::size_t middle = split(references, depth);
        const std::array sides{references.first(middle), references.subspan(middle)};
        for (std::size_t i = 0; i < 2; ++i) {
            const Box box = bounds(sides[i]);
            const std::uint32_t child = add_child(without_copies(sides[i], triangles_), depth + 1);
            vec4* texel = &bvh_.nodes[place]; // after add_child, which moves the nodes
            texel[2 * i] = vec4(box.lo, texel[2 * i].w);
            texel[2 * i + 1] = vec4(box.hi, texel[2 * i + 1].w);
            texel[i].w = word(child);
        }
        return static_cast<std::uint32_t>(place / 4);
    }

    std::uint32_t add_child(References references, std::uint32_t depth) {
        if (references.empty()) return f32::kBvhNothing;
        if (is_leaf(references, depth)) return add_leaf(references);
        return f32::kBvhTag | add_node(references, depth);
    }

    // Number of triangles that a subtree of which `depth` inner nodes are above can hold.
    std::size_t capacity(std::uint32_t depth) const {
        return std::size_t{most_} << (kMaxDepth - depth);
    }

    bool is_leaf(References references, std::uint32_t depth) const {
        if (references.size() > most_) return false;
        if (references.size() == 1 || depth == kMaxDepth) return true;
        const std::optional<Split> best = best_split(references, references.size());
        const double whole = area(bounds(references));
        // Written so that NaN and areas of zero make a leaf.
        return !(best && kTraversalCost * whole + best->cost <
                             whole * static_cast<double>(references.size()));
    }

    std::size_t split(References references, std::uint32_t depth) const {
        if (depth == 0 && references.size() <= most_) return references.size();
        const std::optional<Split> best = best_split(references, capacity(depth + 1));
        if (!best) return halve(references);
        const auto middle = std::partition(
            references.begin(), references.end(),
            [&](const Reference& r) { return best->binning.bin(r) < best->first_right; });
        return static_cast<std::size_t>(middle - references.begin());
    }

    std::uint32_t add_leaf(References references) {
        // By number: partitions leave an order that differs between standard libraries.
        std::ranges::sort(references, {}, &Reference::triangle);
        const std::size_t first = bvh_.triangles.size() / 3;
        for (const Reference& r : references) {
            const Triangle& t = triangles_[r.triangle];
            bvh_.triangles.push_back(vec4(t.a, id_word(t.object)));
            bvh_.triangles.push_back(vec4(t.b, id_word(r.triangle)));
            bvh_.triangles.push_back(vec4(t.c, id_word(t.flags)));
        }
        return leaf_word(references.size(), first);
    }

    std::span<const Triangle> triangles_;
    Bvh& bvh_;
    std::uint32_t most_; ///< triangles in a leaf
};

std::vector<Reference> references(std::span<const Triangle> triangles) {
    std::vector<Reference> result;
    result.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (!is_finite(t)) continue;
        Reference r{.box = {}, .centre = {}, .triangle = static_cast<std::uint32_t>(i)};
        r.box = box_of(t.a, t.b, t.c, t.flags);
        r.centre = r.box.lo * 0.5f + r.box.hi * 0.5f; // the sum itself may overflow
        result.push_back(r);
    }
    return result;
}

} // namespace

Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, std::uint32_t leaf) {
    check(triangles.size() <= kMaxTriangles, Failure::exhausted, "bounding volume hierarchy wants ",
          triangles.size(), " triangles, its words hold ", kMaxTriangles);
    std::vector<Reference> kept = references(triangles);
    Bvh bvh;
    bvh.dropped = triangles.size() - kept.size();
    bvh.triangles.reserve(3 * kept.size());
    Box slack = core;
    if (slack.empty()) slack = bounds(kept);
    for (Reference& r : kept) {
        const float pad = pad_of(r.box, slack);
        r.box.lo -= pad, r.box.hi += pad;
    }
    bvh.nodes.resize(4, vec4(0));
    Builder(triangles, bvh, leaf).add_root(kept);
    bvh.copies = kept.size() - triangle_count(bvh);
    bvh.nodes[0] = vec4(slack.lo, id_word(triangle_count(bvh)));
    bvh.nodes[1] = vec4(slack.hi, id_word(node_count(bvh)));
    bvh.cost = cost(bvh);
    return bvh;
}

std::size_t node_count(const Bvh& bvh) { return bvh.nodes.size() / 4; }

std::size_t triangle_count(const Bvh& bvh) { return bvh.triangles.size() / 3; }

} // namespace catoptric::bvh
