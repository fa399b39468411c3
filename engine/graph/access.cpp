#include "graph/access.hpp"

namespace catoptric::graph {

namespace {

Access access_of(const ImageUse& use) {
    const bool loads = is_attachment(use.use) && !use.clear;
    return {.is_buffer = false,
            .id = use.image.id,
            .previous = use.image.previous,
            .first_layer = use.image.first_layer,
            .layer_count = use.image.layer_count,
            .use = use.use,
            .write = use.write,
            .needs = !use.write || use.use == Use::storage || loads,
            .clears = use.clear.has_value()};
}

Access access_of(const BufferUse& use) {
    return {.is_buffer = true,
            .id = use.buffer.id,
            .use = use.use,
            .write = use.write,
            .needs = !use.write || use.use == Use::storage};
}

void add(std::vector<Access>& all, const Pass& pass) {
    for (const ImageUse& use : pass.images) all.push_back(access_of(use));
    for (const BufferUse& use : pass.buffers) all.push_back(access_of(use));
}

} // namespace

std::vector<Access> accesses(const Pass& pass) {
    std::vector<Access> all;
    add(all, pass);
    return all;
}

Accesses::Accesses(const Graph& graph) {
    first_.reserve(graph.passes().size() + 1);
    for (const Pass& pass : graph.passes()) {
        first_.push_back(all_.size());
        add(all_, pass);
    }
    first_.push_back(all_.size());
}

Ledger<char> wanted_parts(const Graph& graph) {
    Ledger<char> wanted(graph, false);
    for (const Image& image : graph.wanted_images())
        wanted.set(
            {.id = image.id, .first_layer = image.first_layer, .layer_count = image.layer_count},
            true);
    for (const Buffer& buffer : graph.wanted_buffers())
        wanted.set({.is_buffer = true, .id = buffer.id}, true);
    return wanted;
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
