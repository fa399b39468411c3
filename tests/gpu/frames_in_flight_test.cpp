// Tests of several frames in flight. They must produce the same results as one frame after the
// other, and a read of a frame whose slot was reused must be refused.
#include "gpu/steps.hpp"

namespace {

using namespace catoptric;
using test::expect_error;

/// Adds a frame of three passes. From the image `kept` of the last frame, the frame computes a new
/// image `kept`, by way of an image `between`.
graph::ImageHandle add_frame_of_three_passes(graph::Graph& graph, int frame) {
    const graph::ImageHandle kept = test::add_step_image(graph, "kept");
    const graph::ImageHandle between = test::add_step_image(graph, "between");
    const graph::ImageHandle out = test::add_step_image(graph, "out");
    const auto number = static_cast<float>(frame);
    test::add_step_pass(graph, "first", graph.previous(kept), between, number);
    test::add_step_pass(graph, "second", between, kept, 2 * number);
    test::add_step_pass(graph, "third", between, out, 3 * number);
    graph.output(out);
    return out;
}

std::vector<float> expected_texels_of_frame(int frame, std::vector<float>& kept) {
    const auto number = static_cast<float>(frame);
    const std::vector<float> between = test::expected_step_texels(kept, number);
    kept = test::expected_step_texels(between, 2 * number);
    return test::expected_step_texels(between, 3 * number);
}

class InFlight : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Frames, InFlight, testing::Values(1u, 2u, 3u));

TEST_P(InFlight, FramesInFlightEqualFramesOneByOne) {
    constexpr int kInFlightTestFrames = 12;
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines,
                              GetParam());
    std::vector<float> kept(test::kStepImageWidth * test::kHeight, 0.0f);
    std::vector<std::pair<graph::FrameTicket, graph::ImageHandle>> waiting;
    int read = 0;
    const auto read_oldest = [&] {
        const auto [ticket, image] = waiting.front();
        waiting.erase(waiting.begin());
        const std::vector<std::byte> bytes = runner.read_back(ticket, image);
        std::vector<float> found(bytes.size() / sizeof(float));
        std::memcpy(found.data(), bytes.data(), bytes.size());
        EXPECT_EQ(found, expected_texels_of_frame(++read, kept)) << "frame " << read;
    };
    for (int frame = 1; frame <= kInFlightTestFrames; ++frame) {
        if (waiting.size() == GetParam()) read_oldest();
        graph::Graph graph(runner.make_history());
        const graph::ImageHandle out = add_frame_of_three_passes(graph, frame);
        const auto timing = frame % 2 ? graph::PassTiming::pipelined : graph::PassTiming::isolated;
        waiting.emplace_back(runner.submit_frame(graph, timing), out);
    }
    while (!waiting.empty()) read_oldest();
    EXPECT_EQ(read, kInFlightTestFrames);
    EXPECT_EQ(runner.plan_count(), 1u);
}

TEST_P(InFlight, WaitReturnsTheTimesOfItsOwnFrame) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines,
                              GetParam());
    std::vector<graph::FrameTicket> tickets;
    for (std::uint32_t frame = 1; frame <= GetParam(); ++frame) {
        graph::Graph graph;
        const graph::ImageHandle image = test::add_step_image(graph, "image");
        test::add_start_pass(graph, image, 1);
        graph.output(image);
        // Each frame of this test has one pass more than the frame before.
        for (std::uint32_t i = 1; i < frame; ++i) {
            const graph::ImageHandle next = test::add_step_image(graph,
                                                                 "image" + std::to_string(i));
            test::add_step_pass(graph, "step" + std::to_string(i), image, next, 1);
            graph.output(next);
        }
        tickets.push_back(runner.submit_frame(graph, graph::PassTiming::isolated));
        EXPECT_EQ(tickets.back().frame, frame);
    }
    for (std::uint32_t frame = GetParam(); frame >= 1; --frame) { // read the newest frame first
        const graph::GraphFrameTimes& times = runner.wait_for(tickets[frame - 1]);
        EXPECT_EQ(times.passes.size(), frame);
        EXPECT_GT(times.record_ms, 0);
        EXPECT_GT(times.compile_ms, 0);
        EXPECT_GT(times.wall_ms, 0);
        EXPECT_EQ(&runner.wait_for(tickets[frame - 1]), &times);
    }
}

