// Test of a device that is lost while frames are in flight: the wait for a frame reports the loss.
#include "faults/faults.hpp"
#include "graph/graph_runner.hpp"

namespace {

using namespace catoptric;

class DeviceLostInFlightTest : public Faults {};

graph::Graph make_one_frame_graph() {
    graph::Graph graph;
    const graph::ImageHandle image = graph.add_image({"image", TexelFormat::rgba8_unorm, 4, 4});
    graph.add_pass("clear it")
        .writes(image, graph::ResourceUse::colour, graph::ClearValue{})
        .record([](graph::PassCommands&) {});
    graph.output(image);
    return graph;
}

std::string error_text_of_action(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.failure == Failure::device_lost ? error.what() : "another failure";
    }
    return "nothing was thrown";
}

/// The test submits three frames, and the first wait fails.
TEST_F(DeviceLostInFlightTest, WaitReportsTheLostDevice) {
    const std::string said = test::run_in_forked_process([&] {
        FaultLayerInThisProcess here(folder / "calls");
        std::string wrong;
        const VulkanCallFault fault{"vkWaitSemaphores", 1, VK_ERROR_DEVICE_LOST};
        const WatchedRun watched = here.run(fault, [&](session::Engine&) {
            gpu::Device device({});
            gpu::PipelineStore pipelines(device);
            graph::GraphRunner runner(device, pipelines, 3);
            std::vector<graph::FrameTicket> tickets;
            for (int i = 0; i < 3; ++i)
                tickets.push_back(
                    runner.submit_frame(make_one_frame_graph(), graph::PassTiming::isolated));
            const std::string first = error_text_of_action([&] { runner.wait_for(tickets[1]); });
            if (first.find("run frame 2 (passes 'clear it')") == std::string::npos) wrong += first;
            const std::string next = error_text_of_action(
                [&] { runner.submit_frame(make_one_frame_graph(), graph::PassTiming::isolated); });
            if (next != "the device was given up: " + first) wrong += next;
            if (!device.is_abandoned()) wrong += "not abandoned";
        });
        return wrong + watched.ended.err;
    });
    EXPECT_EQ(said, "");
}

} // namespace
