// Tests of the render graph's planner: the frames of the seed report, and small graphs whose whole
// plan is known.
#include "replay.hpp"

#include "core/error.hpp"
#include "support/graphs.hpp"

#include <gmock/gmock.h>

#include <set>

namespace catoptric::graph {
namespace {

using test::kBlackClearColour, test::record_no_commands, test::plan_test_graph;

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint32_t kCaptureFaceTexels = 64;

std::vector<std::string> list_surviving_pass_names(const Graph& graph, const GraphPlan& plan) {
    std::vector<std::string> names;
    for (const PlannedPass& pass : plan.passes) names.push_back(graph.passes()[pass.pass].name);
    return names;
}

AccessState make_planned_access_state(ResourceUse use, bool write, bool raster) {
    return {.nothing = false, .use = use, .write = write, .raster = raster};
}
const AccessState kUntouchedAccess{};
const AccessState kColour = make_planned_access_state(ResourceUse::colour, true, true);
const AccessState kSampledInRaster = make_planned_access_state(ResourceUse::sampled, false, true);
const AccessState kSampledInCompute = make_planned_access_state(ResourceUse::sampled, false, false);
const AccessState kCopyReadAccess = make_planned_access_state(ResourceUse::copy_from, false, false);

/// Returns a barrier as text: the resource, [first layer,layer count], the use before and after,
/// and other uses that the barrier waits for.
std::string describe_planned_barrier(const PlannedBarrier& b) {
    const auto word = [](const AccessState& t) {
        return t.nothing ? std::string("nothing")
                         : std::string(use_name(t.use)) + (t.write ? "!" : "") +
                               (t.raster ? "/raster" : "");
    };
    std::string out = (b.is_buffer  ? "buffer "
                       : b.previous ? "previous "
                                    : "image ") +
                      std::to_string(b.id) + " [" + std::to_string(b.first_layer) + "," +
                      std::to_string(b.layer_count) + "] " + word(b.before) + " > " + word(b.after);
    for (const AccessState& t : b.shared) out += " +" + word(t);
    return out;
}

std::vector<std::string> list_barrier_texts(const GraphPlan& plan, std::size_t pass) {
    std::vector<std::string> all;
    for (const PlannedBarrier& b : plan.passes.at(pass).barriers)
        all.push_back(describe_planned_barrier(b));
    return all;
}

std::vector<std::string> list_last_barrier_texts(const GraphPlan& plan) {
    std::vector<std::string> all;
    for (const PlannedBarrier& b : plan.last) all.push_back(describe_planned_barrier(b));
    return all;
}

/// The passes that both frames of the seed report share: a shadow pass before the captures, and a
/// view pass after the captures.
struct SeedReportFrame {
    explicit SeedReportFrame(int mirror_count) : mirrors(static_cast<std::uint32_t>(mirror_count)) {
        g.add_pass("shadow", PassPurpose::scene)
            .writes(shadow, ResourceUse::depth, kBlackClearColour)
            .record(record_no_commands);
    }

    ImageHandle add_capture_image(const std::string& name) {
        return g.add_image({.name = name,
                            .width = kCaptureFaceTexels,
                            .height = kCaptureFaceTexels,
                            .layers = 6 * mirrors,
                            .cube = true});
    }

    /// Adds one scene pass per mirror. The pass draws the mirror's capture into `target` and may
    /// read `source`.
    void add_captures(const std::string& name, ImageHandle target,
                      std::optional<ImageHandle> source) {
        for (std::uint32_t n = 0; n < mirrors; ++n) {
            PassBuilder pass = g.add_pass(name + "/" + std::to_string(n), PassPurpose::scene);
            pass.reads(shadow, ResourceUse::sampled);
            if (source) pass.reads(*source, ResourceUse::sampled);
            pass.writes(target.layers(6 * n, 6), ResourceUse::colour, kBlackClearColour)
                .writes(depth, ResourceUse::depth, kBlackClearColour)
                .layers(6)
                .record(record_no_commands);
        }
    }

    void add_camera_view_pass(ImageHandle source) {
        g.add_pass("view", PassPurpose::scene)
            .reads(shadow, ResourceUse::sampled)
            .reads(source, ResourceUse::sampled)
            .writes(hdr, ResourceUse::colour, kBlackClearColour)
            .record(record_no_commands);
        g.add_pass("compose")
            .reads(hdr, ResourceUse::sampled)
            .writes(ldr, ResourceUse::colour, kBlackClearColour)
            .record(record_no_commands);
        g.output(ldr);
    }

