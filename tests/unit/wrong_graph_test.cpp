// Tests that invalid render graphs are refused, each with an error text that names the mistake.
#include "graph/plan.hpp"
#include "support/graphs.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

namespace catoptric::graph {
namespace {

using test::kBlackClearColour, test::record_no_commands;

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Returns the error text of graph::plan_graph. Fails the test if `plan_graph` accepts the graph or
/// fails in another way.
std::string wrong_graph_error_text(const Graph& graph, Failure failure = Failure::internal,
                                   GraphLimits limits = {}) {
    return test::catch_error_text(failure, [&] { plan_graph(graph, limits, default_sizer()); });
}

/// Holds a graph with images and a buffer. Each test adds passes with one mistake.
struct WrongGraphTest : ::testing::Test {
    Graph g;
    ImageHandle cubes = g.add_image(
        {.name = "cubes", .width = 8, .height = 8, .layers = 24, .cube = true});
    ImageHandle out = g.add_image({.name = "out", .width = 8, .height = 8});
    ImageHandle depth = g.add_image(
        {.name = "depth", .format = TexelFormat::d32f, .width = 8, .height = 8});
    BufferHandle args = g.add_buffer({.name = "args", .bytes = 64});

    void add_writing_pass(ImageHandle image) {
        g.add_pass("make")
            .writes(image, ResourceUse::colour, kBlackClearColour)
            .layers(image.layer_count)
            .record(record_no_commands);
    }
};

TEST_F(WrongGraphTest, GraphWithoutAMistakeIsAccepted) {
    add_writing_pass(cubes);
    g.add_pass("view")
        .reads(cubes, ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    g.output(out);
    EXPECT_EQ(plan_graph(g, {}, default_sizer()).passes.size(), 2u);
}

TEST_F(WrongGraphTest, ReadBeforeWriteIsRefused) {
    g.add_pass("view")
        .reads(cubes, ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    add_writing_pass(cubes);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' reads 'cubes' [0,24) as sampled before any pass writes "
              "layers [0,24)");
}

TEST_F(WrongGraphTest, UpdateOfUnwrittenLayersIsRefused) {
    g.add_pass("mend")
        .updates(out, ResourceUse::colour, kBlackClearColour)
        .render_area({1, 1, 2, 2})
        .record(record_no_commands);
    g.output(out);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'mend' updates 'out' [0,1) as colour before any pass writes layers "
              "[0,1)");
}

TEST_F(WrongGraphTest, UpdateWithoutAnAreaIsRefused) {
    add_writing_pass(out);
    g.add_pass("mend")
        .updates(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'mend' updates 'out' [0,1) as colour, but has no area to do it in");
}

TEST_F(WrongGraphTest, ReadOfPartlyWrittenLayersIsRefused) {
    g.add_pass("a")
        .writes(cubes.layers(0, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    g.add_pass("b")
        .writes(cubes.layers(12, 12), ResourceUse::colour, kBlackClearColour)
        .layers(12)
        .record(record_no_commands);
    g.add_pass("view")
        .reads(cubes, ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' reads 'cubes' [0,24) as sampled before any pass writes "
              "layers [6,12)");
}

TEST_F(WrongGraphTest, ReadOfTheLastFrameDoesNotCountAsAWrite) {
    g.add_pass("old")
        .reads(g.previous(cubes), ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    g.add_pass("new")
        .reads(cubes, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    add_writing_pass(cubes);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'new' reads 'cubes' [0,24) as sampled before any pass writes "
              "layers [0,24)");
}

TEST_F(WrongGraphTest, LoadOfUnwrittenLayersIsRefused) {
    g.add_pass("glow").writes(out, ResourceUse::colour).record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'glow' loads (has no clear for) 'out' [0,1) as colour before any "
              "pass writes layers [0,1)");
}

TEST_F(WrongGraphTest, StorageUseOfUnwrittenLayersIsRefused) {
    g.add_pass("blur").writes(out, ResourceUse::storage).record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'blur' reads and writes 'out' [0,1) as storage before any pass "
              "writes layers [0,1)");
}

TEST_F(WrongGraphTest, BufferReadBeforeWriteIsRefused) {
    g.add_pass("draw")
        .reads(args, ResourceUse::indirect)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'draw' reads buffer 'args' as indirect before any pass writes it");
}

TEST_F(WrongGraphTest, SamplingAnAttachedLayerIsRefused) {
    add_writing_pass(cubes);
    g.add_pass("capture")
        .reads(cubes, ResourceUse::sampled)
        .writes(cubes.layers(6, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'capture' reads 'cubes' [0,24) as sampled while it writes 'cubes' "
              "[6,12) as colour, in layers [6,12)");
}

TEST_F(WrongGraphTest, SamplingAStorageTargetIsRefused) {
    add_writing_pass(out);
    g.add_pass("blur")
        .writes(out, ResourceUse::storage_write)
        .reads(out, ResourceUse::sampled)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'blur' reads 'out' [0,1) as sampled while it writes 'out' [0,1) as "
              "storage_write, in layers [0,1)");
}

TEST_F(WrongGraphTest, OtherLayersAndLastFrameMayBeSampledWhileAttached) {
    add_writing_pass(cubes);
    g.add_pass("capture")
        .reads(cubes.layers(0, 6), ResourceUse::sampled)
        .reads(g.previous(cubes), ResourceUse::sampled)
        .writes(cubes.layers(6, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    g.output(cubes);
    EXPECT_EQ(plan_graph(g, {}, default_sizer()).passes.size(), 2u);
}

TEST_F(WrongGraphTest, BufferReadWhileWrittenIsRefused) {
    g.add_pass("fill").writes(args, ResourceUse::copy_to).record(record_no_commands);
    g.add_pass("sort")
        .reads(args, ResourceUse::storage_read)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'sort' reads buffer 'args' as storage_read while it writes buffer "
              "'args' as storage_write");
}

TEST_F(WrongGraphTest, TwoWritesOfTheSameLayersAreRefused) {
    g.add_pass("twice")
        .writes(cubes.layers(0, 6), ResourceUse::storage_write)
        .writes(cubes.layers(4, 6), ResourceUse::copy_to)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'twice' writes 'cubes' [0,6) as storage_write and 'cubes' [4,10) "
              "as copy_to: written twice, in layers [4,6)");
}

TEST_F(WrongGraphTest, TwoLayoutsAtOnceAreRefused) {
    add_writing_pass(out);
    g.add_pass("look")
        .reads(out, ResourceUse::sampled)
        .reads(out, ResourceUse::storage_read)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'look' reads 'out' [0,1) as sampled and 'out' [0,1) as "
              "storage_read: one image cannot be in two layouts at once, in layers "
              "[0,1)");
}

TEST_F(WrongGraphTest, OutputThatIsNeverWrittenIsRefused) {
    add_writing_pass(cubes);
    g.output(out);
    EXPECT_EQ(wrong_graph_error_text(g),
              "'out' [0,1) is an output, but no pass writes layers [0,1)");
}

TEST_F(WrongGraphTest, OutputLayersThatAreNeverWrittenAreRefused) {
    g.add_pass("a")
        .writes(cubes.layers(0, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    g.output(cubes.layers(3, 6));
    EXPECT_EQ(wrong_graph_error_text(g),
              "'cubes' [3,9) is an output, but no pass writes layers [6,9)");
}

TEST_F(WrongGraphTest, OutputBufferThatIsNeverWrittenIsRefused) {
    add_writing_pass(out);
    g.output(args);
    EXPECT_EQ(wrong_graph_error_text(g), "buffer 'args' is an output, but no pass writes it");
}

TEST_F(WrongGraphTest, OutputLayersOutOfRangeAreRefused) {
    add_writing_pass(out);
    g.output(out.layers(0, 2));
    EXPECT_EQ(wrong_graph_error_text(g),
              "'out' [0,2) is an output, but the image has layers [0,1)");
}

TEST_F(WrongGraphTest, OutputOfThePreviousFrameIsRefused) {
    add_writing_pass(out);
    g.output(g.previous(out));
    EXPECT_EQ(wrong_graph_error_text(g),
              "previous('out') [0,1) is an output: only this frame's contents can be");
}

TEST_F(WrongGraphTest, OutputOfAnotherGraphIsRefused) {
    add_writing_pass(out);
    g.output(ImageHandle{.id = 9, .layer_count = 1});
    EXPECT_EQ(wrong_graph_error_text(g), "image number 9 is an output, but the graph has 3");
}

TEST_F(WrongGraphTest, PreviousOfAnUnwrittenImageIsRefused) {
    g.add_pass("view")
        .reads(g.previous(cubes), ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' reads previous('cubes') as sampled but no pass writes 'cubes'");
}

TEST_F(WrongGraphTest, PreviousOfUnwrittenLayersIsRefused) {
    g.add_pass("a")
        .writes(cubes.layers(0, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    g.add_pass("view")
        .reads(g.previous(cubes.layers(0, 12)), ResourceUse::sampled)
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' reads previous('cubes') [0,12) as sampled but no pass "
              "writes layers [6,12) of 'cubes'");
}

TEST_F(WrongGraphTest, WriteToThePreviousFrameIsRefused) {
    g.add_pass("rewrite")
        .writes(g.previous(out), ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'rewrite' writes previous('out') [0,1) as colour: last frame's "
              "contents are only read");
}

TEST_F(WrongGraphTest, PreviousOfAnotherGraphIsRefused) {
    try {
        g.previous(ImageHandle{.id = 9});
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "previous() of image number 9, but the graph has 3 images");
    }
}

TEST_F(WrongGraphTest, LayersOutOfRangeAreRefused) {
    g.add_pass("capture")
        .writes(cubes.layers(20, 6), ResourceUse::colour, kBlackClearColour)
        .layers(6)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'capture' uses 'cubes' [20,26) as colour, but the image has layers "
              "[0,24)");
}

TEST_F(WrongGraphTest, LayerRangeThatOverflowsIsRefused) {
    g.add_pass("capture")
        .writes(cubes.layers(1, ~0u), ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_THAT(wrong_graph_error_text(g), HasSubstr("but the image has layers [0,24)"));
}

TEST_F(WrongGraphTest, EmptyLayerRangeIsRefused) {
    g.add_pass("capture")
        .writes(cubes.layers(3, 0), ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'capture' names no layer of 'cubes' as storage_write");
}

TEST_F(WrongGraphTest, ImageOfAnotherGraphIsRefused) {
    g.add_pass("a")
        .writes(ImageHandle{.id = 3, .layer_count = 1}, ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g), "pass 'a' names image number 3, but the graph has 3");
}

TEST_F(WrongGraphTest, BufferOfAnotherGraphIsRefused) {
    g.add_pass("a").writes(BufferHandle{1}, ResourceUse::storage_write).record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g), "pass 'a' names buffer number 1, but the graph has 1");
}

TEST_F(WrongGraphTest, AttachmentWithAnotherLayerCountIsRefused) {
    g.add_pass("capture")
        .writes(cubes.layers(0, 6), ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'capture' renders 1 layer(s), but attaches 'cubes' [0,6) as "
              "colour, which are 6");
}

TEST_F(WrongGraphTest, AttachmentsOfDifferentSizesAreRefused) {
    const ImageHandle small = g.add_image({.name = "small", .width = 8, .height = 4});
    g.add_pass("view")
        .writes(small, ResourceUse::colour, kBlackClearColour)
        .writes(depth, ResourceUse::depth, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' attaches 'small' [0,1) as colour (8x4) and 'depth' [0,1) as "
              "depth (8x8): attachments have one size");
}

TEST_F(WrongGraphTest, TwoDepthAttachmentsAreRefused) {
    const ImageHandle other = g.add_image(
        {.name = "other", .format = TexelFormat::d32f, .width = 8, .height = 8});
    g.add_pass("view")
        .writes(other, ResourceUse::depth, kBlackClearColour)
        .writes(depth, ResourceUse::depth, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' attaches both 'other' [0,1) and 'depth' [0,1) as depth");
}

TEST_F(WrongGraphTest, DepthUseOfAColourFormatIsRefused) {
    g.add_pass("shadow")
        .writes(out, ResourceUse::depth, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'shadow' uses 'out' [0,1) as depth, but its format rgba16f is a "
              "colour format");
}

TEST_F(WrongGraphTest, ColourUseOfADepthFormatIsRefused) {
    g.add_pass("shadow")
        .writes(depth, ResourceUse::colour, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'shadow' uses 'depth' [0,1) as colour, but its format d32f is a "
              "depth format");
}

TEST_F(WrongGraphTest, TwoPassesOfOneNameAreRefused) {
    add_writing_pass(out);
    add_writing_pass(cubes);
    EXPECT_EQ(wrong_graph_error_text(g), "pass 'make' is declared twice: names are unique");
}

TEST_F(WrongGraphTest, TwoImagesOfOneNameAreRefused) {
    g.add_image({.name = "out"});
    EXPECT_EQ(wrong_graph_error_text(g), "image 'out': another image or buffer has the same name");
}

TEST_F(WrongGraphTest, BufferNamedLikeAnImageIsRefused) {
    g.add_buffer({.name = "out", .bytes = 4});
    EXPECT_EQ(wrong_graph_error_text(g), "buffer 'out': another image or buffer has the same name");
}

TEST_F(WrongGraphTest, ImageWithoutANameIsRefused) {
    g.add_image({.name = ""});
    EXPECT_EQ(wrong_graph_error_text(g), "image number 3 has no name");
}

TEST_F(WrongGraphTest, PassWithoutANameIsRefused) {
    add_writing_pass(out);
    g.add_pass("").writes(out, ResourceUse::colour, kBlackClearColour).record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g), "pass number 1 has no name");
}

TEST_F(WrongGraphTest, PassWithoutABodyIsRefused) {
    g.add_pass("forgotten").writes(out, ResourceUse::colour, kBlackClearColour);
    EXPECT_EQ(wrong_graph_error_text(g), "pass 'forgotten' has no body");
}

TEST_F(WrongGraphTest, PassThatWritesNothingIsRefused) {
    add_writing_pass(out);
    g.add_pass("look").reads(out, ResourceUse::sampled).record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g), "pass 'look' writes nothing");
}

TEST_F(WrongGraphTest, PassWithoutLayersIsRefused) {
    g.add_pass("view")
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .layers(0)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g), "pass 'view' renders 0 layers");
}

