// Tests of the previous frame's images and buffers, and of images that share memory: all must hold
// the right content.
#include "gpu/steps.hpp"

#include <stdexcept>

namespace {

using namespace catoptric;
using test::add_step_image, test::add_start_pass, test::add_step_pass, test::expected_step_texels;
using test::kHeight, test::kStepImageWidth;

TEST(Previous, ImageIsBlackInTheFirstFrameAndThenTheLastFrame) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    std::vector<float> expected(kStepImageWidth * kHeight, 0.0f);
    for (int frame = 1; frame <= 4; ++frame) {
        graph::Graph graph(runner.make_history());
        const graph::ImageHandle image = add_step_image(graph, "kept");
        EXPECT_EQ(graph.has_history(image), frame > 1);
        add_step_pass(graph, "step", graph.previous(image), image, static_cast<float>(frame));
        graph.output(image);
        test::run_graph(runner, graph);
        expected = expected_step_texels(expected, static_cast<float>(frame));
        EXPECT_EQ(test::read_resource_values<float>(runner, image), expected) << "frame " << frame;
    }
}

TEST(Previous, HistoryBelongsToItsRunner) {
    for (int run = 0; run < 2; ++run) {
        graph::GraphRunner runner(test::get_test_device().device,
                                  test::get_test_device().pipelines);
        EXPECT_TRUE(runner.make_history().previous.empty());
        graph::Graph graph(runner.make_history());
        const graph::ImageHandle image = add_step_image(graph, "kept");
        add_step_pass(graph, "step", graph.previous(image), image, 5);
        graph.output(image);
        test::run_graph(runner, graph);
        EXPECT_EQ(test::read_resource_values<float>(runner, image),
                  expected_step_texels(std::vector<float>(kStepImageWidth * kHeight, 0.0f), 5));
    }
}

/// A frame that fails may have replaced images of the frame before. Outputs of the frame before
/// stay if they lie in another slot.
TEST(Previous, ImagesThatAFailedFrameReplacedAreNotReadBack) {
    for (const std::uint32_t in_flight : {1, 2}) {
        graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines,
                                  in_flight);
        graph::Graph graph(runner.make_history());
        const graph::ImageHandle image = add_step_image(graph, "kept"),
                                 plain = add_step_image(graph, "plain");
        add_step_pass(graph, "step", graph.previous(image), image, 5);
        add_start_pass(graph, plain, 3);
        graph.output(image), graph.output(plain);
        test::run_graph(runner, graph);

        graph::Graph other(runner.make_history());
        const graph::ImageHandle larger = other.add_image(
            {"kept", TexelFormat::r32f, 2 * kStepImageWidth, kHeight});
        const graph::ImageHandle output = other.add_image(
            {"output", TexelFormat::r32f, 8 * kStepImageWidth, kHeight});
        other.add_pass("step")
            .reads(other.previous(larger), graph::ResourceUse::sampled)
            .writes(larger, graph::ResourceUse::storage_write)
            .writes(output, graph::ResourceUse::storage_write)
            .record([](graph::PassCommands&) { throw std::runtime_error("no commands"); });
        other.output(larger), other.output(output);
        EXPECT_THROW(test::run_graph(runner, other), std::runtime_error);
        test::expect_error([&] { runner.read_back(image); }, Failure::internal,
                           {in_flight == 1 ? "frame 1 is gone: its place was taken by a frame that "
                                             "failed"
                                           : "image 'kept' is read after it was released"});
        if (in_flight == 2) {
            EXPECT_EQ(test::read_resource_values<float>(runner, plain),
                      test::expected_start_texels(3));
        }
        test::run_graph(runner, graph); // the runner goes on
        EXPECT_EQ(test::read_resource_values<float>(runner, plain), test::expected_start_texels(3));
    }
}

TEST(Previous, HistorySurvivesAFrameOfAnotherShape) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    std::vector<float> expected(kStepImageWidth * kHeight, 0.0f);
    for (int frame = 1; frame <= 3; ++frame) {
        graph::Graph graph(runner.make_history());
        if (frame == 2) { // one image more, declared first, so the number of every image changes
            const graph::ImageHandle other = add_step_image(graph, "other");
            add_start_pass(graph, other, 1);
            graph.output(other);
        }
        const graph::ImageHandle image = add_step_image(graph, "kept");
        EXPECT_EQ(graph.has_history(image), frame > 1);
        add_step_pass(graph, "step", graph.previous(image), image, 2);
        graph.output(image);
        test::run_graph(runner, graph);
        expected = expected_step_texels(expected, 2);
        EXPECT_EQ(test::read_resource_values<float>(runner, image), expected) << "frame " << frame;
    }
}

constexpr std::size_t kStepBufferWords = 100;

/// Adds a pass that makes the words of `buffer` from its words in the last frame, and makes it an
/// output.
graph::BufferHandle add_buffer_step(graph::Graph& graph, std::uint32_t number) {
    const graph::BufferHandle buffer = graph.add_buffer({"words", 4 * kStepBufferWords}),
                              before = graph.previous(buffer);
    graph.add_pass("step")
        .reads(before, graph::ResourceUse::storage_read)
        .writes(buffer, graph::ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/step_buffer.comp", {}});
            commands.bind("Before", before);
            commands.bind("After", buffer);
            commands.push_constants(number);
            commands.dispatch(2, 1, 1);
        });
    graph.output(buffer);
    return buffer;
}