    std::uint32_t mirrors;
    Graph g;
    ImageHandle shadow = g.add_image(
        {.name = "shadow", .format = TexelFormat::d32f, .width = 32, .height = 32});
    ImageHandle depth = g.add_image({.name = "depth",
                                     .format = TexelFormat::d32f,
                                     .width = kCaptureFaceTexels,
                                     .height = kCaptureFaceTexels,
                                     .layers = 6});
    ImageHandle hdr = g.add_image({.name = "hdr", .width = 32, .height = 32});
    ImageHandle ldr = g.add_image(
        {.name = "ldr", .format = TexelFormat::rgba8_unorm, .width = 32, .height = 32});
};

/// The frame of the seed report's part one: each bounce captures all mirrors again, with the
/// captures of the bounce before.
struct NaiveSeedReportFrame : SeedReportFrame {
    NaiveSeedReportFrame(int mirror_count, int bounces) : SeedReportFrame(mirror_count) {
        for (int k = 0; k < bounces; ++k) {
            images.push_back(add_capture_image("cubes" + std::to_string(k)));
            const bool first = k == 0;
            add_captures("capture" + std::to_string(k), images.back(),
                         first ? std::nullopt : std::optional(images[images.size() - 2]));
        }
        add_camera_view_pass(images.back());
    }
    std::vector<ImageHandle> images;
};

/// The frame of the seed report's part two: each mirror is captured once, and deeper bounces come
/// from the captures of the previous frame.
struct ReuseSeedReportFrame : SeedReportFrame {
    explicit ReuseSeedReportFrame(int mirror_count) : SeedReportFrame(mirror_count) {
        add_captures("capture", captured, g.previous(captured));
        add_camera_view_pass(captured);
    }
    ImageHandle captured = add_capture_image("cubes");
};

TEST(GraphPlan, NaiveFrameRendersTheSceneOncePerMirrorAndBounce) {
    for (const int mirrors : {1, 2, 4})
        for (const int bounces : {1, 2, 3, 7}) {
            const NaiveSeedReportFrame frame(mirrors, bounces);
            const GraphPlan plan = plan_test_graph(frame.g);
            EXPECT_EQ(plan.scene_passes, mirrors * bounces + 2);
            EXPECT_THAT(plan.culled, IsEmpty());
            EXPECT_THAT(replay_graph_plan(frame.g, plan, default_sizer()), IsEmpty());
        }
}

TEST(GraphPlan, NaiveFrameUsesTheMemoryOfTwoCubeImages) {
    for (const int bounces : {2, 3, 4, 8}) {
        const NaiveSeedReportFrame frame(4, bounces);
        const GraphPlan plan = plan_test_graph(frame.g);
        std::set<std::uint64_t> offsets;
        for (std::size_t k = 0; k < frame.images.size(); ++k) {
            offsets.insert(plan.images[frame.images[k].id].offset);
            if (k < 2) continue;
            EXPECT_EQ(plan.images[frame.images[k].id].offset,
                      plan.images[frame.images[k - 2].id].offset);
        }
        EXPECT_EQ(offsets.size(), 2u) << bounces << " bounces";
        EXPECT_EQ(plan.bytes, plan_test_graph(NaiveSeedReportFrame(4, 2).g).bytes)
            << bounces << " bounces";
    }
}

TEST(GraphPlan, ReusedMemoryWaitsForItsLastReader) {
    const NaiveSeedReportFrame frame(1, 3);
    const GraphPlan plan = plan_test_graph(
        frame.g); // passes: shadow, capture0, capture1, capture2, view, compose
    EXPECT_THAT(list_barrier_texts(plan, 3),
                ::testing::Contains("image 6 [0,6] nothing > colour!/raster "
                                    "+sampled/raster"));
}

TEST(GraphPlan, ReuseFrameRendersTheSceneOncePerMirror) {
    const ReuseSeedReportFrame frame(4);
    const GraphPlan plan = plan_test_graph(frame.g);
    EXPECT_EQ(plan.scene_passes, 6);
    EXPECT_THAT(replay_graph_plan(frame.g, plan, default_sizer()), IsEmpty());
}

TEST(GraphPlan, HistoryImageHasTwoCopiesAndSharesNoMemory) {
    const ReuseSeedReportFrame frame(4);
    const GraphPlan plan = plan_test_graph(frame.g);
    const MemoryPlacement& cubes = plan.images[frame.captured.id];
    EXPECT_TRUE(cubes.alone);
    EXPECT_EQ(cubes.bytes, 2u * 24 * kCaptureFaceTexels * kCaptureFaceTexels * 8);
    for (std::size_t i = 0; i < plan.images.size(); ++i)
        EXPECT_LE(plan.images[i].offset, cubes.offset) << "kept images come last";
    EXPECT_EQ(cubes.offset + cubes.bytes, plan.bytes);
}

TEST(GraphPlan, HistoryImageIsReadWithoutABarrierAndLeftReadable) {
    const ReuseSeedReportFrame frame(2);
    const GraphPlan plan = plan_test_graph(frame.g);
    for (const PlannedPass& pass : plan.passes)
        for (const PlannedBarrier& b : pass.barriers)
            EXPECT_FALSE(b.previous) << describe_planned_barrier(b);
    EXPECT_THAT(list_last_barrier_texts(plan),
                ElementsAre("image 3 [0,1] colour!/raster > copy_from",
                            "image 4 [0,12] sampled/raster > sampled"));
}

TEST(GraphPlan, HistoryContainsOnlyImagesOfThePreviousFrame) {
    Graph g(GraphHistory{.previous = {"cubes"}, .persistent = {}});
    const ImageHandle cubes = g.add_image({.name = "cubes"});
    const ImageHandle other = g.add_image({.name = "other"});
    EXPECT_TRUE(g.has_history(cubes));
    EXPECT_FALSE(g.has_history(other));
}

/// A graph with four images of equal size and a buffer. Each test adds its own passes.
struct SmallGraphPlanTest : ::testing::Test {
    Graph g;
    ImageHandle a = add_small_image("a"), b = add_small_image("b"), c = add_small_image("c"),
                d = add_small_image("d");
    BufferHandle args = g.add_buffer({.name = "args", .bytes = 64});