TEST_F(WrongGraphTest, CubeWithSevenFacesIsRefused) {
    g.add_image({.name = "odd", .width = 4, .height = 4, .layers = 7, .cube = true});
    EXPECT_EQ(wrong_graph_error_text(g),
              "image 'odd' is a cube, but its 7 layers are not a multiple of 6");
}

TEST_F(WrongGraphTest, CubeThatIsNotSquareIsRefused) {
    g.add_image({.name = "flat", .width = 4, .height = 2, .layers = 6, .cube = true});
    EXPECT_EQ(wrong_graph_error_text(g), "image 'flat' is a cube, but not square: 4x2");
}

TEST_F(WrongGraphTest, ImageWithoutSizeIsRefused) {
    g.add_image({.name = "void", .width = 4, .height = 0, .layers = 2});
    EXPECT_EQ(wrong_graph_error_text(g), "image 'void' is empty: 4x0, 2 layers");
}

TEST_F(WrongGraphTest, ImageWithoutLayersIsRefused) {
    g.add_image({.name = "void", .layers = 0});
    EXPECT_EQ(wrong_graph_error_text(g), "image 'void' is empty: 1x1, 0 layers");
}

TEST_F(WrongGraphTest, BufferWithoutSizeIsRefused) {
    g.add_buffer({.name = "void"});
    EXPECT_EQ(wrong_graph_error_text(g), "buffer 'void' is empty: 0 bytes");
}

