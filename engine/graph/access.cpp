#include "graph/access.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

ResourceAccess to_access(const ImageUse& use) {
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
            .needs = !use.write || use.use == ResourceUse::storage || loads,
            .clears = use.clear.has_value()};
}

ResourceAccess to_access(const BufferUse& use) {
    return {.is_buffer = true,
            .id = use.buffer.id,
            .previous = use.buffer.previous,
            .use = use.use,
            .write = use.write,
            .needs = !use.write || use.use == ResourceUse::storage};
}

void append_accesses(std::vector<ResourceAccess>& all, const Pass& pass) {
    for (const ImageUse& use : pass.images) all.push_back(to_access(use));
    for (const BufferUse& use : pass.buffers) all.push_back(to_access(use));
}

} // namespace

std::vector<ResourceAccess> pass_accesses(const Pass& pass) {
    std::vector<ResourceAccess> all;
    append_accesses(all, pass);
    return all;
}

GraphAccesses::GraphAccesses(const Graph& graph) {
    first_.reserve(graph.passes().size() + 1);
    for (const Pass& pass : graph.passes()) {
        first_.push_back(all_.size());
        append_accesses(all_, pass);
    }
    first_.push_back(all_.size());
}

ResourceAccess part_access(const ImageHandle& image) {
    return {.is_buffer = false,
            .id = image.id,
            .previous = image.previous,
            .first_layer = image.first_layer,
            .layer_count = image.layer_count,
            .first_mip = image.first_mip,
            .mip_count = image.mip_count};
}

ResourceAccess whole_resource(const Graph& graph, const ResourceAccess& part) {
    return part.is_buffer ? ResourceAccess{.is_buffer = true, .id = part.id}
                          : whole_image(graph, part.id);
}

ResourceAccess whole_image(const Graph& graph, std::uint32_t image) {
    const ImageDesc& desc = graph.images()[image];
    return {.id = image, .layer_count = desc.layers, .mip_count = desc.mips};
}

SubresourceValues<char> output_parts(const Graph& graph) {
    SubresourceValues<char> wanted(graph, false);
    for (const ImageHandle& image : graph.output_images()) wanted.set(part_access(image), true);
    for (const BufferHandle& buffer : graph.output_buffers())
        wanted.set({.is_buffer = true, .id = buffer.id}, true);
    return wanted;
}

AccessState access_state(const ResourceAccess& access, const Pass& pass) {
    return {.nothing = false, .use = access.use, .write = access.write, .raster = pass.is_raster()};
}

std::string quoted_name(const Graph& graph, const ResourceAccess& access) {
    return "'" +
           (access.is_buffer ? graph.buffers()[access.id].name : graph.images()[access.id].name) +
           "'";
}

namespace {

std::string format_range(std::uint64_t first, std::uint64_t end) {
    return "[" + std::to_string(first) + "," + std::to_string(end) + ")";
}

} // namespace

std::string format_layers(const ImageDesc& desc, std::uint32_t first, std::uint32_t end) {
    const std::uint32_t mip = first / desc.layers;
    const std::uint32_t end_layer = std::min(end - mip * desc.layers, desc.layers);
    const std::string layers = "layers " + format_range(first % desc.layers, end_layer);
    return desc.mips == 1 ? layers : layers + " of mip " + std::to_string(mip);
}

std::string describe_access(const Graph& graph, const ResourceAccess& access) {
    const std::string name = quoted_name(graph, access);
    if (access.is_buffer) return "buffer " + (access.previous ? "previous(" + name + ")" : name);
    std::string part = " " + format_range(access.first_layer, access.end_layer());
    const ImageDesc& desc = graph.images()[access.id];
    if (desc.mips > 1 || access.first_mip > 0)
        part += access.mip_count == 1 ? " mip " + std::to_string(access.first_mip)
                                      : " mips " + format_range(access.first_mip, access.end_mip());
    return (access.previous ? "previous(" + name + ")" : name) + part;
}

} // namespace catoptric::graph
