// Tests of BVH construction. Divisions are compared with all possible divisions, and trees with
// trees built by other numbers of threads.
#include "bvh/split.hpp"
#include "bvh/subtree.hpp"
#include "core/shader_math.hpp"
#include "support/hierarchies.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace catoptric::bvh {
namespace {

using test::expect_valid_bvh, test::have_equal_bytes, test::make_random_triangles;

std::vector<TriangleReference> make_triangle_references(std::span<const Triangle> triangles) {
    std::vector<TriangleReference> result;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const BoundingBox box = triangle_bounds(triangles[i].a, triangles[i].b, triangles[i].c, 0);
        result.push_back({load_simd(box.lo, pack_number(i)), load_simd(box.hi, 0)});
    }
    return result;
}

/// Returns the cost of references in one node: half the area of their bounds times their number.
double node_cost_of_references(std::span<const TriangleReference> references) {
    Bounds<double> box;
    for (const TriangleReference& r : references)
        box.add(Bounds<double>{dvec3(to_vec3(r.lo)), dvec3(to_vec3(r.hi))});
    return surface_area(box) / 2 * static_cast<double>(references.size());
}

double node_cost_of_references(std::span<const TriangleReference> references, std::size_t middle) {
    return node_cost_of_references(references.first(middle)) +
           node_cost_of_references(references.subspan(middle));
}

std::vector<TriangleReference> sort_references_along_axis(std::vector<TriangleReference> references,
                                                          int axis) {
    std::ranges::stable_sort(references, {},
                             [&](const TriangleReference& r) { return r.centre()[axis]; });
    return references;
}

TEST(BvhBuild, MedianDividesAlongTheWidestAxis) {
    std::array<float, 3> size{1, 2, 4};
    do {
        std::vector<Triangle> triangles = make_random_triangles(99, 7);
        std::vector<TriangleReference> references;
        SimdBox centres;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const vec3 centre = triangles[i].a * vec3(size[0], size[1], size[2]);
            references.push_back({load_simd(centre, pack_number(i)), load_simd(centre, 0)});
            centres.add_point(references.back().lo);
        }
        const vec3 extent = centres.to_bounds().extent();
        const int axis = extent.x > extent.y && extent.x > extent.z ? 0
                         : extent.y > extent.z                      ? 1
                                                                    : 2;
        const std::size_t middle = partition_at_median(references, centres);
        ASSERT_EQ(middle, 49u);
        const auto place = [axis](const TriangleReference& r) { return r.lo[axis]; };
        EXPECT_LE(std::ranges::max(std::span(references).first(middle), {}, place).lo[axis],
                  std::ranges::min(std::span(references).subspan(middle), {}, place).lo[axis])
            << size[0] << size[1] << size[2];
    } while (std::ranges::next_permutation(size).found);
}

TEST(BvhDivision, SweepFindsTheCheapestDivision) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const std::size_t count = 2 + seed % (kMaxSweepTriangles - 1), most = count - seed % 2;
        std::vector<TriangleReference> few = make_triangle_references(
            make_random_triangles(count, seed));
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis)
            for (std::size_t middle = 1; middle < count; ++middle)
                if (std::max(middle, count - middle) <= most)
                    least = std::min(least, node_cost_of_references(
                                                sort_references_along_axis(few, axis), middle));
        const std::optional<SweptSplit> found = find_swept_split(few, most);
        ASSERT_EQ(found.has_value(), std::isfinite(least));
        if (!found) continue;
        EXPECT_NEAR(found->cost, least, 1e-6 * least);
        EXPECT_NEAR(node_cost_of_references(few, found->middle), least, 1e-6 * least)
            << "sorted as it says";
    }
}

/// The expected cost comes from trying every plane between bins of equal width.
TEST(BvhDivision, BinsFindTheCheapestPlaneBetweenBins) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const std::size_t count = 50 * seed, most = seed % 2 == 0 ? count : 3 * count / 4;
        std::vector<TriangleReference> all = make_triangle_references(
            make_random_triangles(count, seed));
        ReferenceRange part;
        for (const TriangleReference& r : all) part.add(r);
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const std::vector<TriangleReference> along = sort_references_along_axis(all, axis);
            for (int plane = 1; plane < kBinCount; ++plane) {
                const double lo = double{part.centres.lo[axis]}, hi = double{part.centres.hi[axis]},
                             place = lo + (hi - lo) * plane / kBinCount;
                const auto middle = static_cast<std::size_t>(
                    std::ranges::count_if(along, [&](const TriangleReference& r) {
                        return double{r.centre()[axis]} < place;
                    }));
                if (middle > 0 && middle < count && std::max(middle, count - middle) <= most)
                    least = std::min(least, node_cost_of_references(along, middle));
            }
        }
        SplitBins bins;
        bins.add(all, Binning(part.centres));
        const std::optional<BinnedSplit> split = find_binned_split(bins, most);
        ASSERT_TRUE(split);
        const std::size_t middle = bins.left_count(*split);
        std::vector<TriangleReference> sides(count);
        std::array<SimdBox, 2> centres;
        split->scatter(all, Binning(part.centres), {sides.data(), &sides[middle]}, centres);
        EXPECT_NEAR(node_cost_of_references(sides, middle), least, 1e-6 * least);
        for (std::size_t side = 0; side < 2; ++side) {
            const auto own = std::span(sides).subspan(side == 0 ? 0 : middle,
                                                      side == 0 ? middle : count - middle);
            ReferenceRange made;
            for (const TriangleReference& r : own) made.add(r);
            EXPECT_EQ(bins.extents(*split)[side].to_bounds(), made.box.to_bounds());
            EXPECT_EQ(centres[side].to_bounds(), made.centres.to_bounds());
            EXPECT_TRUE(std::ranges::is_sorted(own, {}, &TriangleReference::number))
                << "in their order";
        }
    }
}

