// Tests of the render graph's planner: the frames of the seed report, and small graphs whose whole
// plan is known.
#include "replay.hpp"

#include "core/error.hpp"
#include "support/graphs.hpp"

#include <gmock/gmock.h>

#include <set>

namespace catoptric::graph {
namespace {

using test::kClearToBlack, test::record_nothing, test::plan_test_graph;

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint32_t kFace = 64;

std::vector<std::string> names_of(const Graph& graph, const GraphPlan& plan) {
    std::vector<std::string> names;
    for (const PlannedPass& pass : plan.passes) names.push_back(graph.passes()[pass.pass].name);
    return names;
}

ResourceTouch touch(ResourceUse use, bool write, bool raster) {
    return {.nothing = false, .use = use, .write = write, .raster = raster};
}
const ResourceTouch kFresh{};
const ResourceTouch kColour = touch(ResourceUse::colour, true, true);
const ResourceTouch kSampledInRaster = touch(ResourceUse::sampled, false, true);
const ResourceTouch kSampledInCompute = touch(ResourceUse::sampled, false, false);
const ResourceTouch kCopied = touch(ResourceUse::copy_from, false, false);

/// Returns a barrier as text: the resource, [first layer,layer count], the use before and after,
/// and other uses that the barrier waits for.
std::string graph_plan_text(const PlannedBarrier& b) {
    const auto word = [](const ResourceTouch& t) {
        return t.nothing ? std::string("nothing")
                         : std::string(name_of(t.use)) + (t.write ? "!" : "") +
                               (t.raster ? "/raster" : "");
    };
    std::string out = (b.is_buffer  ? "buffer "
                       : b.previous ? "previous "
                                    : "image ") +
                      std::to_string(b.id) + " [" + std::to_string(b.first_layer) + "," +
                      std::to_string(b.layer_count) + "] " + word(b.before) + " > " + word(b.after);
    for (const ResourceTouch& t : b.shared) out += " +" + word(t);
    return out;
}

std::vector<std::string> barriers_of(const GraphPlan& plan, std::size_t pass) {
    std::vector<std::string> all;
    for (const PlannedBarrier& b : plan.passes.at(pass).barriers) all.push_back(graph_plan_text(b));
    return all;
}

std::vector<std::string> last_barriers(const GraphPlan& plan) {
    std::vector<std::string> all;
    for (const PlannedBarrier& b : plan.last) all.push_back(graph_plan_text(b));
    return all;
}

/// The passes that both frames of the seed report share: a shadow pass before the captures, and a
/// view pass after the captures.
struct Frame {
    explicit Frame(int mirror_count) : mirrors(static_cast<std::uint32_t>(mirror_count)) {
        g.add_pass("shadow", PassTag::scene)
            .writes(shadow, ResourceUse::depth, kClearToBlack)
            .record(record_nothing);
    }

    ImageHandle cubes(const std::string& name) {
        return g.add_image(
            {.name = name, .width = kFace, .height = kFace, .layers = 6 * mirrors, .cube = true});
    }

    /// Adds one scene pass per mirror. The pass draws the mirror's capture into `target` and may
    /// read `source`.
    void capture(const std::string& name, ImageHandle target, std::optional<ImageHandle> source) {
        for (std::uint32_t n = 0; n < mirrors; ++n) {
            PassBuilder pass = g.add_pass(name + "/" + std::to_string(n), PassTag::scene);
            pass.reads(shadow, ResourceUse::sampled);
            if (source) pass.reads(*source, ResourceUse::sampled);
            pass.writes(target.layers(6 * n, 6), ResourceUse::colour, kClearToBlack)
                .writes(depth, ResourceUse::depth, kClearToBlack)
                .set_layer_count(6)
                .record(record_nothing);
        }
    }