TEST_F(WrongGraphTest, ClearOfAnImageThatIsNotAttachedIsRefused) {
    g.add_pass("blur")
        .writes(out, ResourceUse::storage_write, kBlackClearColour)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'blur' clears 'out' [0,1) as storage_write, but only attachments "
              "are cleared");
}

TEST_F(WrongGraphTest, CopyInARasterPassIsRefused) {
    g.add_pass("view")
        .writes(out, ResourceUse::colour, kBlackClearColour)
        .writes(args, ResourceUse::copy_to)
        .record(record_no_commands);
    EXPECT_EQ(wrong_graph_error_text(g),
              "pass 'view' has attachments and uses buffer 'args' as copy_to: copies "
              "need a pass of their own");
}

// Tries every use as a read and as a write, of an image and of a buffer, so that no wrong
// combination is accepted.
TEST_F(WrongGraphTest, UsesInTheWrongDirectionAreRefused) {
    for (const ResourceUse use :
         {ResourceUse::sampled, ResourceUse::storage_read, ResourceUse::storage_write,
          ResourceUse::storage, ResourceUse::colour, ResourceUse::depth, ResourceUse::copy_from,
          ResourceUse::copy_to, ResourceUse::indirect}) {
        const bool reads = use == ResourceUse::sampled || use == ResourceUse::storage_read ||
                           use == ResourceUse::copy_from || use == ResourceUse::indirect;
        const bool image_only = use == ResourceUse::colour || use == ResourceUse::depth;
        const std::string name(use_name(use));
        if (reads) {
            Graph wrong = g;
            wrong.add_pass("p").writes(out, use).record(record_no_commands);
            EXPECT_EQ(wrong_graph_error_text(wrong), "pass 'p' writes 'out' [0,1) as " + name +
                                                         ", which is not a way to write an image");
        }
        if ((!reads && use != ResourceUse::depth) || use == ResourceUse::indirect) {
            Graph wrong = g;
            wrong.add_pass("p").reads(out, use).record(record_no_commands);
            EXPECT_EQ(wrong_graph_error_text(wrong), "pass 'p' reads 'out' [0,1) as " + name +
                                                         ", which is not a way to read an image");
        }
        if (reads || image_only) {
            Graph wrong = g;
            wrong.add_pass("p").writes(args, use).record(record_no_commands);
            EXPECT_EQ(wrong_graph_error_text(wrong), "pass 'p' writes buffer 'args' as " + name +
                                                         ", which is not a way to write a buffer");
        }
        if (!reads) {
            Graph wrong = g;
            wrong.add_pass("p").reads(args, use).record(record_no_commands);
            EXPECT_EQ(wrong_graph_error_text(wrong), "pass 'p' reads buffer 'args' as " + name +
                                                         ", which is not a way to read a buffer");
        }
    }
}