/// A named list of triangles that may be hard to divide. Most lists are longer than one thread
/// builds at once.
struct BvhBuildInput {
    const char* name;
    std::vector<Triangle> triangles;
    std::size_t kept;
    BoundingBox core{};
};

std::vector<BvhBuildInput> list_bvh_build_inputs() {
    constexpr std::size_t kManyTriangles = 20000;
    std::vector<BvhBuildInput> list{
        {"nothing", {}, 0},
        {"one", make_random_triangles(1, 1), 1},
        {"two", make_random_triangles(2, 2), 2},
        {"soup", make_random_triangles(kManyTriangles, 3), kManyTriangles}};
    BvhBuildInput flat{"points and lines", make_random_triangles(kManyTriangles, 4),
                       kManyTriangles};
    for (std::size_t i = 0; i < kManyTriangles; ++i) {
        Triangle& t = flat.triangles[i];
        t.c = t.b;
        if (i % 2 == 0) t.b = t.c = t.a;
    }
    list.push_back(flat);
    BvhBuildInput heap{"one centre", make_random_triangles(kManyTriangles, 5), kManyTriangles};
    for (Triangle& t : heap.triangles) t.b = -t.a, t.c = vec3(0);
    list.push_back(heap);
    // The build drops duplicates and triangles with NaN, so the numbers of the kept triangles have
    // gaps.
    BvhBuildInput holes{"holes", make_random_triangles(kManyTriangles, 6), 0};
    for (std::size_t i = 0; i < kManyTriangles; ++i) {
        Triangle& t = holes.triangles[i];
        if (i % 3 == 0) t = holes.triangles[i / 3 % 20];
        if (i % 1000 == 999) t.a.x = std::numeric_limits<float>::quiet_NaN();
    }
    list.push_back(holes);
    BvhBuildInput bits{"any finite numbers, most of them far out",
                       make_random_triangles(kManyTriangles, 7),
                       kManyTriangles,
                       {vec3(-1), vec3(1)}};
    test::RandomNumbers random(8);
    for (std::size_t i = 0; i < kManyTriangles; ++i) {
        // Triangles of distinct objects do not count as copies.
        bits.triangles[i].object = static_cast<std::uint32_t>(i);
        for (vec3* corner : {&bits.triangles[i].a, &bits.triangles[i].b, &bits.triangles[i].c})
            for (int k = 0; k < 3; ++k)
                (*corner)[k] = i % 100 == 0
                                   ? std::copysign(f32::kLargestFloat, (*corner)[k])
                                   : std::ldexp((*corner)[k],
                                                static_cast<int>(random.random_integer_below(250)) -
                                                    125);
    }
    list.push_back(bits);
    return list;
}

TEST(BvhBuild, TheTreeDoesNotDependOnTheNumberOfThreads) {
    for (const BvhBuildInput& input : list_bvh_build_inputs()) {
        SCOPED_TRACE(input.name);
        const Bvh one = build(input.triangles, input.core, kMaxLeafTriangles, 1);
        const std::size_t kept = input.triangles.size() - one.dropped - one.copies;
        EXPECT_EQ(count_triangles(one), kept);
        if (input.core.empty()) expect_valid_bvh(one, kept);
        if (input.name == std::string("holes"))
            EXPECT_GT(one.dropped * one.copies, 0u);
        else
            EXPECT_EQ(kept, input.kept);
        for (const unsigned threads : {2U, 3U, 8U}) {
            const Bvh many = build(input.triangles, input.core, kMaxLeafTriangles, threads);
            EXPECT_TRUE(have_equal_bytes(one.nodes, many.nodes)) << threads;
            EXPECT_TRUE(have_equal_bytes(one.triangles, many.triangles)) << threads;
            EXPECT_EQ(one.dropped, many.dropped);
            EXPECT_EQ(one.copies, many.copies);
        }
    }
}

/// A tree built by three threads stores no triangle twice, and each stored triangle unchanged.
TEST(BvhBuild, ThreadedBuildStoresTrianglesOnceAndUnchanged) {
    for (const BvhBuildInput& input : list_bvh_build_inputs()) {
        SCOPED_TRACE(input.name);
        const Bvh bvh = build(input.triangles, input.core, kMaxLeafTriangles, 3);
        std::vector<char> seen(input.triangles.size());
        for (std::size_t i = 0; i < bvh.triangles.size(); i += 3) {
            const std::uint32_t number = unpack_number(bvh.triangles[i + 1].w);
            ASSERT_LT(number, seen.size());
            ASSERT_EQ(seen[number]++, 0);
            const Triangle& t = input.triangles[number];
            ASSERT_EQ(vec3(bvh.triangles[i]), t.a);
            ASSERT_EQ(vec3(bvh.triangles[i + 1]), t.b);
            ASSERT_EQ(vec3(bvh.triangles[i + 2]), t.c);
        }
    }
}

} // namespace
} // namespace catoptric::bvh