    ImageHandle add_small_image(const std::string& name) {
        return g.add_image({.name = name, .width = 8, .height = 8, .layers = 4});
    }
    PassBuilder add_clearing_pass(const std::string& name, ImageHandle image) {
        return g.add_pass(name)
            .writes(image, ResourceUse::colour, kBlackClearColour)
            .layers(image.layer_count);
    }
};

TEST_F(SmallGraphPlanTest, GraphWithoutOutputsHasNoPasses) {
    add_clearing_pass("a", a).record(record_no_commands);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(plan.passes, IsEmpty());
    EXPECT_EQ(plan.bytes, 0u);
    EXPECT_FALSE(plan.images[a.id].used);
}

TEST_F(SmallGraphPlanTest, UnneededPassIsCulledWithAReason) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("b", b)
        .reads(a, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    add_clearing_pass("c", c).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.output(c);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_surviving_pass_names(g, plan), ElementsAre("a", "c"));
    ASSERT_EQ(plan.culled.size(), 1u);
    EXPECT_EQ(plan.culled[0].pass, 1u);
    EXPECT_EQ(plan.culled[0].reason, "no output depends on what it writes: 'b', 'args'");
    EXPECT_FALSE(plan.images[b.id].used);
    EXPECT_FALSE(plan.buffers[args.id].used);
}

TEST_F(SmallGraphPlanTest, PassWhoseImageIsOverwrittenUnreadIsCulled) {
    add_clearing_pass("lost", a).record(record_no_commands);
    add_clearing_pass("seen", a).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    add_clearing_pass("wanted", a).record(record_no_commands);
    g.output(a);
    g.output(b);
    EXPECT_THAT(list_surviving_pass_names(g, plan_test_graph(g)),
                ElementsAre("seen", "b", "wanted"));
}

TEST_F(SmallGraphPlanTest, PassWhoseImageIsLoadedOrPartlyOverwrittenIsKept) {
    add_clearing_pass("base", a).record(record_no_commands);
    add_clearing_pass("part", a.layers(1, 2)).record(record_no_commands);
    g.add_pass("load").writes(a.layers(0, 1), ResourceUse::colour).record(record_no_commands);
    g.output(a);
    EXPECT_THAT(list_surviving_pass_names(g, plan_test_graph(g)),
                ElementsAre("base", "part", "load"));
}

TEST_F(SmallGraphPlanTest, PassWhoseLayersAreNotReadIsCulled) {
    add_clearing_pass("low", a.layers(0, 2)).record(record_no_commands);
    add_clearing_pass("high", a.layers(2, 2)).record(record_no_commands);
    add_clearing_pass("b", b)
        .reads(a.layers(0, 2), ResourceUse::sampled)
        .record(record_no_commands);
    g.output(b);
    EXPECT_THAT(list_surviving_pass_names(g, plan_test_graph(g)), ElementsAre("low", "b"));
}

TEST_F(SmallGraphPlanTest, PassWhoseImageTheNextFrameReadsIsKept) {
    add_clearing_pass("base", b).record(record_no_commands);
    // The next frame reads image `a`, so passes `history` and `base` are kept.
    add_clearing_pass("history", a).reads(b, ResourceUse::sampled).record(record_no_commands);
    add_clearing_pass("view", c)
        .reads(g.previous(a), ResourceUse::sampled)
        .record(record_no_commands);
    g.output(c);
    EXPECT_THAT(list_surviving_pass_names(g, plan_test_graph(g)),
                ElementsAre("base", "history", "view"));
}

TEST_F(SmallGraphPlanTest, OnlyTheLastWriterIsKeptForTheNextFrame) {
    add_clearing_pass("view", c)
        .reads(g.previous(a), ResourceUse::sampled)
        .record(record_no_commands);
    add_clearing_pass("lost", a).record(record_no_commands);
    add_clearing_pass("history", a)
        .reads(g.previous(b), ResourceUse::sampled)
        .record(record_no_commands);
    // Only pass `history`, which the next frame needs, reads image `b`.
    add_clearing_pass("deeper", b).record(record_no_commands);
    g.output(c);
    EXPECT_THAT(list_surviving_pass_names(g, plan_test_graph(g)),
                ElementsAre("view", "history", "deeper"));
}

TEST_F(SmallGraphPlanTest, HistoryThatFeedsOnlyItselfIsCulled) {
    add_clearing_pass("loop", a)
        .reads(g.previous(a), ResourceUse::sampled)
        .record(record_no_commands);
    add_clearing_pass("view", c).record(record_no_commands);
    g.output(c);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_surviving_pass_names(g, plan), ElementsAre("view"));
    EXPECT_FALSE(plan.images[a.id].used);
    EXPECT_EQ(plan.bytes, 4u * 64 * 8);
}

