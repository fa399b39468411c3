// Tests of indirect dispatches: the number of work groups is the one in the argument buffer at the
// time when the GPU runs the dispatch.
#include "session/access.hpp"
#include "support/device.hpp"

namespace {

using namespace catoptric;

constexpr std::uint32_t kDispatchedWorkGroups = 7;

/// Dispatches `groups` work groups in x, y and z indirectly. Returns what each of the first four
/// work groups counted; 0: the group did not run. `declared`: the pass declares the buffer as
/// indirect arguments.
std::vector<std::uint32_t> dispatch_and_count_groups(std::uint32_t groups, bool declared = true) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::BufferHandle counts = graph.add_buffer({"counts", 16}),
                              arguments = graph.add_buffer({"arguments", 16});
    graph.add_pass("fill")
        .writes(counts, graph::ResourceUse::copy_to)
        .writes(arguments, graph::ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) {
            commands.fill_buffer(counts, 0);
            commands.fill_buffer(arguments, groups);
        });
    graph.add_pass("spin")
        .reads(arguments,
               declared ? graph::ResourceUse::indirect : graph::ResourceUse::storage_read)
        .writes(counts, graph::ResourceUse::storage)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/spin.comp", {}});
            commands.bind("Counts", counts);
            commands.push_constants(kDispatchedWorkGroups);
            commands.dispatch_indirect(arguments, 4);
        });
    graph.output(counts);
    test::run_graph(runner, graph);
    return test::read_resource_values<std::uint32_t>(runner, counts);
}

TEST(Indirect, NumberOfWorkGroupsComesFromTheBuffer) {
    EXPECT_EQ(dispatch_and_count_groups(0), (std::vector<std::uint32_t>{0, 0, 0, 0}));
    EXPECT_EQ(dispatch_and_count_groups(1),
              (std::vector<std::uint32_t>{kDispatchedWorkGroups, 0, 0, 0}));
    EXPECT_EQ(dispatch_and_count_groups(3),
              (std::vector<std::uint32_t>{kDispatchedWorkGroups, kDispatchedWorkGroups,
                                          kDispatchedWorkGroups, 0}));
}

TEST(Indirect, BufferNotDeclaredAsIndirectIsRefused) {
    test::expect_error([] { dispatch_and_count_groups(1, false); }, Failure::internal,
                       {"'spin'", "'arguments'", "indirect"});
}

} // namespace
