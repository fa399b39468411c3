// Tests of persistent and imported resources, of mips, and of attachments that no pass reads: their
// planned barriers, and the errors for invalid graphs.
#include "graph/dump.hpp"
#include "graph/graph_shape.hpp"
#include "support/graphs.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

namespace catoptric::graph {
namespace {

using test::kBlackClearColour, test::record_no_commands, test::plan_test_graph;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string graph_lifetime_error_text(const Graph& graph) {
    return test::catch_error_text(Failure::internal, [&] { plan_test_graph(graph); });
}

/// Returns a barrier as text, "image 0 mips [0,1) layers [0,2) before > after", and the number of
/// other uses that the barrier waits for.
std::string describe_layer_barrier(const PlannedBarrier& b) {
    const auto word = [](const AccessState& t) {
        return t.nothing ? "nothing" : std::string(use_name(t.use)) + (t.write ? "!" : "");
    };
    const std::string more = b.shared.empty() ? "" : " +" + std::to_string(b.shared.size());
    if (b.is_buffer) return "buffer " + word(b.before) + " > " + word(b.after) + more;
    const auto range = [](std::uint32_t first, std::uint32_t count) {
        return "[" + std::to_string(first) + "," + std::to_string(first + count) + ")";
    };
    return "image " + std::to_string(b.id) + " mips " + range(b.first_mip, b.mip_count) +
           " layers " + range(b.first_layer, b.layer_count) + " " + word(b.before) + " > " +
           word(b.after) + more;
}

std::vector<std::string> describe_barriers(const std::vector<PlannedBarrier>& barriers) {
    std::vector<std::string> all;
    for (const PlannedBarrier& barrier : barriers) all.push_back(describe_layer_barrier(barrier));
    return all;
}

const ImageDesc kDesc{.name = "cubes", .width = 8, .height = 8, .layers = 12};

/// Returns a history in which layers [first, end) of image "cubes" have the content hash `stamp`.
GraphHistory make_history_with_hash(std::uint32_t first, std::uint32_t end, std::uint64_t stamp) {
    LayerHashes stamps(12);
    stamps.fill(first, end, stamp);
    return {.previous = {}, .persistent = {{"cubes", {kDesc, stamps}}}};
}

struct HashedCubeGraph {
    explicit HashedCubeGraph(GraphHistory history = {}) : g(std::move(history)) {}
    Graph g;
    ImageHandle cubes = g.add_persistent(kDesc);
    ImageHandle out = g.add_image({.name = "out", .width = 8, .height = 8});

