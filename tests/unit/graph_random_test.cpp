// Tests of the plans of random render graphs. A simulated replay checks each plan, and must find
// the error in plans that were broken on purpose.
#include "graph/dump.hpp"
#include "replay.hpp"

#include <gmock/gmock.h>

namespace catoptric::graph {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

constexpr unsigned kRandomGraphCount = 500;

/// Returns memory requirements with two heaps, and with alignments that do not divide the sizes.
MemorySizer make_memory_queries_with_two_heaps() {
    return {.image =
                [](const ImageDesc& desc) {
                    return MemoryRequirements{.bytes = std::uint64_t{desc.layers} * 1000 *
                                                       bytes_per_texel(desc.format),
                                              .alignment = desc.layers % 2 ? 256u : 96u,
                                              .heap = is_depth(desc.format) ? 2u : 0u};
                },
            .buffer =
                [](const BufferDesc& desc) {
                    return MemoryRequirements{.bytes = desc.bytes, .alignment = 64, .heap = 0};
                }};
}

struct RandomGraphSample {
    explicit RandomGraphSample(unsigned seed)
        : sizer(seed % 2 ? make_memory_queries_with_two_heaps() : default_sizer()) {
        std::mt19937 random(seed);
        graph = make_random_graph(random);
        right = plan_graph(graph, {}, sizer);
    }
    /// Expects that the replay reports an error in the broken plan `wrong`.
    void expect_replay_error(const GraphPlan& wrong, const std::string& mistake) const {
        EXPECT_THAT(replay_graph_plan(graph, wrong, sizer), Not(IsEmpty()))
            << mistake << "\n"
            << plan_to_text(graph, right);
    }
    MemorySizer sizer;
    Graph graph;
    GraphPlan right;
};

/// Calls `test` with the random graph of every seed.
template <typename Test>
void for_each_random_graph(const Test& test) {
    for (unsigned seed = 0; seed < kRandomGraphCount; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        test(RandomGraphSample(seed));
    }
}

/// Calls `test` for every barrier of the plan, with a copy of the plan that `test` may break.
template <typename Test>
void for_each_barrier(const GraphPlan& right, const Test& test) {
    for (std::size_t p = 0; p < right.passes.size(); ++p)
        for (std::size_t b = 0; b < right.passes[p].barriers.size(); ++b) {
            GraphPlan wrong = right;
            test(wrong, wrong.passes[p].barriers, b);
        }
}

TEST(RandomGraphs, PlansOfRandomGraphsReplayWithoutErrors) {
    for_each_random_graph([](const RandomGraphSample& sample) {
        EXPECT_THAT(replay_graph_plan(sample.graph, sample.right, sample.sizer), IsEmpty());
    });
}

TEST(RandomGraphs, ReplayDetectsAMissingBarrier) {
    for_each_random_graph([](const RandomGraphSample& sample) {
        for_each_barrier(sample.right, [&](GraphPlan& wrong, std::vector<PlannedBarrier>& barriers,
                                           std::size_t b) {
            barriers.erase(barriers.begin() + static_cast<std::ptrdiff_t>(b));
            sample.expect_replay_error(wrong, "without barrier " + std::to_string(b));
        });
    });
}

TEST(RandomGraphs, ReplayDetectsAMissingReaderOfABarrier) {
    for_each_random_graph([](const RandomGraphSample& sample) {
        for_each_barrier(sample.right, [&](GraphPlan& wrong, std::vector<PlannedBarrier>& barriers,
                                           std::size_t b) {
            // Skips barriers with redundant readers. A wait for the last user of memory includes
            // earlier users, and no pass writes to images of the previous frame.
            if (barriers[b].before.nothing || barriers[b].previous) return;
            if (barriers[b].shared.empty()) return;
            barriers[b].shared.pop_back();
            sample.expect_replay_error(wrong,
                                       "with one reader less in barrier " + std::to_string(b));
        });
    });
}

TEST(RandomGraphs, ReplayDetectsAMissingPass) {
    for_each_random_graph([](const RandomGraphSample& sample) {
        for (std::size_t p = 0; p < sample.right.passes.size(); ++p) {
            GraphPlan wrong = sample.right;
            wrong.culled.push_back({wrong.passes[p].pass, "mistake"});
            wrong.passes.erase(wrong.passes.begin() + static_cast<std::ptrdiff_t>(p));
            sample.expect_replay_error(wrong, "without pass " + std::to_string(p));
        }
    });
}

TEST(RandomGraphs, ReplayDetectsOverlappingMemory) {
    for_each_random_graph([](const RandomGraphSample& sample) {
        for (std::size_t i = 0; i < sample.right.images.size(); ++i) {
            if (sample.right.images[i].offset == 0) continue;
            GraphPlan wrong = sample.right;
            wrong.images[i].offset = 0; // another image needs this memory at the same time
            wrong.images[i].heap = sample.right.images[i].heap;
            sample.expect_replay_error(wrong, "with image " + std::to_string(i) + " at 0");
        }
    });
}

// The replay discards attachments that the plan marks as unread. Marking any other attachment as
// unread must be an error.
TEST(RandomGraphs, ReplayDetectsAnAttachmentThatIsNotStored) {
    int unread = 0;
    for_each_random_graph([&](const RandomGraphSample& sample) {
        for (std::size_t p = 0; p < sample.right.passes.size(); ++p) {
            const PlannedPass& planned = sample.right.passes[p];
            const Pass& pass = sample.graph.passes()[planned.pass];
            for (std::size_t i = 0; i < pass.images.size(); ++i) {
                const ImageUse& use = pass.images[i];
                if (!use.write || (use.use != ResourceUse::colour && use.use != ResourceUse::depth))
                    continue;
                if (planned.unread >> i & 1) {
                    ++unread;
                    continue;
                }
                GraphPlan wrong = sample.right;
                wrong.passes[p].unread |= 1u << i;
                sample.expect_replay_error(wrong, "without attachment " + std::to_string(i));
            }
        }
    });
    EXPECT_GT(unread, 0);
}

// Together, the random graphs use every feature of plans, such as culling, shared memory and
// history.
TEST(RandomGraphs, RandomGraphsUseEveryFeatureOfPlans) {
    int culled = 0, aliased = 0, kept = 0, chained = 0, changed = 0, several = 0, empty = 0;
    for (unsigned seed = 0; seed < kRandomGraphCount; ++seed) {
        std::mt19937 random(seed);
        const Graph graph = make_random_graph(random);
        const GraphPlan plan = graph::plan_graph(graph, {}, default_sizer());
        culled += plan.culled.empty() ? 0 : 1;
        empty += plan.passes.empty() ? 1 : 0;
        for (std::uint32_t i = 0; i < plan.images.size(); ++i)
            kept += plan.images[i].used && (graph.image_lifetime(i) == Lifetime::previous) ? 1 : 0;
        for (const PlannedPass& pass : plan.passes)
            for (const PlannedBarrier& b : pass.barriers) {
                const bool read_after_read = !b.before.nothing && !b.before.write && !b.after.write;
                aliased += b.before.nothing && !b.shared.empty() ? 1 : 0;
                chained += read_after_read && b.before.use == b.after.use ? 1 : 0;
                changed += read_after_read && b.before.use != b.after.use ? 1 : 0;
                several += !b.before.nothing && !b.shared.empty() ? 1 : 0;
            }
    }
    EXPECT_GT(culled, 100);
    EXPECT_GT(aliased, 30);
    EXPECT_GT(kept, 100);
    EXPECT_GT(chained, 30);
    EXPECT_GT(changed, 100);
    EXPECT_GT(several, 50);
    EXPECT_LT(empty, 20);
}

} // namespace
} // namespace catoptric::graph