TEST_F(SmallGraphPlanTest, ImageLifetimeSpansFirstToLastUse) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("culled", d).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    add_clearing_pass("c", c).reads(b, ResourceUse::sampled).record(record_no_commands);
    g.output(c);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_EQ(plan.images[a.id].first, 0u);
    EXPECT_EQ(plan.images[a.id].last, 1u);
    EXPECT_EQ(plan.images[b.id].first, 1u);
    EXPECT_EQ(plan.images[b.id].last, 2u);
    EXPECT_FALSE(plan.images[a.id].alone);
    EXPECT_TRUE(plan.images[c.id].alone);
}

TEST_F(SmallGraphPlanTest, ImagesOfDifferentHeapsShareNoMemory) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    add_clearing_pass("c", c).reads(b, ResourceUse::sampled).record(record_no_commands);
    add_clearing_pass("d", d).reads(c, ResourceUse::sampled).record(record_no_commands);
    g.output(d);
    MemorySizer sizer = default_sizer();
    sizer.image = [](const ImageDesc& desc) {
        return MemoryRequirements{
            .bytes = 100, .alignment = 64, .heap = desc.name == "c" ? 3u : 1u};
    };
    const GraphPlan plan = graph::plan_graph(g, {}, sizer);
    EXPECT_THAT(plan.heap_bytes,
                ElementsAre(0u, 356u, 0u, 100u)); // image a at 0, b at 128, d at 256
    EXPECT_EQ(plan.images[c.id].heap, 3u);
    EXPECT_EQ(plan.images[c.id].offset, 0u);
    EXPECT_EQ(plan.bytes, 456u);
    EXPECT_THAT(replay_graph_plan(g, plan, sizer), IsEmpty());
}