    void add_writing_pass_with_hash(ImageHandle part, std::uint64_t stamp) {
        g.add_pass("make")
            .writes(part, ResourceUse::colour, kBlackClearColour)
            .layers(part.layer_count)
            .record(record_no_commands);
        g.set_content_hash(part, stamp);
    }
    void add_reading_pass(ImageHandle part) {
        g.add_pass("view")
            .reads(part, ResourceUse::sampled)
            .writes(out, ResourceUse::colour, kBlackClearColour)
            .record(record_no_commands);
        g.output(out);
    }
};

TEST(PersistentImages, HistoryDecidesWhichContentIsHeld) {
    const HashedCubeGraph fresh;
    EXPECT_FALSE(fresh.g.has_content_hash(fresh.cubes, 0));
    const HashedCubeGraph later(make_history_with_hash(0, 6, 7));
    EXPECT_TRUE(later.g.has_content_hash(later.cubes.layers(0, 6), 7));
    EXPECT_TRUE(later.g.has_content_hash(later.cubes.layers(2, 3), 7));
    EXPECT_FALSE(later.g.has_content_hash(later.cubes.layers(0, 6), 8));
    EXPECT_FALSE(later.g.has_content_hash(later.cubes, 7));
    Graph other(make_history_with_hash(0, 12, 7));
    ImageDesc desc = kDesc;
    desc.width = 16;
    EXPECT_FALSE(other.has_content_hash(other.add_persistent(desc), 7));
}

TEST(PersistentImages, PersistentImageIsReadWithoutABarrierInTheNextFrame) {
    HashedCubeGraph first;
    first.add_writing_pass_with_hash(first.cubes, 7);
    first.add_reading_pass(first.cubes);
    const GraphPlan made = plan_test_graph(first.g);
    EXPECT_THAT(describe_barriers(made.passes.at(0).barriers),
                ElementsAre("image 0 mips [0,1) layers [0,12) sampled > colour! +1"));
    EXPECT_THAT(describe_barriers(made.last),
                ElementsAre("image 0 mips [0,1) layers [0,12) sampled > sampled",
                            "image 1 mips [0,1) layers [0,1) colour! > copy_from"));
    HashedCubeGraph second(make_history_with_hash(0, 12, 7));
    second.add_reading_pass(second.cubes);
    const GraphPlan plan = plan_test_graph(second.g);
    EXPECT_THAT(describe_barriers(plan.passes.at(0).barriers),
                ElementsAre("image 1 mips [0,1) layers [0,1) nothing > colour!"));
    EXPECT_THAT(describe_barriers(plan.last),
                ElementsAre("image 1 mips [0,1) layers [0,1) colour! > copy_from"));
    EXPECT_TRUE(plan.images[0].alone);
    EXPECT_EQ(plan.images[0].bytes, 12u * 8 * 8 * 8); // a persistent image has one copy
    EXPECT_THAT(plan_to_text(second.g, plan),
                HasSubstr("'cubes' rgba16f 8x8, 12 layers, kept, passes"));
}

TEST(PersistentImages, UntouchedPersistentImageMayBeAnOutput) {
    HashedCubeGraph v(make_history_with_hash(0, 12, 7));
    v.g.output(v.cubes.layers(0, 6));
    const GraphPlan plan = plan_test_graph(v.g);
    EXPECT_THAT(plan.passes, IsEmpty());
    EXPECT_THAT(plan.last, IsEmpty()); // the image is already readable
}

TEST(PersistentImages, PassThatWritesAPersistentImageIsNotCulled) {
    HashedCubeGraph v;
    v.add_writing_pass_with_hash(v.cubes.layers(6, 6), 7);
    const GraphPlan plan = plan_test_graph(v.g);
    ASSERT_EQ(plan.passes.size(), 1u);
    EXPECT_EQ(plan.passes[0].unread, 0u);
}

TEST(PersistentImages, ReadingUnwrittenLayersIsRefused) {
    HashedCubeGraph v(make_history_with_hash(0, 6, 7));
    v.add_reading_pass(v.cubes);
    EXPECT_EQ(graph_lifetime_error_text(v.g),
              "pass 'view' reads 'cubes' [0,12) as sampled before any pass writes "
              "layers [6,12)");
}

TEST(PersistentImages, WritingWithoutAContentHashIsRefused) {
    HashedCubeGraph v;
    v.g.add_pass("make")
        .writes(v.cubes, ResourceUse::colour, kBlackClearColour)
        .layers(12)
        .record(record_no_commands);
    v.g.set_content_hash(v.cubes.layers(0, 6), 7);
    EXPECT_EQ(graph_lifetime_error_text(v.g),
              "pass 'make' writes 'cubes' [0,12), which is persistent, but no content hash "
              "is set for layers [6,12)");
}

TEST(PersistentImages, ContentHashWithoutAWriteIsRefused) {
    HashedCubeGraph v(make_history_with_hash(0, 12, 7));
    v.add_reading_pass(v.cubes);
    v.g.set_content_hash(v.cubes.layers(0, 6), 7);
    EXPECT_EQ(graph_lifetime_error_text(v.g),
              "'cubes' [0,6) has a content hash, but no pass writes "
              "layers [0,6)");
    HashedCubeGraph w;
    w.add_writing_pass_with_hash(w.cubes.layers(6, 6), 1);
    w.g.set_content_hash(w.cubes.layers(6, 7), 1);
    EXPECT_EQ(graph_lifetime_error_text(w.g),
              "'cubes' [6,13) has a content hash, but the image has "
              "layers [0,12) and 1 mip(s)");
}

TEST(PersistentImages, PreviousFrameOfAPersistentImageIsRefused) {
    HashedCubeGraph v;
    try {
        v.g.previous(v.cubes);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "previous() of image 'cubes', which is persistent and has one copy");
    }
    try {
        v.g.set_content_hash(v.out, 1);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "set_content_hash() of image 'out', which is not persistent");
    }
}

