// Tests of image lifetimes on the device, under the validation layer: persistent images, imported
// images and buffers, mip levels, and attachments that are not stored.
#include "gpu/steps.hpp"
#include "graph/device_memory.hpp"

namespace {

using namespace catoptric;
using graph::ResourceUse;
using test::add_start_pass, test::add_step_pass, test::expect_error, test::expected_start_texels,
    test::expected_step_texels;
using test::kHeight, test::kStepImageWidth;

const graph::ImageDesc kDesc{"cubes", TexelFormat::r32f, kStepImageWidth, kHeight};

/// Renders a frame from a persistent image with content hash `stamp`. If the image does not hold
/// that content, the frame writes it first. `shown` receives a step computed from the image.
/// Returns the number of passes that ran.
std::size_t render_from_persistent_image(graph::GraphRunner& runner, float stamp,
                                         std::vector<float>& shown) {
    graph::Graph graph(runner.make_history());
    const graph::ImageHandle cubes = graph.add_persistent(kDesc);
    const auto number = static_cast<std::uint64_t>(stamp);
    if (!graph.has_content_hash(cubes, number)) {
        add_start_pass(graph, cubes, stamp);
        graph.set_content_hash(cubes, number);
    }
    const graph::ImageHandle out = test::add_step_image(graph, "out");
    add_step_pass(graph, "view", cubes, out, 1);
    graph.output(out);
    const std::size_t passes = test::run_graph(runner, graph).passes.size();
    shown = test::read_resource_values<float>(runner, out);
    return passes;
}

TEST(Kept, ImageIsWrittenOnceUntilItsContentHashChanges) {
    for (const std::uint32_t in_flight : {1u, 3u}) {
        graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines,
                                  in_flight);
        std::vector<float> shown;
        for (const auto& [stamp, passes] : std::vector<std::pair<float, std::size_t>>{
                 {2, 2}, {2, 1}, {2, 1}, {3, 2}, {3, 1}, {2, 2}, {2, 1}}) {
            EXPECT_EQ(render_from_persistent_image(runner, stamp, shown), passes);
            EXPECT_EQ(shown, expected_step_texels(expected_start_texels(stamp), 1));
        }
        // The frames have three shapes: without content, with kept content, and with overwritten
        // content.
        EXPECT_EQ(runner.plan_count(), 3u);
        runner.discard_contents();
        EXPECT_EQ(render_from_persistent_image(runner, 2, shown), 2u);
        EXPECT_EQ(shown, expected_step_texels(expected_start_texels(2), 1));
    }
}

TEST(Kept, ImageStaysThroughFramesThatDoNotUseIt) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    std::vector<float> shown;
    EXPECT_EQ(render_from_persistent_image(runner, 2, shown), 2u);
    for (int frame = 0; frame < 3; ++frame) {
        graph::Graph other;
        const graph::ImageHandle image = test::add_step_image(other,
                                                              "other" + std::to_string(frame));
        add_start_pass(other, image, 9);
        other.output(image);
        test::run_graph(runner, other);
    }
    EXPECT_EQ(render_from_persistent_image(runner, 2, shown), 1u);
    EXPECT_EQ(shown, expected_step_texels(expected_start_texels(2), 1));
}

TEST(Kept, LayersAreWrittenOneByOne) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::ImageDesc desc = kDesc;
    desc.layers = 3;
    for (std::uint32_t frame = 0; frame < 5; ++frame) {
        graph::Graph graph(runner.make_history());
        const graph::ImageHandle cubes = graph.add_persistent(desc);
        for (std::uint32_t layer = 0; layer < 3; ++layer) {
            const graph::ImageHandle part = cubes.layers(layer, 1);
            EXPECT_EQ(graph.has_content_hash(part, layer), layer < frame);
            if (layer != frame) continue;
            graph.add_pass("fill")
                .writes(part, ResourceUse::storage_write)
                .record([=](graph::PassCommands& c) {
                    c.bind_pipeline(gpu::ComputeState{"tests/start.comp", {}});
                    c.bind("after", part);
                    c.push_constants(static_cast<float>(layer + 1));
                    c.dispatch((kStepImageWidth + 7) / 8, (kHeight + 7) / 8);
                });
            graph.set_content_hash(part, layer);
        }
        EXPECT_EQ(graph.has_content_hash(cubes, 0), false);
        const std::uint32_t there = std::min(frame + 1, 3u);
        graph.output(cubes.layers(0, there));
        test::run_graph(runner, graph);
        std::vector<float> expected;
        for (std::uint32_t layer = 0; layer < there; ++layer) {
            const std::vector<float> values = expected_start_texels(static_cast<float>(layer + 1));
            expected.insert(expected.end(), values.begin(), values.end());
        }
        EXPECT_EQ(test::read_resource_values<float>(runner, cubes.layers(0, there)), expected);
    }
}

