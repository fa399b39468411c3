#include "bvh/bvh.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace catoptric::bvh {
namespace {

using Box = Bounds<float>;

constexpr int kBinCount = 16;
constexpr double kTraversalCost = 2; // of a node, in triangle tests
constexpr std::uint32_t kMaxTriangles = f32::kBvhIndexMask;

/// A triangle while the tree is being built.
struct Reference {
    Box box;
    vec3 centre;
    std::uint32_t triangle;
};

using References = std::span<Reference>;

float word(std::uint32_t child) { return std::bit_cast<float>(child | f32::kBvhTag); }
float id_word(std::size_t number) {
    return word(static_cast<std::uint32_t>(number) & f32::kBvhIdMask);
}

std::uint32_t leaf_word(std::size_t count, std::size_t first) {
    return f32::kBvhTag | static_cast<std::uint32_t>(count) << f32::kBvhCountShift |
           static_cast<std::uint32_t>(first);
}

// In double, where the extent of finite floats cannot overflow.
double area(const Box& box) { return Bounds<double>{dvec3(box.lo), dvec3(box.hi)}.area(); }

Box bounds(References references) {
    Box box;
    for (const Reference& r : references) box.add(r.box);
    return box;
}

Box centre_bounds(References references) {
    Box box;
    for (const Reference& r : references) box.add(r.centre);
    return box;
}

/// Maps centres to bins along one axis of the centres' bounds.
struct Binning {
    int axis = 0;
    double lo = 0;
    double bins_per_unit = 0;

    Binning(const Box& centres, int along)
        : axis(along), lo(centres.lo[along]),
          bins_per_unit(kBinCount / (static_cast<double>(centres.hi[along]) - lo)) {}
    int bin(const Reference& r) const {
        const double place = (static_cast<double>(r.centre[axis]) - lo) * bins_per_unit;
        return std::min(static_cast<int>(place), kBinCount - 1);
    }
};

struct Bin {
    Box box;
    std::size_t count = 0;
    void add(const Bin& other) { box.add(other.box), count += other.count; }
    double cost() const { return count == 0 ? 0 : area(box) * static_cast<double>(count); }
};

struct Split {
    Binning binning;
    int first_right; ///< bins from here on go right
    double cost;     ///< sum over the sides of area times count
};

/// The cheapest of the planes between the bins, neither side with more than `most` triangles.
std::optional<Split> best_split(References references, std::size_t most) {
    std::optional<Split> best;
    const Box centres = centre_bounds(references);
    for (int axis = 0; axis < 3; ++axis) {
        if (!(centres.lo[axis] < centres.hi[axis])) continue;
        const Binning binning(centres, axis);
        std::array<Bin, kBinCount> bins;
        for (const Reference& r : references) {
            Bin& bin = bins[static_cast<std::size_t>(binning.bin(r))];
            bin.box.add(r.box), ++bin.count;
        }
        std::array<Bin, kBinCount> right; // right[i]: bins i and above
        right.back() = bins.back();
        for (std::size_t i = kBinCount - 1; i-- > 1;) {
            right[i] = bins[i];
            right[i].add(right[i + 1]);
        }
        Bin left;
        for (std::size_t i = 1; i < kBinCount; ++i) {
            left.add(bins[i - 1]);
            if (left.count == 0 || right[i].count == 0) continue;
            if (left.count > most || right[i].count > most) continue;
            const double cost = left.cost() + right[i].cost();
            if (!best || cost < best->cost) best = Split{binning, static_cast<int>(i), cost};
        }
    }
    return best;
}

/// Puts the half with the smaller centres along the longest axis first; by number where they tie.
std::size_t halve(References references) {
    const vec3 size = centre_bounds(references).extent();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = references.size() / 2;
    std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(middle),
                     references.end(), [axis](const Reference& a, const Reference& b) {
                         if (a.centre[axis] != b.centre[axis])
                             return a.centre[axis] < b.centre[axis];
                         return a.triangle < b.triangle;
                     });
    return middle;
}

/// One reference of each triangle where there are more of them in one place than a leaf holds: a
/// ray would have to look at all copies, since all are at the same t, and it cannot tell those of
/// one object apart. The lowest number stays.
References without_copies(References references, std::span<const Triangle> triangles) {
    const auto in_one_place = [&](const Reference& r) { return r.centre == references[0].centre; };
    if (references.size() <= kMaxLeaf || !std::ranges::all_of(references, in_one_place))
        return references;
    const auto what = [&](const Reference& r) {
        const Triangle& t = triangles[r.triangle];
        return std::array{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    };
    const auto whose = [&](const Reference& r) {
        const Triangle& t = triangles[r.triangle];
        return std::pair{t.object, t.flags};
    };
    std::ranges::sort(references, [&](const Reference& a, const Reference& b) {
        return std::tuple{what(a), whose(a), a.triangle} <
               std::tuple{what(b), whose(b), b.triangle};
    });
    const auto copies = std::ranges::unique(references,
                                            [&](const Reference& a, const Reference& b) {
                                                return what(a) == what(b) && whose(a) == whose(b);
                                            });
    return references.first(references.size() - copies.size());
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

/// What the walk's slack lacks for a triangle that reaches out of the core: its distance from the
/// middle, of which box_ray (shaders/lib/math.glsl) takes the same part for rays that start in the
/// core.
float pad_of(const Box& box, const Box& core) {
    const bool inside = all(lessThanEqual(core.lo, box.lo)) && all(lessThanEqual(box.hi, core.hi));
    if (inside) return 0;
    const vec3 middle = core.lo * 0.5f + core.hi * 0.5f;
    return 2 * f32::gamma_bound(16) *
           f32::largest(max(abs(box.lo - middle), abs(box.hi - middle))); // twice: roundings here
}

bool is_finite(const Triangle& t) {
    return f32::is_finite(t.a) && f32::is_finite(t.b) && f32::is_finite(t.c);
}

std::vector<Reference> references(std::span<const Triangle> triangles) {
    std::vector<Reference> result;
    result.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (!is_finite(t)) continue;
        Reference r{.box = {}, .centre = {}, .triangle = static_cast<std::uint32_t>(i)};
        r.box.add(t.a), r.box.add(t.b), r.box.add(t.c);
        r.centre = r.box.lo * 0.5f + r.box.hi * 0.5f; // the sum itself may overflow
        result.push_back(r);
    }
    return result;
}

Box corner_bounds(const vec4* corners) {
    Box box;
    for (int i = 0; i < 3; ++i) box.add(vec3(corners[i]));
    return box;
}

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

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
        Box triangle = corner_bounds(&bvh.triangles[3 * std::size_t{f32::bvh_index(child) + i}]);
        const float pad = pad_of(triangle, core);
        triangle.lo -= pad, triangle.hi += pad;
        box.add(triangle);
    }
    return box;
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
    return bvh;
}

void refit(Bvh& bvh, std::span<const Triangle> triangles, const Bounds<float>& core) {
    for (std::size_t i = 0; i < bvh.triangles.size(); i += 3) {
        const std::size_t number = bits(bvh.triangles[i + 1].w) & f32::kBvhIdMask;
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
            slack.add(corner_bounds(&bvh.triangles[i]));
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

std::size_t node_count(const Bvh& bvh) { return bvh.nodes.size() / 4; }

std::size_t triangle_count(const Bvh& bvh) { return bvh.triangles.size() / 3; }

} // namespace catoptric::bvh