TEST(Imported, ImportedTextureNeedsNoBarrierAndNoMemory) {
    Graph g;
    const ImageHandle texture = g.import_resource(kDesc, nullptr, ResourceUse::sampled,
                                                  ResourceUse::sampled);
    const ImageHandle out = g.add_image({.name = "out"});
    g.add_pass("view")
        .reads(texture, ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    g.output(out);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(describe_barriers(plan.passes.at(0).barriers),
                ElementsAre("image 1 mips [0,1) layers [0,1) nothing > colour!"));
    EXPECT_EQ(plan.last.size(), 1u);
    EXPECT_EQ(plan.images[0].bytes, 0u);
    EXPECT_EQ(plan.bytes, plan_test_graph([] {
                              Graph alone;
                              const ImageHandle image = alone.add_image({.name = "out"});
                              alone.add_pass("view")
                                  .writes(image, ResourceUse::colour, kBlackClearColour)
                                  .record(record_no_commands);
                              alone.output(image);
                              return alone;
                          }())
                              .bytes);
    EXPECT_THAT(plan_to_text(g, plan), HasSubstr("'cubes' rgba16f 8x8, 12 layers, imported"));
}

TEST(Imported, ImportedWindowIsLeftReadyToPresent) {
    Graph g;
    const ImageHandle window = g.import_resource({.name = "window"}, nullptr, std::nullopt,
                                                 ResourceUse::present);
    // No output depends on the window.
    g.add_pass("show")
        .writes(window, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    const GraphPlan plan = plan_test_graph(g);
    ASSERT_EQ(plan.passes.size(), 1u);
    EXPECT_EQ(plan.passes[0].unread, 0u);
    EXPECT_THAT(describe_barriers(plan.passes[0].barriers),
                ElementsAre("image 0 mips [0,1) layers [0,1) nothing > colour!"));
    EXPECT_THAT(describe_barriers(plan.last),
                ElementsAre("image 0 mips [0,1) layers [0,1) colour! > present"));
}

TEST(Imported, AllLayersEndInTheDeclaredUse) {
    Graph g;
    const ImageHandle image = g.import_resource(kDesc, nullptr, ResourceUse::copy_from,
                                                ResourceUse::sampled);
    g.add_pass("some")
        .writes(image.layers(0, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    EXPECT_THAT(describe_barriers(plan_test_graph(g).last),
                ElementsAre("image 0 mips [0,1) layers [0,6) colour! > sampled",
                            "image 0 mips [0,1) layers [6,12) copy_from > sampled +1"));
}

TEST(Imported, ReadingAnImportWithoutContentsIsRefused) {
    Graph g;
    const ImageHandle image = g.import_resource({.name = "window"}, nullptr, std::nullopt,
                                                ResourceUse::present);
    const ImageHandle out = g.add_image({.name = "out"});
    g.add_pass("view")
        .reads(image, ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_THAT(graph_lifetime_error_text(g),
                HasSubstr("pass 'view' reads 'window' [0,1) as sampled before any"));
}

TEST(Imported, ImportedResourceAsOutputIsRefused) {
    Graph g;
    const ImageHandle image = g.import_resource({.name = "window"}, nullptr, ResourceUse::sampled,
                                                ResourceUse::sampled);
    g.output(image);
    EXPECT_EQ(graph_lifetime_error_text(g),
              "'window' [0,1) is an output, but imported: read it where it comes from");
    Graph h;
    const BufferHandle buffer = h.import_resource(BufferDesc{.name = "back", .bytes = 4}, nullptr);
    h.output(buffer);
    EXPECT_EQ(graph_lifetime_error_text(h),
              "buffer 'back' is an output, but imported: read it where it comes from");
}

TEST(Imported, ImportedBufferIsLeftReadableByTheHost) {
    Graph g;
    const BufferHandle list = g.import_resource(BufferDesc{.name = "list", .bytes = 64}, nullptr);
    const BufferHandle back = g.import_resource(BufferDesc{.name = "back", .bytes = 64}, nullptr);
    g.add_pass("fill")
        .reads(list, ResourceUse::storage_read) // no pass of this frame writes the list
        .writes(back, ResourceUse::storage_write)
        .record(record_no_commands);
    const GraphPlan plan = plan_test_graph(g);
    ASSERT_EQ(plan.passes.size(), 1u);
    EXPECT_THAT(plan.passes[0].barriers, IsEmpty());
    EXPECT_THAT(describe_barriers(plan.last),
                ::testing::Contains("buffer storage_write! > copy_from"));
    EXPECT_EQ(plan.bytes, 0u);
}

struct GraphMipLevelTest : ::testing::Test {
    Graph g;
    ImageHandle image = g.add_image(
        {.name = "pyramid", .width = 8, .height = 4, .layers = 2, .mips = 4});
    ImageHandle out = g.add_image({.name = "out", .width = 8, .height = 4});

    void add_mip_writing_pass(std::uint32_t mip) {
        PassBuilder pass = g.add_pass("mip" + std::to_string(mip));
        if (mip > 0) pass.reads(image.mip(mip - 1), ResourceUse::sampled);
        pass.writes(image.mip(mip), ResourceUse::storage_write).record(record_no_commands);
    }
    void add_mip_reading_pass(ImageHandle part) {
        g.add_pass("view")
            .reads(part, ResourceUse::sampled)
            .writes(out, ResourceUse::colour, kBlackClearColour)
            .record(record_no_commands);
        g.output(out);
    }
};

TEST_F(GraphMipLevelTest, EachMipHasItsOwnBarriers) {
    for (std::uint32_t m = 0; m < 4; ++m) add_mip_writing_pass(m);
    add_mip_reading_pass(image);
    const GraphPlan plan = plan_test_graph(g);
    EXPECT_THAT(describe_barriers(plan.passes.at(2).barriers),
                ElementsAre("image 0 mips [1,2) layers [0,2) storage_write! > sampled",
                            "image 0 mips [2,3) layers [0,2) nothing > storage_write!"));
    EXPECT_THAT(describe_barriers(plan.passes.at(4).barriers),
                ElementsAre("image 0 mips [0,3) layers [0,2) sampled > sampled",
                            "image 0 mips [3,4) layers [0,2) storage_write! > sampled",
                            "image 1 mips [0,1) layers [0,1) nothing > colour!"));
    EXPECT_EQ(plan.images[0].bytes, 768u); // (32 + 8 + 2 + 1) texels * 2 layers * 8 bytes, padded
}

TEST_F(GraphMipLevelTest, BarriersCoverRangesOfMipsAndLayers) {
    for (std::uint32_t m = 0; m < 4; ++m) add_mip_writing_pass(m);
    add_mip_reading_pass(image.layers(1, 1));
    EXPECT_THAT(describe_barriers(plan_test_graph(g).passes.at(4).barriers),
                ElementsAre("image 0 mips [0,3) layers [1,2) sampled > sampled",
                            "image 0 mips [3,4) layers [1,2) storage_write! > sampled",
                            "image 1 mips [0,1) layers [0,1) nothing > colour!"));
}

TEST_F(GraphMipLevelTest, ReadingUnwrittenMipsIsRefused) {
    add_mip_writing_pass(0);
    add_mip_writing_pass(1);
    add_mip_reading_pass(image.mips(0, 3));
    EXPECT_EQ(graph_lifetime_error_text(g),
              "pass 'view' reads 'pyramid' [0,2) mips [0,3) as sampled before any pass "
              "writes layers [0,2) of mip 2");
}

TEST_F(GraphMipLevelTest, WritingSeveralMipsAtOnceIsRefused) {
    g.add_pass("all").writes(image, ResourceUse::storage_write).record(record_no_commands);
    EXPECT_EQ(graph_lifetime_error_text(g),
              "pass 'all' uses 'pyramid' [0,2) mips [0,4) as storage_write: one mip at "
              "a time");
}

TEST_F(GraphMipLevelTest, MipOutOfRangeIsRefused) {
    g.add_pass("all").writes(image.mip(4), ResourceUse::storage_write).record(record_no_commands);
    EXPECT_EQ(graph_lifetime_error_text(g),
              "pass 'all' uses 'pyramid' [0,2) mip 4 as storage_write, but the image has "
              "mips [0,4)");
}

TEST_F(GraphMipLevelTest, MoreMipsThanTheSizeAllowsAreRefused) {
    g.add_image({.name = "deep", .width = 8, .height = 4, .mips = 5});
    EXPECT_EQ(graph_lifetime_error_text(g),
              "image 'deep' wants 5 mips, but of 8x4 there are 1 to 4");
}

TEST_F(GraphMipLevelTest, OutputOfMipsOutOfRangeIsRefused) {
    add_mip_writing_pass(0);
    g.output(image.mips(0, 5));
    EXPECT_EQ(graph_lifetime_error_text(g),
              "'pyramid' [0,2) mips [0,5) is an output, but the image has mips [0,4)");
}

TEST_F(GraphMipLevelTest, AttachmentsOfDifferentSizesAreRefused) {
    const ImageHandle depth = g.add_image(
        {.name = "depth", .format = TexelFormat::d32f, .width = 8, .height = 4});
    g.add_pass("draw")
        .writes(image.mip(1).layers(0, 1), ResourceUse::colour, kBlackClearColour)
        .writes(depth, ResourceUse::depth, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(graph_lifetime_error_text(g),
              "pass 'draw' attaches 'pyramid' [0,1) mip 1 as colour (4x2) and 'depth' "
              "[0,1) as depth (8x4): attachments have one size");
}

TEST_F(GraphMipLevelTest, ReadingAndWritingOneMipInTheSamePassIsRefused) {
    add_mip_writing_pass(0);
    g.add_pass("twice")
        .reads(image.mip(0), ResourceUse::sampled)
        .writes(image.mip(0), ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_EQ(graph_lifetime_error_text(g),
              "pass 'twice' reads 'pyramid' [0,2) mip 0 as sampled while it writes "
              "'pyramid' [0,2) mip 0 as storage_write, in layers [0,2) of mip 0");
}

TEST(Unread, AttachmentOverwrittenBeforeAnyReadIsUnread) {
    Graph g;
    const ImageHandle depth = g.add_image(
        {.name = "depth", .format = TexelFormat::d32f, .layers = 2});
    const ImageHandle a = g.add_image({.name = "a", .layers = 2}),
                      b = g.add_image({.name = "b", .layers = 2});
    const auto draw = [&](const std::string& name, ImageHandle colour,
                          std::optional<ClearValue> clear) {
        g.add_pass(name)
            .writes(colour, ResourceUse::colour, kBlackClearColour)
            .writes(depth, ResourceUse::depth, clear)
            .layers(2)
            .record(record_no_commands);
    };
    // The second pass loads the depth of the first pass.
    draw("first", a, kBlackClearColour);
    draw("second", b, std::nullopt);
    draw("third", a, kBlackClearColour);
    g.output(a);
    g.output(b);
    const GraphPlan plan = plan_test_graph(g);
    ASSERT_EQ(plan.passes.size(), 3u);
    // Bit 0: the colour of the first pass is written again before any read.
    EXPECT_EQ(plan.passes[0].unread, 1u);
    // Bit 1: the third pass clears the depth of the second pass.
    EXPECT_EQ(plan.passes[1].unread, 2u);
    // Bit 1: no pass reads the depth of the third pass.
    EXPECT_EQ(plan.passes[2].unread, 2u);
}

TEST(Shape, GraphShapeIgnoresClearValuesAndContentHashes) {
    const auto graph = [](const std::string& name, float red, std::uint64_t stamp, bool there) {
        HashedCubeGraph v(there ? make_history_with_hash(0, 12, stamp) : GraphHistory{});
        v.g.add_pass(name)
            .writes(v.out, ResourceUse::colour, ClearValue{red})
            .record(record_no_commands);
        if (!there) v.add_writing_pass_with_hash(v.cubes, stamp);
        return std::move(v.g);
    };
    const Graph known = graph("p", 0, 1, false);
    const auto same = [&](const Graph& other) {
        EXPECT_EQ(same_declarations(other, known.copy_declarations()),
                  hash_shape(other) == hash_shape(known));
        return same_declarations(other, known.copy_declarations());
    };
    EXPECT_TRUE(same(graph("p", 0, 1, false)));
    EXPECT_TRUE(same(graph("p", 1, 1, false)));
    EXPECT_TRUE(same(graph("p", 0, 2, false)));
    EXPECT_FALSE(same(graph("q", 0, 1, false)));
    EXPECT_FALSE(same(graph("p", 0, 1, true)));
}

} // namespace
} // namespace catoptric::graph
