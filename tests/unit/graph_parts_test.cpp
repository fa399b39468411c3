// Tests of the graph planner's data structures against simple versions: one value per cell, and all
// pairs of placements.
#include "graph/memory_users.hpp"
#include "graph/run_length_array.hpp"
#include "support/frames.hpp"

#include <gtest/gtest.h>

#include <random>

namespace catoptric::graph {
namespace {

class RandomNumberDraw {
public:
    explicit RandomNumberDraw(unsigned seed) : random_(seed) {}
    std::uint32_t random_number_below(std::uint32_t count) {
        return static_cast<std::uint32_t>(random_()) % count;
    }

private:
    std::mt19937 random_;
};

std::vector<int> list_run_length_cells(const RunLengthArray<int>& runs) {
    std::vector<int> cells;
    runs.for_each_run([&](std::uint32_t begin, std::uint32_t end, int value) {
        cells.resize(cells.size() + (end - begin), value);
    });
    return cells;
}

TEST(Runs, RunsEqualOneValuePerCell) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        RandomNumberDraw draw(seed);
        const std::uint32_t size = draw.random_number_below(40) + 1;
        RunLengthArray<int> runs(size, 7);
        std::vector<int> cells(size, 7);
        for (int step = 0; step < 60; ++step) {
            const std::uint32_t first = draw.random_number_below(size),
                                end = first + draw.random_number_below(size - first + 1);
            const int value = static_cast<int>(draw.random_number_below(3));
            const bool set = draw.random_number_below(2) == 0;
            const auto change = [&](int& cell) { cell = set ? value : (cell + value) % 5; };
            runs.modify_runs(first, end,
                             [&](std::uint32_t, std::uint32_t, int& cell) { change(cell); });
            for (std::uint32_t i = first; i < end; ++i) change(cells[i]);
            ASSERT_EQ(list_run_length_cells(runs), cells) << "seed " << seed << ", step " << step;
            const auto begin = cells.begin();
            EXPECT_EQ(runs.has_any(first, end, value),
                      std::count(begin + first, begin + end, value) > 0);
        }
    }
}

TEST(Runs, NeighbouringRunsOfEqualValueAreJoined) {
    RunLengthArray<int> runs(100, 0);
    for (std::uint32_t i = 0; i < 100; i += 2) runs.fill(i, i + 1, 1);
    for (std::uint32_t i = 1; i < 100; i += 2) runs.fill(i, i + 1, 1);
    int count = 0;
    runs.for_each_run([&](std::uint32_t, std::uint32_t, int) { ++count; });
    EXPECT_EQ(count, 1);
}

MemoryPlacement make_placement(std::uint64_t offset, std::uint64_t bytes, std::uint32_t heap) {
    return {.used = true, .heap = heap, .offset = offset, .bytes = bytes};
}

TEST(MemoryUsers, MemoryUsersAreThoseOfAllOverlappingPlacements) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        RandomNumberDraw draw(seed);
        GraphPlan plan;
        plan.heap_bytes = {100, 100};
        const std::uint32_t count = draw.random_number_below(20) + 1;
        for (std::uint32_t i = 0; i < count; ++i)
            (i % 3 ? plan.images : plan.buffers)
                .push_back(make_placement(draw.random_number_below(60),
                                          draw.random_number_below(40) + 1,
                                          draw.random_number_below(2)));
        std::vector<MemoryPlacement> all = plan.images;
        all.insert(all.end(), plan.buffers.begin(), plan.buffers.end());
        MemoryUsers users(plan);
        std::vector<std::pair<MemoryPlacement, AccessSet>> left;
        for (int step = 0; step < 40; ++step) {
            const MemoryPlacement& mine = all[draw.random_number_below(count)];
            AccessSet expected = 0;
            for (const auto& [other, touches] : left)
                if (other.heap == mine.heap && other.offset < mine.offset + mine.bytes &&
                    mine.offset < other.offset + other.bytes)
                    expected |= touches;
            ASSERT_EQ(users.unfinished_accesses(mine), expected)
                << "seed " << seed << ", step " << step;
            const AccessSet touches = AccessSet{1} << draw.random_number_below(kAccessCodeCount);
            users.record(mine, touches);
            left.emplace_back(mine, touches);
        }
    }
}