TEST_F(SmallGraphPlanTest, FirstWriteAndReadAfterWriteNeedBarriers) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.output(b);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_barrier_texts(plan, 0), ElementsAre("image 0 [0,4] nothing > colour!/raster"));
    EXPECT_THAT(list_barrier_texts(plan, 1),
                ElementsAre("image 1 [0,4] nothing > colour!/raster",
                            "image 0 [0,4] colour!/raster > sampled/raster"));
    EXPECT_THAT(list_last_barrier_texts(plan),
                ElementsAre("image 1 [0,4] colour!/raster > copy_from"));
}

TEST_F(SmallGraphPlanTest, ReadAfterReadInTheSameLayoutNeedsNoBarrier) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    add_clearing_pass("c", c).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.output(b);
    g.output(c);
    EXPECT_THAT(list_barrier_texts(plan_test_graph(g), 2),
                ElementsAre("image 2 [0,4] nothing > colour!/raster"));
}

TEST_F(SmallGraphPlanTest, ReadInAnotherStageWaitsForTheFirstReader) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.add_pass("sum")
        .reads(a, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    add_clearing_pass("rewrite", a).record(record_no_commands);
    g.output(a);
    g.output(b);
    g.output(args);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_barrier_texts(plan, 2), ElementsAre("image 0 [0,4] sampled/raster > sampled"));
    EXPECT_THAT(list_barrier_texts(plan, 3),
                ElementsAre("image 0 [0,4] sampled/raster > colour!/raster +sampled"));
}

TEST_F(SmallGraphPlanTest, ReadInAnotherLayoutNeedsABarrier) {
    add_clearing_pass("a", a).record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.add_pass("copy")
        .reads(a, ResourceUse::copy_from)
        .writes(c, ResourceUse::copy_to)
        .record(record_no_commands);
    add_clearing_pass("d", d).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.output(b);
    g.output(c);
    g.output(d);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_barrier_texts(plan, 2), ElementsAre("image 0 [0,4] sampled/raster > copy_from",
                                                         "image 2 [0,4] nothing > copy_to!"));
    EXPECT_THAT(list_barrier_texts(plan, 3),
                ElementsAre("image 3 [0,4] nothing > colour!/raster",
                            "image 0 [0,4] copy_from > sampled/raster"));
}

TEST_F(SmallGraphPlanTest, WriteAfterWriteNeedsABarrier) {
    add_clearing_pass("a", a).record(record_no_commands);
    g.add_pass("blur").writes(a, ResourceUse::storage).record(record_no_commands);
    g.add_pass("again").writes(a, ResourceUse::storage).record(record_no_commands);
    g.output(a);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_barrier_texts(plan, 1),
                ElementsAre("image 0 [0,4] colour!/raster > storage!"));
    EXPECT_THAT(list_barrier_texts(plan, 2), ElementsAre("image 0 [0,4] storage! > storage!"));
}

TEST_F(SmallGraphPlanTest, BarriersMergeLayersOfEqualUse) {
    add_clearing_pass("low", a.layers(0, 2)).record(record_no_commands);
    g.add_pass("high")
        .writes(a.layers(2, 2), ResourceUse::storage_write)
        .record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.output(b);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_barrier_texts(plan, 2),
                ElementsAre("image 1 [0,4] nothing > colour!/raster",
                            "image 0 [0,2] colour!/raster > sampled/raster",
                            "image 0 [2,2] storage_write! > sampled/raster"));
}

TEST_F(SmallGraphPlanTest, BarriersDoNotMergeLayersOfDifferentUses) {
    add_clearing_pass("a", a).record(record_no_commands);
    g.add_pass("blur")
        .reads(a.layers(0, 2), ResourceUse::sampled)
        .writes(a.layers(2, 2), ResourceUse::storage_write)
        .record(record_no_commands);
    g.output(a);
    EXPECT_THAT(list_barrier_texts(plan_test_graph(g), 1),
                ElementsAre("image 0 [0,2] colour!/raster > sampled",
                            "image 0 [2,2] colour!/raster > storage_write!"));
}

