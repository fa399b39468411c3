// Tests of a software driver that silently ends all loops of an invocation after 65,535 iterations.
// The engine must report an error, because a picture from rays that were cut short is wrong.
#include "session/access.hpp"
#include "support/device.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

std::uint32_t run_loop_shader(std::uint32_t wanted) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::BufferHandle counts = graph.add_buffer({"counts", 16});
    graph.add_pass("spin")
        .writes(counts, graph::ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/spin.comp", {}});
            commands.bind("Counts", counts);
            commands.push_constants(wanted);
            commands.dispatch(4, 1);
        });
    graph.output(counts);
    test::run_graph(runner, graph);
    return test::read_resource_values<std::uint32_t>(runner, counts).front();
}

TEST(LoopLimit, ShortLoopsRunToTheirEnd) {
    for (const std::uint32_t turns : {0u, 1u, 1000u, 60000u})
        EXPECT_EQ(run_loop_shader(turns), turns);
}

TEST(LoopLimit, LongLoopsRunOrStopAtTheKnownLimit) {
    constexpr std::uint32_t kWantedLoopTurns = 70000, kLimit = 65535;
    const std::uint32_t turns = run_loop_shader(kWantedLoopTurns);
    RecordProperty("turns", static_cast<int>(turns));
    const gpu::DeviceProperties& info = test::get_test_device().device.info();
    std::cout << "[ MEASURED ] " << turns << " of " << kWantedLoopTurns << " turns on " << info.name
              << ", " << info.driver << "\n";
    if (turns == kWantedLoopTurns) GTEST_SKIP() << "this device does not stop loops";
    EXPECT_NEAR(turns, kLimit, 2)
        << "stops loops, but not where the ray tracer's bound of 60,000 steps assumes";
}

/// Returns a scene of two mirrors that face each other, with thin triangles between them. Every ray
/// enters the bounding boxes of the thin triangles and hits none.
scene::Scene make_hall_of_facing_mirrors(int slivers) {
    scene::Scene scene{.name = "hall"};
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    const std::size_t white = test::add_material(scene, {.name = "white", .albedo = vec3(.5f)});
    test::add_quad(scene, "left", mirror, {-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1});
    test::add_quad(scene, "right", mirror, {1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1});
    scene::Mesh cloud{.name = "cloud"};
    for (int i = 0; i < slivers; ++i) {
        const auto first = static_cast<std::uint32_t>(cloud.positions.size());
        const double shift = 1e-5 * i;
        cloud.positions.insert(
            cloud.positions.end(),
            {{-.9 + shift, -.9, -.9}, {.9, .9 - shift, .9}, {.9, .9 - shift, .9 - 1e-4}});
        cloud.triangles.push_back({first, first + 1, first + 2});
    }
    cloud.normals.assign(cloud.positions.size(), vec3(0, 0, 1));
    test::add_mesh(scene, std::move(cloud), white);
    scene.cameras.push_back({.name = "between",
                             .eye = {0, .3, -.5},
                             .target = {1, .3, -.45},
                             .vertical_fov_degrees = 10});
    return scene;
}

TEST(LoopLimit, RayThatReachesItsStepLimitFailsTheRun) {
    test::expect_error(
        [] {
            test::render_technique(make_hall_of_facing_mirrors(3000), "raytrace:depth=64",
                                   {32, 32});
        },
        Failure::exhausted,
        {"'raytrace:depth=64'", "pixels met more triangles and boxes than one invocation may",
         "lower the depth"});
}

TEST(LoopLimit, SameSceneRendersWithLessDepth) {
    const session::TechniqueResult part = test::render_technique(make_hall_of_facing_mirrors(3000),
                                                                 "raytrace:depth=4", {32, 32});
    ASSERT_TRUE(part.rays);
    std::cout << "[ MEASURED ] longest walk at depth 4: " << part.rays->longest_walk << " steps\n";
    EXPECT_GT(part.rays->longest_walk, 1000u);
    EXPECT_LT(part.rays->longest_walk, 60000u);
}

} // namespace
