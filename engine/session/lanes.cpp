// Counts the lanes of a shader that run together, and compares them with the environment's setting.
#include "session/lanes.hpp"

#include "gpu/instance.hpp"
#include "graph/graph_runner.hpp"
#include "session/embedding.hpp"
#include "session/engine_impl.hpp"

#include <cstring>

namespace catoptric::session {

namespace {

constexpr int kVectorBitsPerLane = 32;

int measure_lanes(gpu::Device& device) {
    gpu::PipelineStore pipelines(device); // separate, so that the engine's counts do not change
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const graph::BufferHandle lanes = graph.add_buffer({"lanes", 16});
    graph.add_pass("lanes")
        .writes(lanes, graph::ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"lanes.comp", {}});
            commands.bind("Lanes", lanes);
            commands.dispatch(1, 1);
        });
    graph.output(lanes);
    runner.run_and_wait(graph, graph::PassTiming::isolated);
    std::uint32_t count = 0;
    std::memcpy(&count, runner.read_back(lanes).data(), sizeof count);
    return static_cast<int>(count);
}

} // namespace

int count_lanes(const Engine& engine) { return measure_lanes(EmbedAccess::device(engine)); }

std::string vector_width_warning(const Engine& engine) {
    const std::optional<long> asked = gpu::llvmpipe_vector_width();
    if (!asked || engine.device().type != "cpu") return "";
    const int bits = kVectorBitsPerLane * count_lanes(engine);
    if (*asked == bits) return "";
    return "LP_NATIVE_VECTOR_WIDTH asks for vectors of " + std::to_string(*asked) +
           " bits, the driver runs code of " + std::to_string(bits) +
           " bits: its cache of shaders does not tell widths apart; give each width a folder of its "
           "own by MESA_SHADER_CACHE_DIR";
}

} // namespace catoptric::session