// A mistake is reported even in a pass on which no output depends.
TEST_F(WrongGraphTest, CulledPassesAreValidated) {
    add_writing_pass(out);
    g.output(out);
    g.add_pass("debug")
        .reads(cubes, ResourceUse::sampled)
        .writes(args, ResourceUse::storage_write)
        .record(record_no_commands);
    EXPECT_THAT(wrong_graph_error_text(g), AllOf(HasSubstr("'debug'"), HasSubstr("'cubes'")));
}

TEST_F(WrongGraphTest, ImageOverThe2dSizeLimitIsRefused) {
    add_writing_pass(out);
    EXPECT_EQ(wrong_graph_error_text(g, Failure::exhausted, {.max_size_2d = 7}),
              "image 'out' wants 8 texels a side, device allows max_size_2d = 7");
}

TEST_F(WrongGraphTest, CubeOverTheSizeLimitIsRefused) {
    add_writing_pass(out);
    EXPECT_EQ(wrong_graph_error_text(g, Failure::exhausted, {.max_size_cube = 7}),
              "image 'cubes' wants 8 texels a side, device allows max_size_cube = 7");
}

TEST_F(WrongGraphTest, ImageOverTheLayerLimitIsRefused) {
    add_writing_pass(out);
    EXPECT_EQ(wrong_graph_error_text(g, Failure::exhausted, {.max_layers = 23}),
              "image 'cubes' wants 24 layers, device allows max_layers = 23");
}

