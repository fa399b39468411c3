#pragma once

#include "bvh/bvh.hpp"
#include "bvh/words.hpp"
#include "support/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

/// Random triangles to build trees from, and checks that every tree must pass.
namespace test {

using catoptric::Bounds, catoptric::vec4;

inline std::vector<catoptric::bvh::Triangle> make_random_triangles(std::size_t count,
                                                                   unsigned seed) {
    RandomNumbers random(seed);
    std::vector<catoptric::bvh::Triangle> result(count);
    for (catoptric::bvh::Triangle& t : result) {
        const vec3 centre = random.random_point_in_cube();
        t.a = centre + 0.1f * random.random_point_in_cube();
        t.b = centre + 0.1f * random.random_point_in_cube();
        t.c = centre + 0.1f * random.random_point_in_cube();
    }
    return result;
}

/// Visits all nodes of a tree. Checks that leaves are small, that boxes enclose the triangles below
/// them, and that each triangle is in exactly one leaf. Counts nodes, triangles and depth.
struct BvhChecker {
    const catoptric::bvh::Bvh& bvh;
    std::size_t nodes = 0, triangles = 0;
    std::uint32_t deepest = 0;

    Bounds<float> check_subtree(std::uint32_t child, std::uint32_t depth) {
        Bounds<float> box;
        const std::uint32_t first = catoptric::f32::bvh_word_index(child);
        if (catoptric::f32::is_bvh_word_inner_node(child)) {
            ++nodes;
            deepest = std::max(deepest, depth + 1);
            const vec4* node = &bvh.nodes[4 * std::size_t{first}];
            for (int i : {0, 1}) {
                const Bounds<float> stored{vec3(node[2 * i]), vec3(node[2 * i + 1])};
                const Bounds<float> below = check_subtree(catoptric::bvh::float_to_bits(node[i].w),
                                                          depth + 1);
                EXPECT_EQ(stored.lo, below.lo);
                EXPECT_EQ(stored.hi, below.hi);
                box.add(below);
            }
            return box;
        }
        EXPECT_LE(catoptric::f32::bvh_word_triangle_count(child),
                  catoptric::bvh::kMaxLeafTriangles);
        for (std::uint32_t i = 0; i < catoptric::f32::bvh_word_triangle_count(child); ++i) {
            EXPECT_EQ(first + i, triangles) << "leaves follow each other";
            ++triangles;
            for (int k = 0; k < 3; ++k) box.add(vec3(bvh.triangles[3 * (first + i) + k]));
        }
        return box;
    }
};

inline void expect_valid_bvh(const catoptric::bvh::Bvh& bvh, std::size_t triangles) {
    BvhChecker census{bvh};
    const Bounds<float> all = census.check_subtree(catoptric::f32::kBvhRoot, 0);
    EXPECT_EQ(all.lo, vec3(bvh.nodes[0]));
    EXPECT_EQ(all.hi, vec3(bvh.nodes[1]));
    EXPECT_EQ(census.triangles, triangles);
    EXPECT_EQ(catoptric::bvh::unpack_number(bvh.nodes[0].w), triangles);
    EXPECT_EQ(catoptric::bvh::unpack_number(bvh.nodes[1].w), catoptric::bvh::count_nodes(bvh));
    EXPECT_EQ(census.nodes + 1, catoptric::bvh::count_nodes(bvh));
    EXPECT_LE(census.deepest, catoptric::bvh::kMaxTreeDepth);
    // A word that is stored in `w` must be a normal float, because devices may change other values
    // when they read floats. The second half of a node stores no words.
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i)
        EXPECT_EQ(std::isnormal(bvh.nodes[i].w), i % 4 < 2) << i;
    for (const vec4& texel : bvh.triangles) EXPECT_TRUE(std::isnormal(texel.w));
}

inline bool have_equal_bytes(const std::vector<vec4>& a, const std::vector<vec4>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(vec4)) == 0);
}

} // namespace test