TEST(Kept, ImageOfAnotherSizeHasNoContent) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    std::vector<float> shown;
    render_from_persistent_image(runner, 2, shown);
    graph::Graph graph(runner.make_history());
    graph::ImageDesc desc = kDesc;
    desc.width = 8;
    EXPECT_FALSE(graph.has_content_hash(graph.add_persistent(desc), 2));
}

TEST(Imported, ImageIsReadAndLeftInTheDeclaredUse) {
    auto& [device, pipelines] = test::get_test_device();
    graph::ImageDesc desc = kDesc;
    desc.name = "outside";
    const graph::ImageWithMemory owned = graph::make_importable_image(device, desc);
    graph::PhysicalImage outside = graph::wrap_image(desc, owned.image.image);
    graph::GraphRunner runner(device, pipelines, 2);
    for (int frame = 0; frame < 4; ++frame) {
        graph::Graph graph;
        const bool first = frame == 0;
        // The first frame writes the image, and later frames sample it. Each frame declares that
        // the next frame samples the image, which sets its layout.
        const graph::ImageHandle image = graph.import_resource(
            desc, &outside, first ? std::nullopt : std::optional(ResourceUse::sampled),
            ResourceUse::sampled);
        const graph::ImageHandle out = test::add_step_image(graph, "out");
        if (first) add_start_pass(graph, image, 4);
        add_step_pass(graph, "view", image, out, 5);
        graph.output(out);
        const graph::FrameTicket ticket = runner.submit_frame(graph, graph::PassTiming::pipelined);
        std::vector<std::byte> bytes = runner.read_back(ticket, out);
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        EXPECT_EQ(values, expected_step_texels(expected_start_texels(4), 5));
    }
    EXPECT_EQ(runner.plan_count(), 2u);
}

TEST(Imported, BufferIsReadByTheHostOnceTheFrameHasEnded) {
    auto& [device, pipelines] = test::get_test_device();
    constexpr std::uint32_t kLifetimeTestFrames = 6, kFrameSlotCount = 3;
    graph::GraphRunner runner(device, pipelines, kFrameSlotCount);
    std::vector<gpu::Buffer> targets;
    for (std::uint32_t i = 0; i < kFrameSlotCount; ++i)
        targets.emplace_back(device, "read-back", kStepImageWidth * kHeight * sizeof(float),
                             gpu::BufferUsage::read_back);
    std::vector<graph::FrameTicket> tickets;
    const auto expect_read = [&](std::uint32_t frame) {
        runner.wait_for(tickets[frame]);
        const std::vector<std::byte> bytes = targets[frame % kFrameSlotCount].read();
        std::vector<float> values(kStepImageWidth * kHeight);
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
        EXPECT_EQ(values, expected_start_texels(static_cast<float>(frame)));
    };
    for (std::uint32_t frame = 0; frame < kLifetimeTestFrames; ++frame) {
        if (frame >= kFrameSlotCount) expect_read(frame - kFrameSlotCount);
        graph::Graph graph;
        const graph::ImageHandle image = test::add_step_image(graph, "image");
        const gpu::Buffer& target = targets[frame % kFrameSlotCount];
        const graph::BufferHandle out = graph.import_resource({target.name(), target.bytes()},
                                                              &target);
        add_start_pass(graph, image, static_cast<float>(frame));
        graph.add_pass("copy")
            .reads(image, ResourceUse::copy_from)
            .writes(out, ResourceUse::copy_to)
            .record([=](graph::PassCommands& commands) { commands.copy_image(image, out); });
        // The frame has no output. The imported buffer alone keeps the passes.
        tickets.push_back(runner.submit_frame(graph, graph::PassTiming::pipelined));
    }
    for (std::uint32_t frame = kLifetimeTestFrames - kFrameSlotCount; frame < kLifetimeTestFrames;
         ++frame)
        expect_read(frame);
    EXPECT_EQ(runner.plan_count(), 1u);
}