TEST_F(WrongGraphTest, PassOverTheFramebufferLayerLimitIsRefused) {
    add_writing_pass(cubes);
    EXPECT_EQ(wrong_graph_error_text(g, Failure::exhausted, {.max_framebuffer_layers = 6}),
              "pass 'make' wants 24 framebuffer layers for 'cubes', device allows "
              "max_framebuffer_layers = 6");
}

TEST_F(WrongGraphTest, FrameOverTheMemoryLimitIsRefused) {
    add_writing_pass(cubes);
    g.output(cubes);
    EXPECT_EQ(wrong_graph_error_text(g, Failure::exhausted, {.max_memory = 12287}),
              "the frame wants 12288 bytes of memory, device allows max_memory = 12287; the "
              "largest is 'cubes' with 12288");
}

TEST_F(WrongGraphTest, MemoryOverTheAllocationLimitIsRefused) {
    add_writing_pass(cubes);
    g.output(cubes);
    EXPECT_EQ(wrong_graph_error_text(g, Failure::exhausted, {.max_allocation = 12287}),
              "the frame wants 12288 bytes of memory in one piece, device allows max_allocation = "
              "12287; the "
              "largest is 'cubes' with 12288");
}

/// Outputs of a heap have an allocation of their own, and the limit holds for each allocation.
TEST_F(WrongGraphTest, OutputsAndOtherImagesAreAllocatedApart) {
    const ImageHandle picture = g.add_image(
        {.name = "picture", .width = 8, .height = 8, .layers = 24});
    add_writing_pass(cubes);
    g.add_pass("view")
        .reads(cubes, ResourceUse::sampled)
        .writes(picture, ResourceUse::colour, kBlackClearColour)
        .layers(24)
        .record(record_no_commands);
    g.output(picture);
    const GraphLimits limits{.max_allocation = 12288};
    EXPECT_EQ(plan_graph(g, limits, default_sizer()).bytes, 24576u);
}

TEST_F(WrongGraphTest, GraphAtEveryLimitIsAccepted) {
    add_writing_pass(cubes);
    g.output(cubes);
    const GraphLimits limits{.max_size_2d = 8,
                             .max_size_cube = 8,
                             .max_layers = 24,
                             .max_framebuffer_layers = 24,
                             .max_memory = 12288,
                             .max_allocation = 12288};
    EXPECT_EQ(plan_graph(g, limits, default_sizer()).bytes, 12288u);
}

} // namespace
} // namespace catoptric::graph
