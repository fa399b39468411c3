#include "render/box_filter.hpp"

#include "graph/commands.hpp"

#include <algorithm>
#include <bit>

namespace catoptric::render {

using graph::ImageHandle;
using graph::ResourceUse;

void declare_mip_writes(graph::PassBuilder& pass, const ImageHandle& levels) {
    for (std::uint32_t mip = 0; mip < levels.mip_count; ++mip)
        pass.writes(levels.mip(mip), ResourceUse::storage_write);
}

ImageHandle add_picture_levels(graph::Graph& graph, std::string name, uvec2 size) {
    const auto mips = static_cast<std::uint32_t>(std::bit_width(std::max(size.x, size.y)));
    return graph.add_image({std::move(name), TexelFormat::rgba16f, graph::mip_size(size.x, 1),
                            graph::mip_size(size.y, 1), 1, false, std::max(mips, 2u) - 1});
}

namespace {

/// Push constants of rough/box.comp: texels of a level and of the level below. They matter if the
/// image has an area.
struct BoxFilterParameters {
    uvec2 first;           ///< the texel that the dispatch begins with
    uvec2 lowest, highest; ///< of the level below that have a value
};

/// A range of texels; `highest` belongs to it.
struct TexelRange {
    uvec2 lowest{0}, highest{0};
    uvec2 size() const { return highest - lowest + 1u; }
};

/// Returns the texels of a level of an image of this size that have a value. At level 0 these are
/// the pixels of `area`.
TexelRange defined_texels(const graph::PixelRectangle& area, uvec2 size, std::uint32_t level) {
    const uvec2 low(area.x, area.y), end = low + uvec2(area.width, area.height);
    if (level == 0) return {low, end - 1u};
    const uvec2 own(graph::mip_size(size.x, level), graph::mip_size(size.y, level));
    const uvec2 first = low * own / size, last = (end * own + size - 1u) / size;
    return {max(first, uvec2(1)) - 1u, min(last, own - 1u)};
}

} // namespace

void add_box_filter(graph::Graph& graph, const std::string& name,
                    const std::vector<BoxFilteredLayers>& filtered) {
    struct LayersOfSize {
        BoxFilteredLayers layers;
        uvec2 size; ///< of the image, texels
    };
    std::vector<LayersOfSize> runs;
    graph::PassBuilder pass = graph.add_pass(name);
    for (const BoxFilteredLayers& layers : filtered) {
        pass.reads(layers.unfiltered, ResourceUse::sampled);
        if (layers.distances) pass.reads(*layers.distances, ResourceUse::sampled);
        declare_mip_writes(pass, layers.levels);
        const graph::ImageDesc& desc = graph.images()[layers.unfiltered.id];
        runs.push_back({layers, {desc.width, desc.height}});
    }
    pass.record([runs = std::move(runs)](graph::PassCommands& commands) {
        std::uint32_t deepest = 0;
        for (const LayersOfSize& run : runs)
            deepest = std::max(deepest, run.layers.levels.mip_count);
        for (std::uint32_t level = 1; level <= deepest; ++level) {
            if (level > 1) commands.storage_barrier();
            for (const auto& [layers, size] : runs) {
                if (level > layers.levels.mip_count) continue;
                const graph::PixelRectangle area = layers.area.value_or(
                    graph::PixelRectangle{0, 0, size.x, size.y});
                const TexelRange written = defined_texels(area, size, level),
                                 read = defined_texels(area, size, level - 1);
                commands.bind_pipeline(
                    gpu::ComputeState{"rough/box.comp",
                                      {{"from_level", level > 1 ? 1u : 0u},
                                       {"has_area", layers.area ? 1u : 0u},
                                       {"has_distances", layers.distances ? 1u : 0u}}});
                commands.push_constants(
                    BoxFilterParameters{written.lowest, read.lowest, read.highest});
                commands.bind("unfiltered", layers.unfiltered);
                if (layers.distances) commands.bind("distances", *layers.distances);
                commands.bind("below", layers.levels.mip(std::max(level, 2u) - 2));
                commands.bind("level", layers.levels.mip(level - 1));
                const uvec2 groups = (written.size() + 7u) / 8u;
                commands.dispatch(groups.x, groups.y, layers.levels.layer_count);
            }
        }
    });
}

} // namespace catoptric::render
