// Tests of the tree in which shaders search for the next mirror on a ray. The test decodes the
// nodes in the same way as the shaders.
#include "render/mirror_tree.hpp"

#include "bvh/words.hpp"
#include "support/numbers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using namespace catoptric;

struct MirrorTreeNode {
    explicit MirrorTreeNode(const std::vector<vec4>& tree, std::size_t i)
        : lowest(tree[2 * i]), highest(tree[2 * i + 1]), mirror(bvh::unpack_number(tree[2 * i].w)),
          past(bvh::unpack_number(tree[2 * i + 1].w)) {}
    bool does_node_enclose_box(const vec3& lo, const vec3& hi) const {
        return all(lessThanEqual(lowest, lo)) && all(lessThanEqual(hi, highest));
    }
    vec3 lowest, highest;
    std::uint32_t mirror, past;
};

/// Returns random mirrors. Two of three are exact spheres, the others are boxes. The `lowest` and
/// `highest` of a sphere lie elsewhere, because the tree must not use them for spheres.
std::vector<shared::Probe> make_random_probes(std::size_t count) {
    test::RandomNumbers numbers(3);
    std::vector<shared::Probe> probes(count);
    for (std::size_t i = 0; i < count; ++i) {
        probes[i].sphere = numbers.random_point_in_cube();
        probes[i].radius = i % 3 == 0 ? 0 : numbers.random_number_between(.01f, .3f);
        probes[i].lowest = numbers.random_point_in_cube() + 4.0f;
        probes[i].highest = probes[i].lowest + numbers.random_unit_fraction();
    }
    return probes;
}

TEST(MirrorTree, TreeHoldsEachMirrorOnceWithinTheBoxesOfItsNodes) {
    for (const std::size_t count : {1, 2, 3, 9, 64, 500}) {
        const std::vector<shared::Probe> mirrors = make_random_probes(count);
        const std::vector<vec4> tree = render::build_mirror_tree(mirrors);
        ASSERT_EQ(tree.size(), 2 * (2 * count - 1));
        std::vector<int> met(count);
        for (std::size_t i = 0; i < tree.size() / 2; ++i) {
            const MirrorTreeNode node(tree, i);
            ASSERT_GT(node.past, i);
            ASSERT_LE(node.past, tree.size() / 2);
            for (std::size_t below = i; below < node.past; ++below) {
                const MirrorTreeNode leaf(tree, below);
                if (leaf.mirror == 0) continue;
                const shared::Probe& mirror = mirrors[leaf.mirror - 1];
                const vec3 reach(mirror.radius);
                const bool is_sphere = mirror.radius > 0;
                EXPECT_TRUE(
                    node.does_node_enclose_box(is_sphere ? mirror.sphere - reach : mirror.lowest,
                                               is_sphere ? mirror.sphere + reach : mirror.highest))
                    << "mirror " << leaf.mirror << " of " << count << " below node " << i;
            }
            if (node.mirror == 0) continue;
            EXPECT_EQ(node.past, i + 1) << "nothing is below a mirror";
            ++met[node.mirror - 1];
        }
        EXPECT_THAT(met, testing::Each(1)) << count;
    }
    EXPECT_TRUE(render::build_mirror_tree({}).empty());
}

} // namespace