/// Returns the words after one more step.
std::vector<std::uint32_t> expected_step_words(std::vector<std::uint32_t> words,
                                               std::uint32_t number) {
    for (std::uint32_t i = 0; i < words.size(); ++i)
        words[i] = (3 * words[i] + i + number) % (1u << 20);
    return words;
}

TEST(Previous, BufferIsZeroInTheFirstFrameAndThenTheLastFrame) {
    for (const std::uint32_t in_flight : {1, 3}) {
        graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines,
                                  in_flight);
        std::vector<std::uint32_t> expected(kStepBufferWords, 0);
        for (std::uint32_t frame = 1; frame <= 7; ++frame) {
            const bool stays = frame == 3 || frame == 6; // the next frame sees the same last frame
            graph::Graph graph(runner.make_history());
            const graph::BufferHandle buffer = add_buffer_step(graph, frame);
            EXPECT_EQ(graph.has_history(buffer), frame > 1);
            runner.submit_frame(graph, graph::PassTiming::pipelined, stays);
            const std::vector<std::uint32_t> next = expected_step_words(expected, frame);
            EXPECT_EQ(test::read_resource_values<std::uint32_t>(runner, buffer), next)
                << "frame " << frame << ", " << in_flight << " in flight";
            if (!stays) expected = next;
        }
        EXPECT_EQ(runner.read_history().size(), 4 * kStepBufferWords);
        runner.discard_contents();
        graph::Graph graph(runner.make_history());
        const graph::BufferHandle buffer = add_buffer_step(graph, 9);
        test::run_graph(runner, graph);
        EXPECT_EQ(test::read_resource_values<std::uint32_t>(runner, buffer),
                  expected_step_words(std::vector<std::uint32_t>(kStepBufferWords, 0), 9));
    }
}

TEST(Previous, RetainedResourcesCanBeExchanged) {
    graph::RetainedResources retained, aside;
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines, 2,
                              &retained);
    std::vector<std::uint32_t> expected[2]{std::vector<std::uint32_t>(kStepBufferWords, 0),
                                           std::vector<std::uint32_t>(kStepBufferWords, 0)};
    for (std::uint32_t frame = 0; frame < 8; ++frame) { // two sequences, in turn
        graph::Graph graph(runner.make_history());
        const graph::BufferHandle buffer = add_buffer_step(graph, frame);
        runner.submit_frame(graph, graph::PassTiming::pipelined);
        std::vector<std::uint32_t>& words = expected[frame % 2];
        words = expected_step_words(words, frame);
        EXPECT_EQ(test::read_resource_values<std::uint32_t>(runner, buffer), words) << frame;
        runner.release_retained();
        std::swap(retained, aside);
    }
}

TEST(Previous, PreviousOfAnImportedBufferIsRefused) {
    graph::Graph graph;
    const graph::BufferHandle buffer = graph.import_resource({"outside", 16}, nullptr);
    test::expect_error([&] { graph.previous(buffer); }, Failure::internal,
                       {"buffer 'outside'", "imported"});
}

/// Adds a chain of `length` steps. With `apart` all images are outputs, so none share memory.
/// Otherwise only the last image is an output.
graph::ImageHandle add_chain_of_steps(graph::Graph& graph, int length, bool apart) {
    graph::ImageHandle last = add_step_image(graph, "image0");
    add_start_pass(graph, last, 7);
    if (apart) graph.output(last);
    for (int i = 1; i <= length; ++i) {
        const graph::ImageHandle next = add_step_image(graph, "image" + std::to_string(i));
        add_step_pass(graph, "step" + std::to_string(i), last, next, static_cast<float>(i));
        if (apart) graph.output(next);
        last = next;
    }
    graph.output(last);
    return last;
}

TEST(Aliasing, ImagesThatShareMemoryEqualImagesApart) {
    std::vector<float> found[2];
    std::uint64_t bytes[2];
    for (const bool apart : {false, true}) {
        graph::GraphRunner runner(test::get_test_device().device,
                                  test::get_test_device().pipelines);
        for (int frame = 0; frame < 3; ++frame) { // later frames reuse memory
            graph::Graph graph;
            const graph::ImageHandle last = add_chain_of_steps(graph, 9, apart);
            bytes[apart] = runner.plan(graph).bytes;
            runner.run_and_wait(graph, frame == 1 ? graph::PassTiming::pipelined
                                                  : graph::PassTiming::isolated);
            found[apart] = test::read_resource_values<float>(runner, last);
        }
    }
    std::vector<float> expected = test::expected_start_texels(7);
    for (int i = 1; i <= 9; ++i) expected = expected_step_texels(expected, static_cast<float>(i));
    EXPECT_EQ(found[false], expected);
    EXPECT_EQ(found[true], expected);
    EXPECT_LT(2 * bytes[false], bytes[true]); // 3 images in memory instead of 10
}

} // namespace
