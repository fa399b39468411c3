#include "graph/access.hpp"

namespace catoptric::graph {

std::vector<Access> accesses(const Pass& pass) {
    std::vector<Access> all;
    for (const ImageUse& use : pass.images) {
        const bool loads = is_attachment(use.use) && !use.clear;
        all.push_back({.is_buffer = false,
                       .id = use.image.id,
                       .previous = use.image.previous,
                       .first_layer = use.image.first_layer,
                       .layer_count = use.image.layer_count,
                       .use = use.use,
                       .write = use.write,
                       .needs = !use.write || use.use == Use::storage || loads,
                       .clears = use.clear.has_value()});
    }
    for (const BufferUse& use : pass.buffers) {
        all.push_back({.is_buffer = true,
                       .id = use.buffer.id,
                       .use = use.use,
                       .write = use.write,
                       .needs = !use.write || use.use == Use::storage});
    }
    return all;
}

Touch touch_of(const Access& access, const Pass& pass) {
    return {.nothing = false, .use = access.use, .write = access.write, .raster = pass.is_raster()};
}

std::string quoted_name(const Graph& graph, const Access& access) {
    return "'" +
           (access.is_buffer ? graph.buffers()[access.id].name : graph.images()[access.id].name) +
           "'";
}

std::string layers_text(std::uint64_t first, std::uint64_t end) {
    return "layers [" + std::to_string(first) + "," + std::to_string(end) + ")";
}

std::string describe(const Graph& graph, const Access& access) {
    const std::string name = quoted_name(graph, access);
    if (access.is_buffer) return "buffer " + name;
    const std::string layers = " [" + std::to_string(access.first_layer) + "," +
                               std::to_string(access.end_layer()) + ")";
    return (access.previous ? "previous(" + name + ")" : name) + layers;
}

} // namespace catoptric::graph