    void view(ImageHandle source) {
        g.add_pass("view", PassTag::scene)
            .reads(shadow, ResourceUse::sampled)
            .reads(source, ResourceUse::sampled)
            .writes(hdr, ResourceUse::colour, kClearToBlack)
            .record(record_nothing);
        g.add_pass("compose")
            .reads(hdr, ResourceUse::sampled)
            .writes(ldr, ResourceUse::colour, kClearToBlack)
            .record(record_nothing);
        g.mark_output(ldr);
    }

    std::uint32_t mirrors;
    Graph g;
    ImageHandle shadow = g.add_image(
        {.name = "shadow", .format = Format::d32f, .width = 32, .height = 32});
    ImageHandle depth = g.add_image(
        {.name = "depth", .format = Format::d32f, .width = kFace, .height = kFace, .layers = 6});
    ImageHandle hdr = g.add_image({.name = "hdr", .width = 32, .height = 32});
    ImageHandle ldr = g.add_image(
        {.name = "ldr", .format = Format::rgba8_unorm, .width = 32, .height = 32});
};

/// The frame of the seed report's part one: each bounce captures all mirrors again, with the
/// captures of the bounce before.
struct NaiveFrame : Frame {
    NaiveFrame(int mirror_count, int bounces) : Frame(mirror_count) {
        for (int k = 0; k < bounces; ++k) {
            images.push_back(cubes("cubes" + std::to_string(k)));
            const bool first = k == 0;
            capture("capture" + std::to_string(k), images.back(),
                    first ? std::nullopt : std::optional(images[images.size() - 2]));
        }
        view(images.back());
    }
    std::vector<ImageHandle> images;
};

/// The frame of the seed report's part two: each mirror is captured once, and deeper bounces come
/// from the captures of the previous frame.
struct ReuseFrame : Frame {
    explicit ReuseFrame(int mirror_count) : Frame(mirror_count) {
        capture("capture", captured, g.previous_contents(captured));
        view(captured);
    }
    ImageHandle captured = cubes("cubes");
};

TEST(GraphPlan, NaiveFrameRendersTheSceneOncePerMirrorAndBounce) {
    for (const int mirrors : {1, 2, 4})
        for (const int bounces : {1, 2, 3, 7}) {
            const NaiveFrame frame(mirrors, bounces);
            const GraphPlan plan = plan_test_graph(frame.g);
            EXPECT_EQ(plan.scene_passes, mirrors * bounces + 2);
            EXPECT_THAT(plan.culled, IsEmpty());
            EXPECT_THAT(replay(frame.g, plan, make_default_sizer()), IsEmpty());
        }
}

TEST(GraphPlan, NaiveFrameUsesTheMemoryOfTwoCubeImages) {
    for (const int bounces : {2, 3, 4, 8}) {
        const NaiveFrame frame(4, bounces);
        const GraphPlan plan = plan_test_graph(frame.g);
        std::set<std::uint64_t> offsets;
        for (std::size_t k = 0; k < frame.images.size(); ++k) {
            offsets.insert(plan.images[frame.images[k].id].offset);
            if (k < 2) continue;
            EXPECT_EQ(plan.images[frame.images[k].id].offset,
                      plan.images[frame.images[k - 2].id].offset);
        }
        EXPECT_EQ(offsets.size(), 2u) << bounces << " bounces";
        EXPECT_EQ(plan.bytes, plan_test_graph(NaiveFrame(4, 2).g).bytes) << bounces << " bounces";
    }
}

TEST(GraphPlan, ReusedMemoryWaitsForItsLastReader) {
    const NaiveFrame frame(1, 3);
    const GraphPlan plan = plan_test_graph(
        frame.g); // passes: shadow, capture0, capture1, capture2, view, compose
    EXPECT_THAT(barriers_of(plan, 3), ::testing::Contains("image 6 [0,6] nothing > colour!/raster "
                                                          "+sampled/raster"));
}

TEST(GraphPlan, ReuseFrameRendersTheSceneOncePerMirror) {
    const ReuseFrame frame(4);
    const GraphPlan plan = plan_test_graph(frame.g);
    EXPECT_EQ(plan.scene_passes, 6);
    EXPECT_THAT(replay(frame.g, plan, make_default_sizer()), IsEmpty());
}

TEST(GraphPlan, HistoryImageHasTwoCopiesAndSharesNoMemory) {
    const ReuseFrame frame(4);
    const GraphPlan plan = plan_test_graph(frame.g);
    const MemoryPlacement& cubes = plan.images[frame.captured.id];
    EXPECT_TRUE(cubes.alone);
    EXPECT_EQ(cubes.bytes, 2u * 24 * kFace * kFace * 8);
    for (std::size_t i = 0; i < plan.images.size(); ++i)
        EXPECT_LE(plan.images[i].offset, cubes.offset) << "kept images come last";
    EXPECT_EQ(cubes.offset + cubes.bytes, plan.bytes);
}

TEST(GraphPlan, HistoryImageIsReadWithoutABarrierAndLeftReadable) {
    const ReuseFrame frame(2);
    const GraphPlan plan = plan_test_graph(frame.g);
    for (const PlannedPass& pass : plan.passes)
        for (const PlannedBarrier& b : pass.barriers)
            EXPECT_FALSE(b.previous) << graph_plan_text(b);
    EXPECT_THAT(last_barriers(plan), ElementsAre("image 3 [0,1] colour!/raster > copy_from",
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
struct SmallGraph : ::testing::Test {
    Graph g;
    ImageHandle a = add("a"), b = add("b"), c = add("c"), d = add("d");
    BufferHandle args = g.add_buffer({.name = "args", .bytes = 64});

    ImageHandle add(const std::string& name) {
        return g.add_image({.name = name, .width = 8, .height = 8, .layers = 4});
    }
    PassBuilder fill(const std::string& name, ImageHandle image) {
        return g.add_pass(name)
            .writes(image, ResourceUse::colour, kClearToBlack)
            .set_layer_count(image.layer_count);
    }
};

TEST_F(SmallGraph, GraphWithoutOutputsHasNoPasses) {
    fill("a", a).record(record_nothing);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(plan.passes, IsEmpty());
    EXPECT_EQ(plan.bytes, 0u);
    EXPECT_FALSE(plan.images[a.id].used);
}

TEST_F(SmallGraph, UnneededPassIsCulledWithAReason) {
    fill("a", a).record(record_nothing);
    fill("b", b)
        .reads(a, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_nothing);
    fill("c", c).reads(a, ResourceUse::sampled).record(record_nothing);
    g.mark_output(c);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(names_of(g, plan), ElementsAre("a", "c"));
    ASSERT_EQ(plan.culled.size(), 1u);
    EXPECT_EQ(plan.culled[0].pass, 1u);
    EXPECT_EQ(plan.culled[0].reason, "nobody wants what it writes: 'b', 'args'");
    EXPECT_FALSE(plan.images[b.id].used);
    EXPECT_FALSE(plan.buffers[args.id].used);
}

TEST_F(SmallGraph, PassWhoseImageIsOverwrittenUnreadIsCulled) {
    fill("lost", a).record(record_nothing);
    fill("seen", a).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    fill("wanted", a).record(record_nothing);
    g.mark_output(a);
    g.mark_output(b);
    EXPECT_THAT(names_of(g, plan_test_graph(g)), ElementsAre("seen", "b", "wanted"));
}

TEST_F(SmallGraph, PassWhoseImageIsLoadedOrPartlyOverwrittenIsKept) {
    fill("base", a).record(record_nothing);
    fill("part", a.layers(1, 2)).record(record_nothing);
    g.add_pass("load").writes(a.layers(0, 1), ResourceUse::colour).record(record_nothing);
    g.mark_output(a);
    EXPECT_THAT(names_of(g, plan_test_graph(g)), ElementsAre("base", "part", "load"));
}

TEST_F(SmallGraph, PassWhoseLayersAreNotReadIsCulled) {
    fill("low", a.layers(0, 2)).record(record_nothing);
    fill("high", a.layers(2, 2)).record(record_nothing);
    fill("b", b).reads(a.layers(0, 2), ResourceUse::sampled).record(record_nothing);
    g.mark_output(b);
    EXPECT_THAT(names_of(g, plan_test_graph(g)), ElementsAre("low", "b"));
}

TEST_F(SmallGraph, PassWhoseImageTheNextFrameReadsIsKept) {
    fill("base", b).record(record_nothing);
    // The next frame reads image `a`, so passes `history` and `base` are kept.
    fill("history", a).reads(b, ResourceUse::sampled).record(record_nothing);
    fill("view", c).reads(g.previous_contents(a), ResourceUse::sampled).record(record_nothing);
    g.mark_output(c);
    EXPECT_THAT(names_of(g, plan_test_graph(g)), ElementsAre("base", "history", "view"));
}

TEST_F(SmallGraph, OnlyTheLastWriterIsKeptForTheNextFrame) {
    fill("view", c).reads(g.previous_contents(a), ResourceUse::sampled).record(record_nothing);
    fill("lost", a).record(record_nothing);
    fill("history", a).reads(g.previous_contents(b), ResourceUse::sampled).record(record_nothing);
    // Only pass `history`, which the next frame needs, reads image `b`.
    fill("deeper", b).record(record_nothing);
    g.mark_output(c);
    EXPECT_THAT(names_of(g, plan_test_graph(g)), ElementsAre("view", "history", "deeper"));
}

TEST_F(SmallGraph, HistoryThatFeedsOnlyItselfIsCulled) {
    fill("loop", a).reads(g.previous_contents(a), ResourceUse::sampled).record(record_nothing);
    fill("view", c).record(record_nothing);
    g.mark_output(c);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(names_of(g, plan), ElementsAre("view"));
    EXPECT_FALSE(plan.images[a.id].used);
    EXPECT_EQ(plan.bytes, 4u * 64 * 8);
}

TEST_F(SmallGraph, ImageLifetimeSpansFirstToLastUse) {
    fill("a", a).record(record_nothing);
    fill("culled", d).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    fill("c", c).reads(b, ResourceUse::sampled).record(record_nothing);
    g.mark_output(c);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_EQ(plan.images[a.id].first, 0u);
    EXPECT_EQ(plan.images[a.id].last, 1u);
    EXPECT_EQ(plan.images[b.id].first, 1u);
    EXPECT_EQ(plan.images[b.id].last, 2u);
    EXPECT_FALSE(plan.images[a.id].alone);
    EXPECT_TRUE(plan.images[c.id].alone);
}

TEST_F(SmallGraph, ImagesOfDifferentHeapsShareNoMemory) {
    fill("a", a).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    fill("c", c).reads(b, ResourceUse::sampled).record(record_nothing);
    fill("d", d).reads(c, ResourceUse::sampled).record(record_nothing);
    g.mark_output(d);
    MemorySizer sizer = make_default_sizer();
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
    EXPECT_THAT(replay(g, plan, sizer), IsEmpty());
}

TEST_F(SmallGraph, FirstWriteAndReadAfterWriteNeedBarriers) {
    fill("a", a).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    g.mark_output(b);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(barriers_of(plan, 0), ElementsAre("image 0 [0,4] nothing > colour!/raster"));
    EXPECT_THAT(barriers_of(plan, 1), ElementsAre("image 1 [0,4] nothing > colour!/raster",
                                                  "image 0 [0,4] colour!/raster > sampled/raster"));
    EXPECT_THAT(last_barriers(plan), ElementsAre("image 1 [0,4] colour!/raster > copy_from"));
}

TEST_F(SmallGraph, ReadAfterReadInTheSameLayoutNeedsNoBarrier) {
    fill("a", a).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    fill("c", c).reads(a, ResourceUse::sampled).record(record_nothing);
    g.mark_output(b);
    g.mark_output(c);
    EXPECT_THAT(barriers_of(plan_test_graph(g), 2),
                ElementsAre("image 2 [0,4] nothing > colour!/raster"));
}

TEST_F(SmallGraph, ReadInAnotherStageWaitsForTheFirstReader) {
    fill("a", a).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    g.add_pass("sum")
        .reads(a, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_nothing);
    fill("rewrite", a).record(record_nothing);
    g.mark_output(a);
    g.mark_output(b);
    g.mark_output(args);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(barriers_of(plan, 2), ElementsAre("image 0 [0,4] sampled/raster > sampled"));
    EXPECT_THAT(barriers_of(plan, 3),
                ElementsAre("image 0 [0,4] sampled/raster > colour!/raster +sampled"));
}

TEST_F(SmallGraph, ReadInAnotherLayoutNeedsABarrier) {
    fill("a", a).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    g.add_pass("copy")
        .reads(a, ResourceUse::copy_from)
        .writes(c, ResourceUse::copy_to)
        .record(record_nothing);
    fill("d", d).reads(a, ResourceUse::sampled).record(record_nothing);
    g.mark_output(b);
    g.mark_output(c);
    g.mark_output(d);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(barriers_of(plan, 2), ElementsAre("image 0 [0,4] sampled/raster > copy_from",
                                                  "image 2 [0,4] nothing > copy_to!"));
    EXPECT_THAT(barriers_of(plan, 3), ElementsAre("image 3 [0,4] nothing > colour!/raster",
                                                  "image 0 [0,4] copy_from > sampled/raster"));
}

TEST_F(SmallGraph, WriteAfterWriteNeedsABarrier) {
    fill("a", a).record(record_nothing);
    g.add_pass("blur").writes(a, ResourceUse::storage).record(record_nothing);
    g.add_pass("again").writes(a, ResourceUse::storage).record(record_nothing);
    g.mark_output(a);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(barriers_of(plan, 1), ElementsAre("image 0 [0,4] colour!/raster > storage!"));
    EXPECT_THAT(barriers_of(plan, 2), ElementsAre("image 0 [0,4] storage! > storage!"));
}

TEST_F(SmallGraph, BarriersMergeLayersOfEqualUse) {
    fill("low", a.layers(0, 2)).record(record_nothing);
    g.add_pass("high").writes(a.layers(2, 2), ResourceUse::storage_write).record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    g.mark_output(b);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(barriers_of(plan, 2), ElementsAre("image 1 [0,4] nothing > colour!/raster",
                                                  "image 0 [0,2] colour!/raster > sampled/raster",
                                                  "image 0 [2,2] storage_write! > sampled/raster"));
}

TEST_F(SmallGraph, BarriersDoNotMergeLayersOfDifferentUses) {
    fill("a", a).record(record_nothing);
    g.add_pass("blur")
        .reads(a.layers(0, 2), ResourceUse::sampled)
        .writes(a.layers(2, 2), ResourceUse::storage_write)
        .record(record_nothing);
    g.mark_output(a);
    EXPECT_THAT(barriers_of(plan_test_graph(g), 1),
                ElementsAre("image 0 [0,2] colour!/raster > sampled",
                            "image 0 [2,2] colour!/raster > storage_write!"));
}

TEST_F(SmallGraph, BarriersDoNotMergeLayersOfDifferentFrames) {
    fill("a", a).record(record_nothing);
    g.add_pass("sum")
        .reads(a, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_nothing);
    fill("b", b).reads(a, ResourceUse::sampled).record(record_nothing);
    g.add_pass("copy")
        .reads(g.previous_contents(a.layers(0, 2)), ResourceUse::copy_from)
        .reads(a.layers(2, 2), ResourceUse::copy_from)
        .writes(c, ResourceUse::copy_to)
        .record(record_nothing);
    g.mark_output(args);
    g.mark_output(b);
    g.mark_output(c);
    EXPECT_THAT(barriers_of(plan_test_graph(g), 3),
                ElementsAre("previous 0 [0,2] sampled > copy_from +sampled/raster",
                            "image 0 [2,2] sampled > copy_from +sampled/raster",
                            "image 2 [0,4] nothing > copy_to!"));
}

TEST_F(SmallGraph, BuffersNeedBarriersOnlyBetweenUses) {
    g.add_pass("fill").writes(args, ResourceUse::storage_write).record(record_nothing);
    fill("a", a).reads(args, ResourceUse::indirect).record(record_nothing);
    g.add_pass("b")
        .reads(args, ResourceUse::storage_read)
        .writes(b, ResourceUse::storage_write)
        .record(record_nothing);
    g.add_pass("refill").writes(args, ResourceUse::copy_to).record(record_nothing);
    g.mark_output(a);
    g.mark_output(b);
    g.mark_output(args);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(barriers_of(plan, 0), IsEmpty());
    EXPECT_THAT(barriers_of(plan, 1), ElementsAre("image 0 [0,4] nothing > colour!/raster",
                                                  "buffer 0 [0,1] storage_write! > "
                                                  "indirect/raster"));
    EXPECT_THAT(barriers_of(plan, 2), ElementsAre("image 1 [0,4] nothing > storage_write!",
                                                  "buffer 0 [0,1] storage_write! > storage_read"));
    EXPECT_THAT(barriers_of(plan, 3),
                ElementsAre("buffer 0 [0,1] indirect/raster > copy_to! +storage_read"));
    EXPECT_EQ(last_barriers(plan).back(), "buffer 0 [0,1] copy_to! > copy_from");
}

TEST_F(SmallGraph, HistoryImageAsOutputIsLeftSampledInAllLayers) {
    fill("a", a.layers(0, 2))
        .reads(g.previous_contents(a.layers(0, 2)), ResourceUse::sampled)
        .record(record_nothing);
    g.mark_output(a.layers(0, 1));
    EXPECT_THAT(
        last_barriers(plan_test_graph(g)),
        ElementsAre("image 0 [0,2] colour!/raster > sampled", "image 0 [2,2] nothing > sampled"));
}

TEST_F(SmallGraph, OverlappingOutputsGetOneFinalBarrier) {
    fill("a", a).record(record_nothing);
    g.mark_output(a.layers(0, 3));
    g.mark_output(a.layers(1, 2));
    EXPECT_THAT(last_barriers(plan_test_graph(g)),
                ElementsAre("image 0 [0,3] colour!/raster > copy_from"));
}

TEST_F(SmallGraph, ReadOfThePreviousFrameInAnotherLayoutNeedsABarrier) {
    g.add_pass("copy")
        .reads(g.previous_contents(a), ResourceUse::copy_from)
        .writes(b, ResourceUse::copy_to)
        .record(record_nothing);
    fill("a", a).record(record_nothing);
    g.mark_output(b);
    EXPECT_THAT(barriers_of(plan_test_graph(g), 0),
                ElementsAre("previous 0 [0,4] sampled > copy_from +sampled/raster",
                            "image 1 [0,4] nothing > copy_to!"));
}

TEST(PlainSizer, SizerCountsTexelsAndPadsTo256Bytes) {
    const MemoryRequirements image = make_default_sizer().image(
        {.name = "x", .format = Format::rgba16f, .width = 5, .height = 3, .layers = 6});
    EXPECT_EQ(image.bytes, 768u); // 720 bytes, padded to a multiple of 256
    EXPECT_EQ(image.alignment, 256u);
    EXPECT_EQ(make_default_sizer().buffer({.name = "y", .bytes = 256}).bytes, 256u);
}

} // namespace
} // namespace catoptric::graph
