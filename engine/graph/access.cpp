#include "graph/access.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

Access access_of(const ImageUse& use) {
    const bool loads = is_attachment(use.use) && (!use.clear || use.stays);
    return {.is_buffer = false,
            .id = use.image.id,
            .previous = use.image.previous,
            .first_layer = use.image.first_layer,
            .layer_count = use.image.layer_count,
            .first_mip = use.image.first_mip,
            .mip_count = use.image.mip_count,
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

Access access_to(const ImageHandle& image) {
    return {.is_buffer = false,
            .id = image.id,
            .previous = image.previous,
            .first_layer = image.first_layer,
            .layer_count = image.layer_count,
            .first_mip = image.first_mip,
            .mip_count = image.mip_count};
}

Access access_to_all(const Graph& graph, std::uint32_t image) {
    const ImageDesc& desc = graph.images()[image];
    return {.id = image, .layer_count = desc.layers, .mip_count = desc.mips};
}

Ledger<char> output_parts(const Graph& graph) {
    Ledger<char> wanted(graph, false);
    for (const ImageHandle& image : graph.output_images()) wanted.set(access_to(image), true);
    for (const BufferHandle& buffer : graph.output_buffers())
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

namespace {

std::string range(std::uint64_t first, std::uint64_t end) {
    return "[" + std::to_string(first) + "," + std::to_string(end) + ")";
}

} // namespace

std::string layers_text(const ImageDesc& desc, std::uint32_t first, std::uint32_t end) {
    const std::uint32_t mip = first / desc.layers;
    const std::uint32_t end_layer = std::min(end - mip * desc.layers, desc.layers);
    const std::string layers = "layers " + range(first % desc.layers, end_layer);
    return desc.mips == 1 ? layers : layers + " of mip " + std::to_string(mip);
}

std::string describe(const Graph& graph, const Access& access) {
    const std::string name = quoted_name(graph, access);
    if (access.is_buffer) return "buffer " + name;
    std::string part = " " + range(access.first_layer, access.end_layer());
    const ImageDesc& desc = graph.images()[access.id];
    if (desc.mips > 1 || access.first_mip > 0)
        part += access.mip_count == 1 ? " mip " + std::to_string(access.first_mip)
                                      : " mips " + range(access.first_mip, access.end_mip());
    return (access.previous ? "previous(" + name + ")" : name) + part;
}

} // namespace catoptric::graph
