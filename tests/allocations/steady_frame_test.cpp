// Tests that each frame of a still scene makes the same number of heap allocations.
#include "allocations/counting.hpp"
#include "import/load.hpp"
#include "render/gpu_scene.hpp"
#include "render/passes.hpp"
#include "scene/built_in.hpp"
#include "support/device.hpp"
#include "support/techniques.hpp"

#include <iostream>
#include <set>

namespace {

using namespace catoptric;

/// Number of heap allocations for declaring and for recording one frame.
struct CountedAllocations {
    std::size_t declaring = 0, recording = 0;
    friend auto operator<=>(const CountedAllocations&, const CountedAllocations&) = default;
};

class SteadyFrameAllocationTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rows, SteadyFrameAllocationTest,
                         testing::Values("naive:face=16", "reuse:face=16", "parallax:face=16",
                                         "hybrid:face=16", "raytrace:depth=2"),
                         [](const auto& instance) {
                             const std::string text = instance.param;
                             return text.substr(0, text.find(':'));
                         });

TEST_P(SteadyFrameAllocationTest, EachFrameMakesTheSameNumberOfAllocations) {
    gpu::Device device({}); // without the validation layer, whose allocations would count
    gpu::PipelineStore pipelines(device);
    const scene::Scene scene = scene::make_cornell();
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene, scene.cameras.front(), {32, 32}, 0);
    graph::GraphRunner runner(device, pipelines, 2);
    std::set<CountedAllocations> seen;
    std::size_t passes = 0;
    for (int frame = 1; frame <= 20; ++frame) {
        const std::size_t before = test::allocations();
        graph::Graph graph(runner.make_history());
        render::FrameRequests requests(gpu_scene.next_view());
        const render::FrameInputs inputs{gpu_scene, requests, {32, 32}, ""};
        graph.output(test::add_technique(graph, inputs, GetParam()).hdr);
        gpu_scene.fulfil(requests, [] {});
        const std::size_t declared = test::allocations();
        runner.submit_frame(graph, graph::PassTiming::isolated);
        const std::size_t recorded = test::allocations();
        passes = runner.plan(graph).passes.size();
        if (frame >= 5) seen.insert({declared - before, recorded - declared});
    }
    EXPECT_EQ(runner.plan_count(), 1u);
    ASSERT_EQ(seen.size(), 1u);
    std::cout << "[ MEASURED ] " << GetParam() << ", " << passes
              << " passes: " << seen.begin()->declaring << " allocations declaring, "
              << seen.begin()->recording << " recording\n";
    EXPECT_GT(seen.begin()->declaring, 0u); // shows that allocations are counted
}

} // namespace
