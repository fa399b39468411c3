#include "render/box_filter.hpp"

#include "graph/commands.hpp"

#include <algorithm>

namespace catoptric::render {

using graph::ImageHandle;
using graph::ResourceUse;

void declare_writes_of_all_mips(graph::PassBuilder& pass, const ImageHandle& levels) {
    for (std::uint32_t mip = 0; mip < levels.mip_count; ++mip)
        pass.writes(levels.select_image_mip(mip), ResourceUse::storage_write);
}

void add_box_filter_pass(graph::Graph& graph, const std::string& name,
                         const std::vector<BoxFilteredLayers>& filtered) {
    struct LayersOfSize {
        BoxFilteredLayers layers;
        std::uint32_t width, height; ///< of level 1, texels
    };
    std::vector<LayersOfSize> runs;
    graph::PassBuilder pass = graph.add_pass(name);
    for (const BoxFilteredLayers& layers : filtered) {
        pass.reads(layers.unfiltered, ResourceUse::sampled);
        declare_writes_of_all_mips(pass, layers.levels);
        const graph::ImageDesc& desc = graph.list_images()[layers.levels.id];
        runs.push_back({layers, desc.width, desc.height});
    }
    pass.record([runs = std::move(runs)](graph::PassCommands& commands) {
        std::uint32_t deepest = 0;
        for (const LayersOfSize& run : runs)
            deepest = std::max(deepest, run.layers.levels.mip_count);
        for (std::uint32_t level = 1; level <= deepest; ++level) {
            if (level > 1) commands.storage_barrier();
            commands.bind_pipeline(
                gpu::ComputePipelineState{"rough/box.comp", {{"from_level", level > 1 ? 1u : 0u}}});
            for (const auto& [layers, width, height] : runs) {
                if (level > layers.levels.mip_count) continue;
                commands.bind_resource("unfiltered", layers.unfiltered);
                commands.bind_resource("below",
                                       layers.levels.select_image_mip(std::max(level, 2u) - 2));
                commands.bind_resource("level", layers.levels.select_image_mip(level - 1));
                const auto groups = [&](std::uint32_t side) {
                    return (graph::size_at_mip(side, level - 1) + 7) / 8;
                };
                commands.dispatch(groups(width), groups(height), layers.levels.layer_count);
            }
        }
    });
}

} // namespace catoptric::render
