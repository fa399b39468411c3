#include "graph/validate.hpp"

#include "core/error.hpp"

#include <bit>
#include <optional>
#include <string_view>
#include <unordered_set>

namespace catoptric::graph {

namespace {

/// Returns the first layers of `access` for which `there` is false; empty if it is true for all.
std::string missing_layers(const Graph& graph, const SubresourceValues<char>& there,
                           const ResourceAccess& access) {
    if (!there.has_any(access, false)) return "";
    std::optional<std::pair<std::uint32_t, std::uint32_t>> missing;
    there.for_each(access, [&](std::uint32_t first, std::uint32_t end, bool is_there) {
        if (!is_there && !missing) missing = {first, end};
    });
    if (access.is_buffer) return "it";
    return format_layers(graph.images()[access.id], missing->first, missing->second);
}

void check_resource_names(const Graph& graph) {
    std::unordered_set<std::string_view> seen;
    seen.reserve(graph.images().size() + graph.buffers().size());
    const auto resource = [&](const std::string& name, std::string_view kind) {
        check(!name.empty(), kInvalidGraph, kind, " number ", seen.size(), " has no name");
        check(seen.insert(name).second, kInvalidGraph, kind, " '", name,
              "': another image or buffer has the same name");
    };
    for (const ImageDesc& desc : graph.images()) resource(desc.name, "image");
    for (const BufferDesc& desc : graph.buffers()) resource(desc.name, "buffer");
    seen.clear();
    seen.reserve(graph.passes().size());
    for (const Pass& pass : graph.passes()) {
        check(!pass.name.empty(), kInvalidGraph, "pass number ", seen.size(), " has no name");
        check(seen.insert(pass.name).second, kInvalidGraph, "pass '", pass.name,
              "' is declared twice: names are unique");
    }
}

void check_image_limits(const ImageDesc& desc, const GraphLimits& limits) {
    check(desc.width > 0 && desc.height > 0 && desc.layers > 0, kInvalidGraph, "image '", desc.name,
          "' is empty: ", desc.width, "x", desc.height, ", ", desc.layers, " layers");
    check(!desc.cube || desc.layers % 6 == 0, kInvalidGraph, "image '", desc.name,
          "' is a cube, but its ", desc.layers, " layers are not a multiple of 6");
    check(!desc.cube || desc.width == desc.height, kInvalidGraph, "image '", desc.name,
          "' is a cube, but not square: ", desc.width, "x", desc.height);
    const std::uint32_t size = std::max(desc.width, desc.height);
    const std::uint32_t allowed = desc.cube ? limits.max_size_cube : limits.max_size_2d;
    check(size <= allowed, Failure::exhausted, "image '", desc.name, "' wants ", size,
          " texels a side, device allows ", desc.cube ? "max_size_cube" : "max_size_2d", " = ",
          allowed);
    check(desc.layers <= limits.max_layers, Failure::exhausted, "image '", desc.name, "' wants ",
          desc.layers, " layers, device allows max_layers = ", limits.max_layers);
    const auto most_mips = static_cast<std::uint32_t>(std::bit_width(size));
    check(desc.mips > 0 && desc.mips <= most_mips, kInvalidGraph, "image '", desc.name, "' wants ",
          desc.mips, " mips, but of ", desc.width, "x", desc.height, " there are 1 to ", most_mips);
}

[[noreturn]] void fail_read_before_write(const Graph& graph, const Pass& pass,
                                         const ResourceAccess& a, const std::string& missing) {
    const char* verb = !a.write                        ? "reads "
                       : a.use == ResourceUse::storage ? "reads and writes "
                       : a.clears                      ? "updates "
                                                       : "loads (has no clear for) ";
    fail(kInvalidGraph, "pass '", pass.name, "' ", verb, describe_access(graph, a), " as ",
         use_name(a.use), " before any pass writes ", missing);
}

/// Returns the image layers and buffers that have contents before the first pass: those of
/// persistent and of imported resources.
SubresourceValues<char> contents_at_start(const Graph& graph) {
    SubresourceValues<char> there(graph, false);
    for (std::uint32_t i = 0; i < graph.images().size(); ++i) {
        const ResourceAccess all = whole_image(graph, i);
        if (graph.image_lifetime(i) == Lifetime::imported && graph.use_on_import(i))
            there.set(all, true);
        if (graph.image_lifetime(i) != Lifetime::persistent) continue;
        graph.hashes_at_start(i).for_each_run(
            [&](std::uint32_t first, std::uint32_t end, const auto& stamp) {
                if (stamp) there.runs(all).fill(first, end, true);
            });
    }
    for (std::uint32_t b = 0; b < graph.buffers().size(); ++b)
        if (graph.is_imported({b})) there.set({.is_buffer = true, .id = b}, true);
    return there;
}

/// Checks that every layer is written before it is read, by an earlier pass of this frame or before
/// the frame. Returns the contents that exist after the last pass.
SubresourceValues<char> check_writes_before_reads(const Graph& graph, const GraphAccesses& all) {
    SubresourceValues<char> written = contents_at_start(graph);
    for (std::size_t p = 0; p < graph.passes().size(); ++p) {
        for (const ResourceAccess& a : all.of_pass(p))
            if (a.needs && !a.previous && written.has_any(a, false))
                fail_read_before_write(graph, graph.passes()[p], a,
                                       missing_layers(graph, written, a));
        for (const ResourceAccess& a : all.of_pass(p))
            if (a.write) written.set(a, true);
    }
    return written;
}

void check_hash_part(const Graph& graph, const ImageHash& stamped) {
    const ResourceAccess part = part_access(stamped.part);
    const ImageDesc& desc = graph.images()[part.id];
    if (part.layer_count == 0 || part.end_layer() > desc.layers || part.mip_count == 0 ||
        part.end_mip() > desc.mips)
        fail(kInvalidGraph, describe_access(graph, part),
             " has a content hash, but the image has layers [0,", desc.layers, ") and ", desc.mips,
             " mip(s)");
}

/// Checks that passes write exactly those parts of persistent images for which a content hash is
/// set.
void check_content_hashes(const Graph& graph, const GraphAccesses& all) {
    SubresourceValues<char> stamped(graph, false), written(graph, false);
    for (const ImageHash& s : graph.content_hashes()) {
        check_hash_part(graph, s);
        stamped.set(part_access(s.part), true);
    }
    for (std::size_t p = 0; p < graph.passes().size(); ++p)
        for (const ResourceAccess& a : all.of_pass(p)) {
            if (!a.write || a.is_buffer || graph.image_lifetime(a.id) != Lifetime::persistent)
                continue;
            if (stamped.has_any(a, false))
                fail(kInvalidGraph, "pass '", graph.passes()[p].name, "' writes ",
                     describe_access(graph, a),
                     ", which is persistent, but no content hash is set for ",
                     missing_layers(graph, stamped, a));
            written.set(a, true);
        }
    for (const ImageHash& s : graph.content_hashes())
        if (const ResourceAccess a = part_access(s.part); written.has_any(a, false))
            fail(kInvalidGraph, describe_access(graph, a),
                 " has a content hash, but no pass writes ", missing_layers(graph, written, a));
}

[[noreturn]] void fail_previous_read(const Graph& graph, const Pass& pass, const ResourceAccess& a,
                                     const SubresourceValues<char>& written) {
    const std::string name = quoted_name(graph, a);
    check(written.has_any(whole_resource(graph, a), true), kInvalidGraph, "pass '", pass.name,
          "' reads previous(", name, ") as ", use_name(a.use), " but no pass writes ", name);
    fail(kInvalidGraph, "pass '", pass.name, "' reads ", describe_access(graph, a), " as ",
         use_name(a.use), " but no pass writes ", missing_layers(graph, written, a), " of ", name);
}

void check_previous_reads(const Graph& graph, const GraphAccesses& all,
                          const SubresourceValues<char>& written) {
    for (std::size_t p = 0; p < graph.passes().size(); ++p)
        for (const ResourceAccess& a : all.of_pass(p))
            if (a.previous && written.has_any(a, false))
                fail_previous_read(graph, graph.passes()[p], a, written);
}

void check_outputs(const Graph& graph, const SubresourceValues<char>& written) {
    for (const ImageHandle& image : graph.output_images()) {
        check(image.id < graph.images().size(), kInvalidGraph, "image number ", image.id,
              " is an output, but the graph has ", graph.images().size());
        const ResourceAccess a = part_access(image);
        const std::string what = describe_access(graph, a);
        check(!image.previous, kInvalidGraph, what,
              " is an output: only this frame's contents can be");
        const ImageDesc& desc = graph.images()[image.id];
        check(a.layer_count > 0 && a.end_layer() <= desc.layers, kInvalidGraph, what,
              " is an output, but the image has layers [0,", desc.layers, ")");
        check(a.mip_count > 0 && a.end_mip() <= desc.mips, kInvalidGraph, what,
              " is an output, but the image has mips [0,", desc.mips, ")");
        check(graph.image_lifetime(a.id) != Lifetime::imported, kInvalidGraph, what,
              " is an output, but imported: read it where it comes from");
        const std::string missing = missing_layers(graph, written, a);
        check(missing.empty(), kInvalidGraph, what, " is an output, but no pass writes ", missing);
    }
    for (const BufferHandle& buffer : graph.output_buffers()) {
        check(buffer.id < graph.buffers().size(), kInvalidGraph, "buffer number ", buffer.id,
              " is an output, but the graph has ", graph.buffers().size());
        const ResourceAccess a{.is_buffer = true, .id = buffer.id, .previous = buffer.previous};
        check(!buffer.previous, kInvalidGraph, describe_access(graph, a),
              " is an output: only this frame's contents can be");
        check(!graph.is_imported(buffer), kInvalidGraph, describe_access(graph, a),
              " is an output, but imported: read it where it comes from");
        check(written.has_any(a, true), kInvalidGraph, describe_access(graph, a),
              " is an output, but no pass writes it");
    }
}

} // namespace

void validate_graph(const Graph& graph, const GraphAccesses& all, const GraphLimits& limits) {
    check_resource_names(graph);
    for (const ImageDesc& desc : graph.images()) check_image_limits(desc, limits);
    for (const BufferDesc& desc : graph.buffers())
        check(desc.bytes > 0, kInvalidGraph, "buffer '", desc.name, "' is empty: 0 bytes");
    for (std::size_t p = 0; p < graph.passes().size(); ++p)
        validate_pass(graph, graph.passes()[p], all.of_pass(p), limits);
    const SubresourceValues<char> written = check_writes_before_reads(graph, all);
    check_previous_reads(graph, all, written);
    check_outputs(graph, written);
    for (std::uint32_t i = 0; i < graph.images().size(); ++i)
        if (graph.image_lifetime(i) == Lifetime::persistent)
            return check_content_hashes(graph, all);
}

} // namespace catoptric::graph
