#include "graph/validate.hpp"

#include "core/error.hpp"

#include <bit>
#include <optional>
#include <string_view>
#include <unordered_set>

namespace catoptric::graph {

namespace {

/// Returns the first layers of `access` for which `there` is false; empty if it is true for all.
std::string describe_missing_layers(const Graph& graph, const ValuesPerSubresource<char>& there,
                                    const ResourceAccess& access) {
    if (!there.has_any_equal_value(access, false)) return "";
    std::optional<std::pair<std::uint32_t, std::uint32_t>> missing;
    there.for_each_subresource_value(access,
                                     [&](std::uint32_t first, std::uint32_t end, bool is_there) {
                                         if (!is_there && !missing) missing = {first, end};
                                     });
    if (access.is_buffer) return "it";
    return format_layer_range(graph.list_images()[access.id], missing->first, missing->second);
}

void check_resource_names(const Graph& graph) {
    std::unordered_set<std::string_view> seen;
    seen.reserve(graph.list_images().size() + graph.list_buffers().size());
    const auto resource = [&](const std::string& name, std::string_view kind) {
        check(!name.empty(), kInvalidGraphFailure, kind, " number ", seen.size(), " has no name");
        check(seen.insert(name).second, kInvalidGraphFailure, kind, " '", name,
              "': another image or buffer has the same name");
    };
    for (const ImageDesc& desc : graph.list_images()) resource(desc.name, "image");
    for (const BufferDesc& desc : graph.list_buffers()) resource(desc.name, "buffer");
    seen.clear();
    seen.reserve(graph.list_passes().size());
    for (const Pass& pass : graph.list_passes()) {
        check(!pass.name.empty(), kInvalidGraphFailure, "pass number ", seen.size(),
              " has no name");
        check(seen.insert(pass.name).second, kInvalidGraphFailure, "pass '", pass.name,
              "' is declared twice: names are unique");
    }
}

void check_image_limits(const ImageDesc& desc, const GraphLimits& limits) {
    check(desc.width > 0 && desc.height > 0 && desc.layers > 0, kInvalidGraphFailure, "image '",
          desc.name, "' is empty: ", desc.width, "x", desc.height, ", ", desc.layers, " layers");
    check(!desc.cube || desc.layers % 6 == 0, kInvalidGraphFailure, "image '", desc.name,
          "' is a cube, but its ", desc.layers, " layers are not a multiple of 6");
    check(!desc.cube || desc.width == desc.height, kInvalidGraphFailure, "image '", desc.name,
          "' is a cube, but not square: ", desc.width, "x", desc.height);
    const std::uint32_t size = std::max(desc.width, desc.height);
    const std::uint32_t allowed = desc.cube ? limits.max_size_cube : limits.max_size_2d;
    check(size <= allowed, Failure::exhausted, "image '", desc.name, "' wants ", size,
          " texels a side, device allows ", desc.cube ? "max_size_cube" : "max_size_2d", " = ",
          allowed);
    check(desc.layers <= limits.max_layers, Failure::exhausted, "image '", desc.name, "' wants ",
          desc.layers, " layers, device allows max_layers = ", limits.max_layers);
    const auto most_mips = static_cast<std::uint32_t>(std::bit_width(size));
    check(desc.mips > 0 && desc.mips <= most_mips, kInvalidGraphFailure, "image '", desc.name,
          "' wants ", desc.mips, " mips, but of ", desc.width, "x", desc.height, " there are 1 to ",
          most_mips);
}

[[noreturn]] void fail_read_before_write(const Graph& graph, const Pass& pass,
                                         const ResourceAccess& a, const std::string& missing) {
    const char* verb = !a.write                        ? "reads "
                       : a.use == ResourceUse::storage ? "reads and writes "
                       : a.clears                      ? "updates "
                                                       : "loads (has no clear for) ";
    fail(kInvalidGraphFailure, "pass '", pass.name, "' ", verb, describe_access(graph, a), " as ",
         resource_use_name(a.use), " before any pass writes ", missing);
}

/// Returns the image layers and buffers that have contents before the first pass: those of
/// persistent and of imported resources.
ValuesPerSubresource<char> mark_contents_at_frame_start(const Graph& graph) {
    ValuesPerSubresource<char> there(graph, false);
    for (std::uint32_t i = 0; i < graph.list_images().size(); ++i) {
        const ResourceAccess all = make_access_to_whole_image(graph, i);
        if (graph.image_lifetime(i) == Lifetime::imported && graph.resource_use_on_import(i))
            there.set_subresource_values_of_access(all, true);
        if (graph.image_lifetime(i) != Lifetime::persistent) continue;
        graph.list_content_hashes_at_start(i).for_each_run(
            [&](std::uint32_t first, std::uint32_t end, const auto& stamp) {
                if (stamp) there.layer_runs_of_resource(all).fill_cell_range(first, end, true);
            });
    }
    for (std::uint32_t b = 0; b < graph.list_buffers().size(); ++b)
        if (graph.is_imported({b}))
            there.set_subresource_values_of_access({.is_buffer = true, .id = b}, true);
    return there;
}

/// Checks that every layer is written before it is read, by an earlier pass of this frame or before
/// the frame. Returns the contents that exist after the last pass.
ValuesPerSubresource<char> check_writes_before_reads(const Graph& graph, const GraphAccesses& all) {
    ValuesPerSubresource<char> written = mark_contents_at_frame_start(graph);
    for (std::size_t p = 0; p < graph.list_passes().size(); ++p) {
        for (const ResourceAccess& a : all.accesses_of_pass(p))
            if (a.needs && !a.previous && written.has_any_equal_value(a, false))
                fail_read_before_write(graph, graph.list_passes()[p], a,
                                       describe_missing_layers(graph, written, a));
        for (const ResourceAccess& a : all.accesses_of_pass(p))
            if (a.write) written.set_subresource_values_of_access(a, true);
    }
    return written;
}

void check_content_hash_part(const Graph& graph, const ImageContentHashRecord& stamped) {
    const ResourceAccess part = make_access_to_image_part(stamped.part);
    const ImageDesc& desc = graph.list_images()[part.id];
    if (part.layer_count == 0 || part.end_layer_of_access() > desc.layers || part.mip_count == 0 ||
        part.end_mip_of_access() > desc.mips)
        fail(kInvalidGraphFailure, describe_access(graph, part),
             " has a content hash, but the image has layers [0,", desc.layers, ") and ", desc.mips,
             " mip(s)");
}

/// Checks that passes write exactly those parts of persistent images for which a content hash is
/// set.
void check_content_hashes_match_accesses(const Graph& graph, const GraphAccesses& all) {
    ValuesPerSubresource<char> stamped(graph, false), written(graph, false);
    for (const ImageContentHashRecord& s : graph.list_image_content_hashes()) {
        check_content_hash_part(graph, s);
        stamped.set_subresource_values_of_access(make_access_to_image_part(s.part), true);
    }
    for (std::size_t p = 0; p < graph.list_passes().size(); ++p)
        for (const ResourceAccess& a : all.accesses_of_pass(p)) {
            if (!a.write || a.is_buffer || graph.image_lifetime(a.id) != Lifetime::persistent)
                continue;
            if (stamped.has_any_equal_value(a, false))
                fail(kInvalidGraphFailure, "pass '", graph.list_passes()[p].name, "' writes ",
                     describe_access(graph, a),
                     ", which is persistent, but no content hash is set for ",
                     describe_missing_layers(graph, stamped, a));
            written.set_subresource_values_of_access(a, true);
        }
    for (const ImageContentHashRecord& s : graph.list_image_content_hashes())
        if (const ResourceAccess a = make_access_to_image_part(s.part);
            written.has_any_equal_value(a, false))
            fail(kInvalidGraphFailure, describe_access(graph, a),
                 " has a content hash, but no pass writes ",
                 describe_missing_layers(graph, written, a));
}

[[noreturn]] void fail_read_of_previous_contents(const Graph& graph, const Pass& pass,
                                                 const ResourceAccess& a,
                                                 const ValuesPerSubresource<char>& written) {
    const std::string name = quote_resource_name(graph, a);
    check(written.has_any_equal_value(whole_resource(graph, a), true), kInvalidGraphFailure,
          "pass '", pass.name, "' reads previous(", name, ") as ", resource_use_name(a.use),
          " but no pass writes ", name);
    fail(kInvalidGraphFailure, "pass '", pass.name, "' reads ", describe_access(graph, a), " as ",
         resource_use_name(a.use), " but no pass writes ",
         describe_missing_layers(graph, written, a), " of ", name);
}

void check_reads_of_previous_frame(const Graph& graph, const GraphAccesses& all,
                                   const ValuesPerSubresource<char>& written) {
    for (std::size_t p = 0; p < graph.list_passes().size(); ++p)
        for (const ResourceAccess& a : all.accesses_of_pass(p))
            if (a.previous && written.has_any_equal_value(a, false))
                fail_read_of_previous_contents(graph, graph.list_passes()[p], a, written);
}

void check_outputs_are_written(const Graph& graph, const ValuesPerSubresource<char>& written) {
    for (const ImageHandle& image : graph.list_output_images()) {
        check(image.id < graph.list_images().size(), kInvalidGraphFailure, "image number ",
              image.id, " is an output, but the graph has ", graph.list_images().size());
        const ResourceAccess a = make_access_to_image_part(image);
        const std::string what = describe_access(graph, a);
        check(!image.previous, kInvalidGraphFailure, what,
              " is an output: only this frame's contents can be");
        const ImageDesc& desc = graph.list_images()[image.id];
        check(a.layer_count > 0 && a.end_layer_of_access() <= desc.layers, kInvalidGraphFailure,
              what, " is an output, but the image has layers [0,", desc.layers, ")");
        check(a.mip_count > 0 && a.end_mip_of_access() <= desc.mips, kInvalidGraphFailure, what,
              " is an output, but the image has mips [0,", desc.mips, ")");
        check(graph.image_lifetime(a.id) != Lifetime::imported, kInvalidGraphFailure, what,
              " is an output, but imported: read it where it comes from");
        const std::string missing = describe_missing_layers(graph, written, a);
        check(missing.empty(), kInvalidGraphFailure, what, " is an output, but no pass writes ",
              missing);
    }
    for (const BufferHandle& buffer : graph.list_output_buffers()) {
        check(buffer.id < graph.list_buffers().size(), kInvalidGraphFailure, "buffer number ",
              buffer.id, " is an output, but the graph has ", graph.list_buffers().size());
        const ResourceAccess a{.is_buffer = true, .id = buffer.id, .previous = buffer.previous};
        check(!buffer.previous, kInvalidGraphFailure, describe_access(graph, a),
              " is an output: only this frame's contents can be");
        check(!graph.is_imported(buffer), kInvalidGraphFailure, describe_access(graph, a),
              " is an output, but imported: read it where it comes from");
        check(written.has_any_equal_value(a, true), kInvalidGraphFailure, describe_access(graph, a),
              " is an output, but no pass writes it");
    }
}

} // namespace

void validate_graph(const Graph& graph, const GraphAccesses& all, const GraphLimits& limits) {
    check_resource_names(graph);
    for (const ImageDesc& desc : graph.list_images()) check_image_limits(desc, limits);
    for (const BufferDesc& desc : graph.list_buffers())
        check(desc.bytes > 0, kInvalidGraphFailure, "buffer '", desc.name, "' is empty: 0 bytes");
    for (std::size_t p = 0; p < graph.list_passes().size(); ++p)
        validate_pass(graph, graph.list_passes()[p], all.accesses_of_pass(p), limits);
    const ValuesPerSubresource<char> written = check_writes_before_reads(graph, all);
    check_reads_of_previous_frame(graph, all, written);
    check_outputs_are_written(graph, written);
    for (std::uint32_t i = 0; i < graph.list_images().size(); ++i)
        if (graph.image_lifetime(i) == Lifetime::persistent)
            return check_content_hashes_match_accesses(graph, all);
}

} // namespace catoptric::graph
