#include "graph/validate.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <tuple>

namespace catoptric::graph {

namespace {

bool can_read(ResourceUse use, bool is_buffer) {
    switch (use) {
    case ResourceUse::sampled:
    case ResourceUse::storage_read:
    case ResourceUse::copy_from: return true;
    case ResourceUse::depth: return !is_buffer;
    case ResourceUse::indirect: return is_buffer;
    default: return false;
    }
}

bool can_write(ResourceUse use, bool is_buffer) {
    switch (use) {
    case ResourceUse::storage_write:
    case ResourceUse::storage:
    case ResourceUse::copy_to: return true;
    case ResourceUse::colour:
    case ResourceUse::depth: return !is_buffer;
    default: return false;
    }
}

void check_handle(const Graph& graph, const Pass& pass, const ResourceAccess& a) {
    const std::size_t count = a.is_buffer ? graph.buffers().size() : graph.images().size();
    check(a.id < count, kInvalidGraph, "pass '", pass.name, "' names ",
          a.is_buffer ? "buffer" : "image", " number ", a.id, ", but the graph has ", count);
    if (a.is_buffer) return;
    const auto& [layers, mips] = std::pair(graph.images()[a.id].layers, graph.images()[a.id].mips);
    if (a.layer_count == 0)
        fail(kInvalidGraph, "pass '", pass.name, "' names no layer of ", quoted_name(graph, a),
             " as ", use_name(a.use));
    if (a.end_layer() > layers)
        fail(kInvalidGraph, "pass '", pass.name, "' uses ", describe_access(graph, a), " as ",
             use_name(a.use), ", but the image has layers [0,", layers, ")");
    if (a.mip_count == 0 || a.end_mip() > mips)
        fail(kInvalidGraph, "pass '", pass.name, "' uses ", describe_access(graph, a), " as ",
             use_name(a.use), ", but the image has mips [0,", mips, ")");
    if (a.mip_count > 1 && a.use != ResourceUse::sampled)
        fail(kInvalidGraph, "pass '", pass.name, "' uses ", describe_access(graph, a), " as ",
             use_name(a.use), ": one mip at a time");
}

void check_attachment_format(const Graph& graph, const Pass& pass, const ResourceAccess& a) {
    const TexelFormat format = graph.images()[a.id].format;
    if (is_depth(format) == (a.use == ResourceUse::depth)) return;
    fail(kInvalidGraph, "pass '", pass.name, "' uses ", describe_access(graph, a), " as ",
         use_name(a.use), ", but its format ", format_name(format), " is a ",
         is_depth(format) ? "depth" : "colour", " format");
}

/// Error texts are built only on failure, because most passes are valid.
void check_use(const Graph& graph, const Pass& pass, const ResourceAccess& a) {
    if (a.write && a.previous)
        fail(kInvalidGraph, "pass '", pass.name, "' writes ", describe_access(graph, a), " as ",
             use_name(a.use), ": last frame's contents are only read");
    if (!(a.write ? can_write(a.use, a.is_buffer) : can_read(a.use, a.is_buffer)))
        fail(kInvalidGraph, "pass '", pass.name, "' ", a.write ? "writes " : "reads ",
             describe_access(graph, a), " as ", use_name(a.use), ", which is not a way to ",
             a.write ? "write " : "read ", a.is_buffer ? "a buffer" : "an image");
    if (a.clears && !is_attachment(a.use))
        fail(kInvalidGraph, "pass '", pass.name, "' clears ", describe_access(graph, a), " as ",
             use_name(a.use), ", but only attachments are cleared");
    if (a.clears && a.needs && !pass.area)
        fail(kInvalidGraph, "pass '", pass.name, "' updates ", describe_access(graph, a), " as ",
             use_name(a.use), ", but has no area to do it in");
    if (pass.is_raster() && (a.use == ResourceUse::copy_from || a.use == ResourceUse::copy_to))
        fail(kInvalidGraph, "pass '", pass.name, "' has attachments and uses ",
             describe_access(graph, a), " as ", use_name(a.use),
             ": copies need a pass of their own");
    if (!a.is_buffer && is_attachment(a.use)) check_attachment_format(graph, pass, a);
}

void check_equal_sizes(const Graph& graph, const Pass& pass, const ResourceAccess& a,
                       const ResourceAccess& b) {
    const ImageDesc& x = graph.images()[a.id];
    const ImageDesc& y = graph.images()[b.id];
    const auto size = [](const ImageDesc& desc, const ResourceAccess& at) {
        return std::pair(mip_size(desc.width, at.first_mip), mip_size(desc.height, at.first_mip));
    };
    const auto [width, height] = size(x, a);
    const auto [width2, height2] = size(y, b);
    if (width == width2 && height == height2) return;
    fail(kInvalidGraph, "pass '", pass.name, "' attaches ", describe_access(graph, a), " as ",
         use_name(a.use), " (", width, "x", height, ") and ", describe_access(graph, b), " as ",
         use_name(b.use), " (", width2, "x", height2, "): attachments have one size");
}

void check_attachments(const Graph& graph, const Pass& pass, std::span<const ResourceAccess> all) {
    const ResourceAccess* first = nullptr;
    const ResourceAccess* depth = nullptr;
    for (const ResourceAccess& a : all) {
        if (a.is_buffer || !is_attachment(a.use)) continue;
        if (a.layer_count != pass.layer_count)
            fail(kInvalidGraph, "pass '", pass.name, "' renders ", pass.layer_count,
                 " layer(s), but attaches ", describe_access(graph, a), " as ", use_name(a.use),
                 ", which are ", a.layer_count);
        if (a.use == ResourceUse::depth && depth)
            fail(kInvalidGraph, "pass '", pass.name, "' attaches both ",
                 describe_access(graph, *depth), " and ", describe_access(graph, a), " as depth");
        if (a.use == ResourceUse::depth) depth = &a;
        if (!first) first = &a;
        check_equal_sizes(graph, pass, *first, a);
    }
}

/// Throws if two uses of the same contents in one pass are in conflict.
void check_pair(const Graph& graph, const Pass& pass, const ResourceAccess& a,
                const ResourceAccess& b) {
    const std::uint64_t first = std::max(a.first_layer, b.first_layer);
    const std::uint64_t end = std::min(a.end_layer(), b.end_layer());
    const std::uint64_t mip = std::max(a.first_mip, b.first_mip);
    if (first >= end || mip >= std::min(a.end_mip(), b.end_mip())) return;
    const auto where = [&]() -> std::string {
        if (a.is_buffer) return "";
        const ImageDesc& desc = graph.images()[a.id];
        const auto base = static_cast<std::uint32_t>(mip * desc.layers);
        return ", in " + format_layers(desc, base + static_cast<std::uint32_t>(first),
                                       base + static_cast<std::uint32_t>(end));
    };
    if (a.write && b.write)
        fail(kInvalidGraph, "pass '", pass.name, "' writes ", describe_access(graph, a), " as ",
             use_name(a.use), " and ", describe_access(graph, b), " as ", use_name(b.use),
             ": written twice", where());
    const ResourceAccess& read = a.write ? b : a;
    const ResourceAccess& other = a.write ? a : b;
    if (other.write)
        fail(kInvalidGraph, "pass '", pass.name, "' reads ", describe_access(graph, read), " as ",
             use_name(read.use), " while it writes ", describe_access(graph, other), " as ",
             use_name(other.use), where());
    if (!a.is_buffer && a.use != b.use)
        fail(kInvalidGraph, "pass '", pass.name, "' reads ", describe_access(graph, a), " as ",
             use_name(a.use), " and ", describe_access(graph, b), " as ", use_name(b.use),
             ": one image cannot be in two layouts at once", where());
}

/// Checks all pairs of uses of one resource.
void check_pairs(const Graph& graph, const Pass& pass, std::span<const ResourceAccess> all) {
    const auto key = [](const ResourceAccess* a) {
        // Pointers into the list of accesses sort in the order of declaration.
        return std::tuple(a->is_buffer, a->id, a->previous, a);
    };
    std::vector<const ResourceAccess*> sorted;
    sorted.reserve(all.size());
    for (const ResourceAccess& a : all) sorted.push_back(&a);
    std::ranges::sort(sorted, {}, key);
    for (std::size_t i = 0; i < sorted.size(); ++i)
        for (std::size_t j = i + 1; j < sorted.size(); ++j) {
            const ResourceAccess &a = *sorted[i], &b = *sorted[j];
            if (a.is_buffer != b.is_buffer || a.id != b.id || a.previous != b.previous) break;
            check_pair(graph, pass, a, b);
        }
}

} // namespace

void validate_pass(const Graph& graph, const Pass& pass, std::span<const ResourceAccess> all,
                   const GraphLimits& limits) {
    check(static_cast<bool>(pass.body), kInvalidGraph, "pass '", pass.name, "' has no body");
    check(pass.layer_count > 0, kInvalidGraph, "pass '", pass.name, "' renders 0 layers");
    for (const ResourceAccess& a : all) {
        check_handle(graph, pass, a);
        check_use(graph, pass, a);
    }
    check(std::ranges::any_of(all, &ResourceAccess::write), kInvalidGraph, "pass '", pass.name,
          "' writes nothing");
    check_pairs(graph, pass, all);
    check_attachments(graph, pass, all);
    if (pass.layer_count > limits.max_framebuffer_layers)
        fail(Failure::exhausted, "pass '", pass.name, "' wants ", pass.layer_count,
             " framebuffer layers for ",
             quoted_name(graph, *std::ranges::find_if(all, &ResourceAccess::write)),
             ", device allows max_framebuffer_layers = ", limits.max_framebuffer_layers);
}

} // namespace catoptric::graph