TEST(InFlight, ReadingAFrameWhoseSlotWasReusedIsRefused) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines, 2);
    std::vector<graph::FrameTicket> tickets;
    graph::ImageHandle out;
    for (int frame = 1; frame <= 3; ++frame) {
        graph::Graph graph(runner.make_history());
        out = add_frame_of_three_passes(graph, frame);
        tickets.push_back(runner.submit_frame(graph, graph::PassTiming::pipelined));
    }
    expect_error([&] { runner.wait_for(tickets[0]); }, Failure::internal,
                 {"frame 1 is gone: its place was taken by frame 3, with 2 in flight"});
    expect_error([&] { runner.wait_for({4}); }, Failure::internal,
                 {"frame 4 is asked for, but 3 were submitted"});
    EXPECT_NO_THROW(runner.read_back(tickets[1], out));
    constexpr graph::ImageHandle kKeptImage{.id = 0, .first_layer = 0, .layer_count = 1};
    expect_error([&] { runner.read_back(tickets[1], kKeptImage); }, Failure::internal,
                 {"image 'kept' of frame 2 is read after frame 3 was submitted"});
    EXPECT_NO_THROW(runner.read_back(tickets[2], kKeptImage));
}

TEST(InFlight, FewerThanOneOrMoreThanThreeFramesInFlightAreRefused) {
    for (const std::uint32_t count : {0u, 4u})
        expect_error(
            [&] {
                graph::GraphRunner(test::get_test_device().device,
                                   test::get_test_device().pipelines, count);
            },
            Failure::usage, {"frames in flight must be 1 to 3, not " + std::to_string(count)});
}

TEST(InFlight, RunnerCanBeDestroyedWithFramesInFlight) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines, 3);
    for (int frame = 1; frame <= 3; ++frame) {
        graph::Graph graph(runner.make_history());
        add_frame_of_three_passes(graph, frame);
        runner.submit_frame(graph, graph::PassTiming::pipelined);
    }
}

/// Adds a chain of `kind` passes and returns the last image of the chain. Graphs with different
/// numbers of passes and images have different shapes.
graph::ImageHandle add_chain_of_kind(graph::Graph& graph, int kind) {
    graph::ImageHandle last = test::add_step_image(graph, "start");
    test::add_start_pass(graph, last, 1);
    for (int i = 0; i < kind; ++i) {
        const graph::ImageHandle next = test::add_step_image(graph, "next" + std::to_string(i));
        test::add_step_pass(graph, "step" + std::to_string(i), last, next, static_cast<float>(i));
        last = next;
    }
    graph.output(last);
    return last;
}

std::vector<float> expected_texels_of_chain(int kind) {
    std::vector<float> values = test::expected_start_texels(1);
    for (int i = 0; i < kind; ++i)
        values = test::expected_step_texels(values, static_cast<float>(i));
    return values;
}

TEST(Shapes, TheLastEightShapesAreNotPlannedAgain) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines, 2);
    for (int round = 0; round < 4; ++round)
        for (int kind = 0; kind < 8; ++kind) {
            graph::Graph graph;
            const graph::ImageHandle last = add_chain_of_kind(graph, kind);
            test::run_graph(runner, graph);
            EXPECT_EQ(test::read_resource_values<float>(runner, last),
                      expected_texels_of_chain(kind));
        }
    EXPECT_EQ(runner.plan_count(), 8u);
    graph::Graph ninth;
    add_chain_of_kind(ninth, 8);
    test::run_graph(runner, ninth); // replaces the plan of shape 0, which was used longest ago
    graph::Graph second, first;
    add_chain_of_kind(second, 1);
    test::run_graph(runner, second);
    EXPECT_EQ(runner.plan_count(), 9u);
    add_chain_of_kind(first, 0);
    test::run_graph(runner, first);
    EXPECT_EQ(runner.plan_count(), 10u);
}

TEST(Shapes, ShapeDependsOnAllDeclarationsExceptBodiesAndClearValues) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    const auto frame = [&](const std::string& name, float red) {
        graph::Graph graph;
        const graph::ImageHandle image = graph.add_image({"image", TexelFormat::rgba32f, 2, 1});
        graph.add_pass(name)
            .writes(image, graph::ResourceUse::colour, graph::ClearValue{red, 0, 0, 1})
            .record([](graph::PassCommands&) {});
        graph.output(image);
        runner.plan(graph);
        test::run_graph(runner, graph);
        return test::read_resource_values<float>(runner, image)[0];
    };
    EXPECT_EQ(frame("clear", 1), 1);
    EXPECT_EQ(frame("clear", 2), 2);
    EXPECT_EQ(runner.plan_count(), 1u);
    EXPECT_EQ(frame("cleared", 3), 3);
    EXPECT_EQ(runner.plan_count(), 2u);
}

TEST(Shapes, InvalidGraphOfAPlannedShapeIsRefused) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    for (const bool wrong : {false, true}) {
        graph::Graph graph;
        const graph::ImageHandle image = test::add_step_image(graph, "image");
        graph::PassBuilder pass = graph.add_pass("clear").writes(image, graph::ResourceUse::colour,
                                                                 graph::ClearValue{});
        if (!wrong) pass.record([](graph::PassCommands&) {});
        graph.output(image);
        if (wrong)
            expect_error([&] { test::run_graph(runner, graph); }, Failure::internal,
                         {"pass 'clear' has no body"});
        else
            test::run_graph(runner, graph);
    }
}

} // namespace