TEST(Imported, ImageWithoutASourceIsRefused) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::ImageHandle image = graph.import_resource(kDesc, nullptr, std::nullopt,
                                                           ResourceUse::sampled);
    add_start_pass(graph, image, 1);
    expect_error([&] { test::run_graph(runner, graph); }, Failure::internal,
                 {"image 'cubes' is imported from nowhere"});
}

TEST(Imported, ImageOfAnotherSizeIsRefused) {
    auto& [device, pipelines] = test::get_test_device();
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    graph::ImageDesc desc = kDesc;
    desc.height *= 2;
    const graph::ImageWithMemory owned = graph::make_importable_image(device, desc);
    graph::PhysicalImage outside = graph::wrap_image(desc, owned.image.image);
    const graph::ImageHandle image = graph.import_resource(kDesc, &outside, std::nullopt,
                                                           ResourceUse::sampled);
    add_start_pass(graph, image, 1);
    const auto size = [](const graph::ImageDesc& of) {
        return std::to_string(of.width) + "x" + std::to_string(of.height);
    };
    expect_error([&] { test::run_graph(runner, graph); }, Failure::internal,
                 {"image 'cubes' is imported as ", size(kDesc), ", found ", size(desc)});
}

TEST(Mips, EachMipIsComputedFromTheOneBefore) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    for (int frame = 0; frame < 2; ++frame) {
        graph::Graph graph;
        graph::ImageDesc desc = kDesc;
        desc.mips = 4;
        const graph::ImageHandle image = graph.add_image(desc);
        add_start_pass(graph, image.mip(0), 2);
        for (std::uint32_t m = 1; m < desc.mips; ++m)
            add_step_pass(graph, "mip" + std::to_string(m), image.mip(m - 1), image.mip(m), 3);
        graph.output(image);
        test::run_graph(runner, graph);
        std::vector<float> expected, before;
        for (std::uint32_t m = 0; m < desc.mips; ++m) {
            const std::uint32_t width = graph::mip_size(kStepImageWidth, m),
                                height = graph::mip_size(kHeight, m);
            std::vector<float> mip;
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) {
                    const auto where = static_cast<float>(x + width * y);
                    mip.push_back(
                        m == 0 ? 2 * (1 + where)
                               : std::fmod(3 * before[x + 2 * width * y] + where + 3, 1048576.0f));
                }
            expected.insert(expected.end(), mip.begin(), mip.end());
            before = mip;
        }
        EXPECT_EQ(test::read_resource_values<float>(runner, image), expected);
    }
}

TEST(Mips, MipsAreSampledAsOneImage) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    for (const float lod : {0.0f, 1.0f, 1.5f, 2.25f, 9.0f}) {
        graph::Graph graph;
        const graph::ImageHandle image = graph.add_image(
            {"pyramid", TexelFormat::r16f, 16, 16, 1, false, 5});
        for (std::uint32_t m = 0; m < 5; ++m)
            graph.add_pass("mip" + std::to_string(m))
                .writes(image.mip(m), ResourceUse::colour,
                        graph::ClearValue{10.0f * static_cast<float>(m)})
                .record([](graph::PassCommands&) {});
        const graph::ImageHandle out = test::add_step_image(graph, "out");
        graph.add_pass("look")
            .reads(image, ResourceUse::sampled)
            .writes(out, ResourceUse::storage_write)
            .record([=](graph::PassCommands& commands) {
                commands.bind_pipeline(gpu::ComputeState{"tests/lod.comp", {}});
                commands.bind("before", image, graph::TextureFilter::mipmapped);
                commands.bind("after", out);
                commands.push_constants(lod);
                commands.dispatch((kStepImageWidth + 7) / 8, (kHeight + 7) / 8);
            });
        graph.output(out);
        test::run_graph(runner, graph);
        EXPECT_NEAR(test::read_resource_values<float>(runner, out)[0], std::min(10 * lod, 40.0f),
                    0.1f)
            << lod;
    }
}

