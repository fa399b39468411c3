#include "graph/access.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

ResourceAccess make_resource_access_of_use(const ImageUse& use) {
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

ResourceAccess make_resource_access_of_use(const BufferUse& use) {
    return {.is_buffer = true,
            .id = use.buffer.id,
            .previous = use.buffer.previous,
            .use = use.use,
            .write = use.write,
            .needs = !use.write || use.use == ResourceUse::storage};
}

void append_accesses_of_pass(std::vector<ResourceAccess>& all, const Pass& pass) {
    for (const ImageUse& use : pass.images) all.push_back(make_resource_access_of_use(use));
    for (const BufferUse& use : pass.buffers) all.push_back(make_resource_access_of_use(use));
}

} // namespace

std::vector<ResourceAccess> list_pass_accesses(const Pass& pass) {
    std::vector<ResourceAccess> all;
    append_accesses_of_pass(all, pass);
    return all;
}

GraphAccesses::GraphAccesses(const Graph& graph) {
    first_.reserve(graph.list_passes().size() + 1);
    for (const Pass& pass : graph.list_passes()) {
        first_.push_back(all_.size());
        append_accesses_of_pass(all_, pass);
    }
    first_.push_back(all_.size());
}

ResourceAccess make_access_to_image_part(const ImageHandle& image) {
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
                          : make_access_to_whole_image(graph, part.id);
}

ResourceAccess make_access_to_whole_image(const Graph& graph, std::uint32_t image) {
    const ImageDesc& desc = graph.list_images()[image];
    return {.id = image, .layer_count = desc.layers, .mip_count = desc.mips};
}

ValuesPerSubresource<char> mark_output_image_parts(const Graph& graph) {
    ValuesPerSubresource<char> wanted(graph, false);
    for (const ImageHandle& image : graph.list_output_images())
        wanted.set_subresource_values_of_access(make_access_to_image_part(image), true);
    for (const BufferHandle& buffer : graph.list_output_buffers())
        wanted.set_subresource_values_of_access({.is_buffer = true, .id = buffer.id}, true);
    return wanted;
}

AccessState make_access_state(const ResourceAccess& access, const Pass& pass) {
    return {.nothing = false,
            .use = access.use,
            .write = access.write,
            .raster = pass.is_raster_pass()};
}

std::string quote_resource_name(const Graph& graph, const ResourceAccess& access) {
    return "'" +
           (access.is_buffer ? graph.list_buffers()[access.id].name
                             : graph.list_images()[access.id].name) +
           "'";
}

namespace {

std::string format_number_range(std::uint64_t first, std::uint64_t end) {
    return "[" + std::to_string(first) + "," + std::to_string(end) + ")";
}

} // namespace

std::string format_layer_range(const ImageDesc& desc, std::uint32_t first, std::uint32_t end) {
    const std::uint32_t mip = first / desc.layers;
    const std::uint32_t end_layer = std::min(end - mip * desc.layers, desc.layers);
    const std::string layers = "layers " + format_number_range(first % desc.layers, end_layer);
    return desc.mips == 1 ? layers : layers + " of mip " + std::to_string(mip);
}

std::string describe_access(const Graph& graph, const ResourceAccess& access) {
    const std::string name = quote_resource_name(graph, access);
    if (access.is_buffer) return "buffer " + (access.previous ? "previous(" + name + ")" : name);
    std::string part = " " + format_number_range(access.first_layer, access.end_layer_of_access());
    const ImageDesc& desc = graph.list_images()[access.id];
    if (desc.mips > 1 || access.first_mip > 0)
        part += access.mip_count == 1
                    ? " mip " + std::to_string(access.first_mip)
                    : " mips " + format_number_range(access.first_mip, access.end_mip_of_access());
    return (access.previous ? "previous(" + name + ")" : name) + part;
}

} // namespace catoptric::graph