TEST(Touches, TouchCodesAreOneToOne) {
    for (int use = 0; use <= static_cast<int>(ResourceUse::indirect); ++use)
        for (const bool write : {false, true})
            for (const bool raster : {false, true}) {
                const AccessState touch{.nothing = false,
                                        .use = static_cast<ResourceUse>(use),
                                        .write = write,
                                        .raster = raster};
                EXPECT_EQ(access_state(encode_access(touch)), touch);
                EXPECT_EQ(decode_use(encode_access(touch)), touch.use);
                EXPECT_LT(encode_access(touch), kAccessCodeCount);
            }
    EXPECT_EQ(access_state(encode_access({})), AccessState{});
}

/// Returns the lowest free offset for `mine`. Tries every offset against every image that lives at
/// the same time.
std::uint64_t find_lowest_free_offset(const std::vector<MemoryPlacement>& placed,
                                      const MemoryPlacement& mine, std::uint64_t alignment) {
    for (std::uint64_t offset = 0;; offset += alignment) {
        bool free = true;
        for (const MemoryPlacement& other : placed)
            free = free &&
                   (other.last < mine.first || mine.last < other.first ||
                    other.offset + other.bytes <= offset || offset + mine.bytes <= other.offset);
        if (free) return offset;
    }
}

/// The images have random sizes, and each lives from one random pass to another.
TEST(Places, ImagesGetTheLowestFreeOffset) {
    constexpr std::uint32_t kMaxPassCount = 12, kImages = 30;
    for (unsigned seed = 0; seed < 100; ++seed) {
        RandomNumberDraw draw(seed);
        Graph g;
        std::vector<ImageHandle> images;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> lives;
        for (std::uint32_t i = 0; i < kImages; ++i) {
            images.push_back(g.add_image(
                {.name = "i" + std::to_string(i), .width = draw.random_number_below(9) + 1}));
            const std::uint32_t first = draw.random_number_below(kMaxPassCount);
            lives.emplace_back(first, first + draw.random_number_below(kMaxPassCount - first));
        }
        const BufferHandle out = g.add_buffer({.name = "out", .bytes = 4});
        for (std::uint32_t p = 0; p < kMaxPassCount; ++p) {
            PassBuilder pass = g.add_pass("p" + std::to_string(p));
            pass.writes(out, p == 0 ? ResourceUse::storage_write : ResourceUse::storage);
            for (std::uint32_t i = 0; i < kImages; ++i) {
                if (lives[i].first == p) pass.writes(images[i], ResourceUse::storage_write);
                if (lives[i].second == p && lives[i].first < p)
                    pass.reads(images[i], ResourceUse::sampled);
            }
            pass.record([](PassCommands&) {});
        }
        g.output(out);
        const MemorySizer sizer{.image =
                                    [](const ImageDesc& desc) {
                                        return MemoryRequirements{
                                            .bytes = desc.width, .alignment = 2, .heap = 0};
                                    },
                                .buffer = default_sizer().buffer};
        const GraphPlan found = plan_graph(g, {}, sizer);
        std::vector<std::uint32_t> order(kImages);
        for (std::uint32_t i = 0; i < kImages; ++i) order[i] = i;
        std::ranges::stable_sort(order, std::greater<>(),
                                 [&](std::uint32_t i) { return found.images[i].bytes; });
        std::vector<MemoryPlacement> placed;
        for (const std::uint32_t i : order) {
            EXPECT_EQ(found.images[i].offset, find_lowest_free_offset(placed, found.images[i], 2))
                << "seed " << seed << ", image " << i;
            placed.push_back(found.images[i]);
        }
    }
}

TEST(LargeFrames, CapturesShareTheMemoryOfOneDepthImage) {
    constexpr std::uint32_t kMirrorCountOfGraph = 200;
    const Graph g = test::make_reuse_graph(kMirrorCountOfGraph);
    const GraphPlan found = plan_graph(g, {}, default_sizer());
    ASSERT_EQ(found.passes.size(), kMirrorCountOfGraph + 3);
    for (std::uint32_t n = 0; n < kMirrorCountOfGraph; ++n)
        EXPECT_EQ(found.images[6 + n].offset, found.images[6].offset);
    // Barriers of a capture pass are for its own layers of the cubes and of the distance maps, and
    // for the shared depth image.
    for (std::uint32_t n = 1; n < kMirrorCountOfGraph; ++n)
        EXPECT_EQ(found.passes[1 + n].barriers.size(), 3u);
    EXPECT_LT(found.bytes,
              2 * kMirrorCountOfGraph * 6 * 64 * 64 * (8 + 4) + 6 * 64 * 64 * 4 + 1000000u);
}

} // namespace
} // namespace catoptric::graph