TEST_F(SmallGraphPlanTest, BarriersDoNotMergeLayersOfDifferentFrames) {
    add_clearing_pass("a", a).record(record_no_commands);
    g.add_pass("sum")
        .reads(a, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    add_clearing_pass("b", b).reads(a, ResourceUse::sampled).record(record_no_commands);
    g.add_pass("copy")
        .reads(g.previous(a.layers(0, 2)), ResourceUse::copy_from)
        .reads(a.layers(2, 2), ResourceUse::copy_from)
        .writes(c, ResourceUse::copy_to)
        .record(record_no_commands);
    g.output(args);
    g.output(b);
    g.output(c);
    EXPECT_THAT(list_barrier_texts(plan_test_graph(g), 3),
                ElementsAre("previous 0 [0,2] sampled > copy_from +sampled/raster",
                            "image 0 [2,2] sampled > copy_from +sampled/raster",
                            "image 2 [0,4] nothing > copy_to!"));
}

TEST_F(SmallGraphPlanTest, BuffersNeedBarriersOnlyBetweenUses) {
    g.add_pass("fill").writes(args, ResourceUse::storage_write).record(record_no_commands);
    add_clearing_pass("a", a).reads(args, ResourceUse::indirect).record(record_no_commands);
    g.add_pass("b")
        .reads(args, ResourceUse::storage_read)
        .writes(b, ResourceUse::storage_write)
        .record(record_no_commands);
    g.add_pass("refill").writes(args, ResourceUse::copy_to).record(record_no_commands);
    g.output(a);
    g.output(b);
    g.output(args);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(list_barrier_texts(plan, 0), IsEmpty());
    EXPECT_THAT(list_barrier_texts(plan, 1), ElementsAre("image 0 [0,4] nothing > colour!/raster",
                                                         "buffer 0 [0,1] storage_write! > "
                                                         "indirect/raster"));
    EXPECT_THAT(list_barrier_texts(plan, 2),
                ElementsAre("image 1 [0,4] nothing > storage_write!",
                            "buffer 0 [0,1] storage_write! > storage_read"));
    EXPECT_THAT(list_barrier_texts(plan, 3),
                ElementsAre("buffer 0 [0,1] indirect/raster > copy_to! +storage_read"));
    EXPECT_EQ(list_last_barrier_texts(plan).back(), "buffer 0 [0,1] copy_to! > copy_from");
}

TEST_F(SmallGraphPlanTest, HistoryImageAsOutputIsLeftSampledInAllLayers) {
    add_clearing_pass("a", a.layers(0, 2))
        .reads(g.previous(a.layers(0, 2)), ResourceUse::sampled)
        .record(record_no_commands);
    g.output(a.layers(0, 1));
    EXPECT_THAT(
        list_last_barrier_texts(plan_test_graph(g)),
        ElementsAre("image 0 [0,2] colour!/raster > sampled", "image 0 [2,2] nothing > sampled"));
}

TEST_F(SmallGraphPlanTest, OverlappingOutputsGetOneFinalBarrier) {
    add_clearing_pass("a", a).record(record_no_commands);
    g.output(a.layers(0, 3));
    g.output(a.layers(1, 2));
    EXPECT_THAT(list_last_barrier_texts(plan_test_graph(g)),
                ElementsAre("image 0 [0,3] colour!/raster > copy_from"));
}

TEST_F(SmallGraphPlanTest, ReadOfThePreviousFrameInAnotherLayoutNeedsABarrier) {
    g.add_pass("copy")
        .reads(g.previous(a), ResourceUse::copy_from)
        .writes(b, ResourceUse::copy_to)
        .record(record_no_commands);
    add_clearing_pass("a", a).record(record_no_commands);
    g.output(b);
    EXPECT_THAT(list_barrier_texts(plan_test_graph(g), 0),
                ElementsAre("previous 0 [0,4] sampled > copy_from +sampled/raster",
                            "image 1 [0,4] nothing > copy_to!"));
}

TEST(PlainSizer, SizerCountsTexelsAndPadsTo256Bytes) {
    const MemoryRequirements image = default_sizer().image(
        {.name = "x", .format = TexelFormat::rgba16f, .width = 5, .height = 3, .layers = 6});
    EXPECT_EQ(image.bytes, 768u); // 720 bytes, padded to a multiple of 256
    EXPECT_EQ(image.alignment, 256u);
    EXPECT_EQ(default_sizer().buffer({.name = "y", .bytes = 256}).bytes, 256u);
}

} // namespace
} // namespace catoptric::graph
