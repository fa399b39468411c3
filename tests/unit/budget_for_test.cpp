// Tests of the loading budget: the triangles, vertices and bytes that a scene file may contain on a
// machine.
#include "import/budget.hpp"

#include "support/folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace catoptric::scene {
namespace {

constexpr std::uint64_t kGibibyte = std::uint64_t{1} << 30;

class ChooseLoadBudgetTest : public test::InFolder {
protected:
    /// Creates a sparse file of `bytes` bytes, which occupies no disk space, and returns its path.
    std::filesystem::path write_sparse_file(std::uint64_t bytes) const {
        const std::filesystem::path path = folder / "scene.glb";
        std::ofstream(path).close();
        std::filesystem::resize_file(path, bytes);
        return path;
    }
};

TEST_F(ChooseLoadBudgetTest, SmallFileKeepsTheDefaultTriangleBudgetOnALargeMachine) {
    const LoadBudget budget = choose_budget(write_sparse_file(1000), {}, 1000 * kGibibyte);
    EXPECT_EQ(budget.triangles, LoadBudget().triangles);
    EXPECT_EQ(budget.vertices, LoadBudget().vertices);
    EXPECT_EQ(budget.shown, LoadBudget().shown);
    EXPECT_EQ(budget.file_bytes, 125 * kGibibyte);
}

TEST_F(ChooseLoadBudgetTest, LargeFileBudgetIsLimitedByFileSizeAndMemory) {
    const std::filesystem::path path = write_sparse_file(kGibibyte);
    EXPECT_EQ(choose_budget(path, {}, 1000 * kGibibyte).triangles, kGibibyte / 6);
    EXPECT_EQ(choose_budget(path, {}, 1000 * kGibibyte).vertices, 3 * (kGibibyte / 6));
    EXPECT_EQ(choose_budget(path, {}, 16 * kGibibyte).triangles,
              16 * kGibibyte / kRenderBytesPerTriangle);
    EXPECT_EQ(choose_budget(path, {}, kGibibyte).triangles, LoadBudget().triangles);
    EXPECT_EQ(choose_budget(path, {}, kGibibyte).file_bytes, LoadBudget().file_bytes);
}

TEST_F(ChooseLoadBudgetTest, UserLimitsReplaceComputedLimits) {
    const LoadBudget most = choose_budget(write_sparse_file(1000),
                                          {.bytes = 7, .triangles = 50'000'000}, 0);
    EXPECT_EQ(most.file_bytes, 7u);
    EXPECT_EQ(most.triangles, 50'000'000u);
    EXPECT_EQ(most.vertices, 150'000'000u);
    EXPECT_EQ(choose_budget(write_sparse_file(1000), {.triangles = 3}, 0).triangles, 3u);
    EXPECT_EQ(choose_budget(write_sparse_file(1000), {.triangles = 3}, 0).vertices,
              LoadBudget().vertices);
}

TEST_F(ChooseLoadBudgetTest, FreeMemoryOfTheMachineIsKnown) {
    EXPECT_GT(read_free_memory(), std::uint64_t{1} << 24);
}

} // namespace
} // namespace catoptric::scene