TEST(Unread, AttachmentsThatAreNotStoredDoNotChangeThePicture) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::ImageHandle colour = graph.add_image({"colour", TexelFormat::rgba32f, 8, 8});
    const graph::ImageHandle depth = graph.add_image({"depth", TexelFormat::d32f, 8, 8});
    graph.add_pass("draw")
        .writes(colour, ResourceUse::colour, graph::ClearValue{1, 2, 3, 4})
        .writes(depth, ResourceUse::depth, graph::ClearValue{})
        .record([](graph::PassCommands&) {});
    graph.output(colour);
    EXPECT_EQ(runner.plan(graph).passes[0].unread, 2u);
    test::run_graph(runner, graph);
    const std::vector<float> found = test::read_resource_values<float>(runner, colour);
    EXPECT_EQ(std::vector<float>(found.begin(), found.begin() + 4),
              (std::vector<float>{1, 2, 3, 4}));
}

// Frames in flight write an image that no pass reads. Each frame must wait for the write of the
// frame before, which the validation layer checks.
TEST(Unread, UnreadImageIsWrittenAgainInTheNextFrame) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines, 3);
    for (int frame = 0; frame < 6; ++frame) {
        graph::Graph graph;
        const graph::ImageHandle unread = test::add_step_image(graph, "unread");
        const graph::ImageHandle out = test::add_step_image(graph, "out");
        graph.add_pass("both")
            .writes(unread, ResourceUse::storage_write)
            .writes(out, ResourceUse::storage_write)
            .record([=](graph::PassCommands& commands) {
                commands.bind_pipeline(gpu::ComputeState{"tests/start.comp", {}});
                for (const graph::ImageHandle& after : {unread, out}) {
                    commands.bind("after", after);
                    commands.push_constants(1.0f);
                    commands.dispatch((kStepImageWidth + 7) / 8, (kHeight + 7) / 8);
                }
            });
        graph.output(out);
        runner.submit_frame(graph, graph::PassTiming::pipelined);
    }
}

// Graphs of five shapes take turns, one of them with a persistent image. The memory must not exceed
// that of the largest shape.
TEST(Memory, MemoryStaysConstantOverFramesOfManyShapes) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines, 2);
    std::uint64_t after_two_rounds = 0;
    for (int frame = 0; frame < 2000; ++frame) {
        const int kind = frame % 5;
        graph::Graph graph(runner.make_history());
        const graph::ImageHandle last = graph.add_image(
            {"last", TexelFormat::rgba16f, 64u << kind, 64});
        const graph::ImageHandle out = graph.add_image(
            {"out", TexelFormat::rgba16f, 64u << (4 - kind), 64});
        for (const graph::ImageHandle& image : {last, out})
            graph.add_pass("clear/" + graph.images()[image.id].name)
                .reads(graph.previous(last), ResourceUse::sampled)
                .writes(image, ResourceUse::colour, graph::ClearValue{})
                .record([](graph::PassCommands&) {});
        if (kind == 3) {
            const graph::ImageHandle kept = graph.add_persistent(
                {"kept", TexelFormat::rgba16f, 64, 64});
            if (!graph.has_content_hash(kept, 1)) {
                graph.add_pass("keep")
                    .writes(kept, ResourceUse::colour, graph::ClearValue{})
                    .record([](graph::PassCommands&) {});
                graph.set_content_hash(kept, 1);
            }
        }
        graph.output(out);
        runner.submit_frame(graph, graph::PassTiming::pipelined);
        if (frame == 9) after_two_rounds = runner.allocated_bytes();
        // Memory is compared every fifth frame, because an image that the next frame reads has the
        // size of the present shape.
        if (frame % 5 == 4 && frame > 9) {
            EXPECT_EQ(runner.allocated_bytes(), after_two_rounds) << frame;
        }
    }
    EXPECT_EQ(runner.plan_count(), 6u);
}

} // namespace
