// Where there is no memory for a tree its builder says so, whichever of its threads wanted some.
#include "allocations/counting.hpp"
#include "support/hierarchies.hpp"

#include <new>

namespace {

using namespace catoptric;

TEST(Hierarchy, MemoryThatIsRefusedToAnyThreadIsSaidByTheCall) {
    const std::vector<bvh::Triangle> triangles = test::soup(10000, 1); // a few subtrees
    const bvh::Bvh whole = bvh::build(triangles, {}, bvh::kMaxLeaf, 3);
    std::size_t refused = 0;
    for (bool done = false; !done; refused += done ? 0 : 1) {
        ASSERT_LT(refused, 1000u);
        const test::Refusal refusal(refused);
        try {
            const bvh::Bvh tree = bvh::build(triangles, {}, bvh::kMaxLeaf, 3);
            done = true;
            EXPECT_TRUE(test::same(tree.nodes, whole.nodes));
            EXPECT_TRUE(test::same(tree.triangles, whole.triangles));
        } catch (const std::bad_alloc&) {
        }
    }
    EXPECT_GT(refused, 10u);
}

} // namespace
