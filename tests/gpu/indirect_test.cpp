// Tests of indirect dispatches: the number of work groups is the one in the argument buffer at the
// time when the GPU runs the dispatch.
#include "session/access.hpp"
#include "support/device.hpp"

namespace {

using namespace catoptric;

constexpr std::uint32_t kTurns = 7;

/// Dispatches `groups` work groups in x, y and z indirectly. Returns what each of the first four
/// work groups counted; 0: the group did not run. `declared`: the pass declares the buffer as
/// indirect arguments.
std::vector<std::uint32_t> counts_of(std::uint32_t groups, bool declared = true) {
    graph::GraphRunner runner(test::bench().device, test::bench().pipelines);
    graph::Graph graph;
    const graph::BufferHandle counts = graph.buffer({"counts", 16}),
                              arguments = graph.buffer({"arguments", 16});
    graph.pass("fill")
        .writes(counts, graph::ResourceUse::copy_to)
        .writes(arguments, graph::ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) {
            commands.fill(counts, 0);
            commands.fill(arguments, groups);
        });
    graph.pass("spin")
        .reads(arguments,
               declared ? graph::ResourceUse::indirect : graph::ResourceUse::storage_read)
        .writes(counts, graph::ResourceUse::storage)
        .record([=](graph::PassCommands& commands) {
            commands.use(gpu::ComputeState{"tests/spin.comp", {}});
            commands.bind("Counts", counts);
            commands.push(kTurns);
            commands.dispatch_indirect(arguments, 4);
        });
    graph.mark_output(counts);
    test::run(runner, graph);
    return test::read_as<std::uint32_t>(runner, counts);
}

TEST(Indirect, NumberOfWorkGroupsComesFromTheBuffer) {
    EXPECT_EQ(counts_of(0), (std::vector<std::uint32_t>{0, 0, 0, 0}));
    EXPECT_EQ(counts_of(1), (std::vector<std::uint32_t>{kTurns, 0, 0, 0}));
    EXPECT_EQ(counts_of(3), (std::vector<std::uint32_t>{kTurns, kTurns, kTurns, 0}));
}

TEST(Indirect, BufferNotDeclaredAsIndirectIsRefused) {
    test::expect_refused([] { counts_of(1, false); }, Failure::internal,
                         {"'spin'", "'arguments'", "indirect"});
}

} // namespace
