// Tests that building a tree throws std::bad_alloc if an allocation fails, on whichever of its
// threads.
#include "allocations/counting.hpp"
#include "support/hierarchies.hpp"

#include <new>

namespace {

using namespace catoptric;

TEST(Hierarchy, BuildThrowsIfAnAllocationFailsOnAnyThread) {
    // 10000 triangles are enough for a few subtrees, so that several threads allocate.
    const std::vector<bvh::Triangle> triangles = test::make_random_triangles(10000, 1);
    const bvh::Bvh whole = bvh::build(triangles, {}, bvh::kMaxLeafTriangles, 3);
    std::size_t refused = 0;
    for (bool done = false; !done; refused += done ? 0 : 1) {
        ASSERT_LT(refused, 1000u);
        const test::ScopedAllocationRefusal refusal(refused);
        try {
            const bvh::Bvh tree = bvh::build(triangles, {}, bvh::kMaxLeafTriangles, 3);
            done = true;
            EXPECT_TRUE(test::have_equal_bytes(tree.nodes, whole.nodes));
            EXPECT_TRUE(test::have_equal_bytes(tree.triangles, whole.triangles));
        } catch (const std::bad_alloc&) {
        }
    }
    EXPECT_GT(refused, 10u);
}

} // namespace
