#include "graph/validate.hpp"

#include "core/error.hpp"

#include <optional>
#include <string_view>
#include <unordered_set>

namespace catoptric::graph {

namespace {

constexpr auto kWrong = Failure::internal;

/// The first layers of `access` that are not written; empty when all are.
std::string missing_layers(const Ledger<char>& written, const Access& access) {
    if (!written.any(access, false)) return "";
    std::optional<std::pair<std::uint32_t, std::uint32_t>> missing;
    written.each(access, [&](std::uint32_t first, std::uint32_t end, bool is_written) {
        if (!is_written && !missing) missing = {first, end};
    });
    return layers_text(missing->first, missing->second);
}

Access access_to(const Image& image) {
    return {.is_buffer = false,
            .id = image.id,
            .previous = image.previous,
            .first_layer = image.first_layer,
            .layer_count = image.layer_count};
}

void check_names(const Graph& graph) {
    std::unordered_set<std::string_view> seen;
    seen.reserve(graph.images().size() + graph.buffers().size());
    const auto resource = [&](const std::string& name, std::string_view kind) {
        check(!name.empty(), kWrong, kind, " number ", seen.size(), " has no name");
        check(seen.insert(name).second, kWrong, kind, " '", name,
              "': another image or buffer has the same name");
    };
    for (const ImageDesc& desc : graph.images()) resource(desc.name, "image");
    for (const BufferDesc& desc : graph.buffers()) resource(desc.name, "buffer");
    seen.clear();
    seen.reserve(graph.passes().size());
    for (const Pass& pass : graph.passes()) {
        check(!pass.name.empty(), kWrong, "pass number ", seen.size(), " has no name");
        check(seen.insert(pass.name).second, kWrong, "pass '", pass.name,
              "' is declared twice: names are unique");
    }
}

void check_image(const ImageDesc& desc, const Limits& limits) {
    check(desc.width > 0 && desc.height > 0 && desc.layers > 0, kWrong, "image '", desc.name,
          "' is empty: ", desc.width, "x", desc.height, ", ", desc.layers, " layers");
    check(!desc.cube || desc.layers % 6 == 0, kWrong, "image '", desc.name, "' is a cube, but its ",
          desc.layers, " layers are not a multiple of 6");
    check(!desc.cube || desc.width == desc.height, kWrong, "image '", desc.name,
          "' is a cube, but not square: ", desc.width, "x", desc.height);
    const std::uint32_t size = std::max(desc.width, desc.height);
    const std::uint32_t allowed = desc.cube ? limits.max_size_cube : limits.max_size_2d;
    check(size <= allowed, Failure::exhausted, "image '", desc.name, "' wants ", size,
          " texels a side, device allows ", desc.cube ? "max_size_cube" : "max_size_2d", " = ",
          allowed);
    check(desc.layers <= limits.max_layers, Failure::exhausted, "image '", desc.name, "' wants ",
          desc.layers, " layers, device allows max_layers = ", limits.max_layers);
}

[[noreturn]] void refuse_read(const Graph& graph, const Pass& pass, const Access& a,
                              const std::string& missing) {
    const char* verb = !a.write                ? "reads "
                       : a.use == Use::storage ? "reads and writes "
                                               : "loads (has no clear for) ";
    fail(kWrong, "pass '", pass.name, "' ", verb, describe(graph, a), " as ", name_of(a.use),
         " before any pass writes ", a.is_buffer ? "it" : missing);
}

/// Every read finds its layers written, by an earlier pass of this frame. Returns what is written
/// by anyone.
Ledger<char> check_order(const Graph& graph, const Accesses& all) {
    Ledger<char> written(graph, false);
    for (std::size_t p = 0; p < graph.passes().size(); ++p) {
        for (const Access& a : all.of(p))
            if (a.needs && !a.previous && written.any(a, false))
                refuse_read(graph, graph.passes()[p], a, missing_layers(written, a));
        for (const Access& a : all.of(p))
            if (a.write) written.set(a, true);
    }
    return written;
}

[[noreturn]] void refuse_previous(const Graph& graph, const Pass& pass, const Access& a,
                                  const Ledger<char>& written) {
    const std::string name = quoted_name(graph, a);
    check(written.any({.id = a.id, .layer_count = graph.images()[a.id].layers}, true), kWrong,
          "pass '", pass.name, "' reads previous(", name, ") as ", name_of(a.use),
          " but no pass writes ", name);
    fail(kWrong, "pass '", pass.name, "' reads ", describe(graph, a), " as ", name_of(a.use),
         " but no pass writes ", missing_layers(written, a), " of ", name);
}

void check_previous(const Graph& graph, const Accesses& all, const Ledger<char>& written) {
    for (std::size_t p = 0; p < graph.passes().size(); ++p)
        for (const Access& a : all.of(p))
            if (a.previous && written.any(a, false))
                refuse_previous(graph, graph.passes()[p], a, written);
}

void check_wanted(const Graph& graph, const Ledger<char>& written) {
    for (const Image& image : graph.wanted_images()) {
        check(image.id < graph.images().size(), kWrong, "image number ", image.id,
              " is wanted, but the graph has ", graph.images().size());
        const Access a = access_to(image);
        const std::string what = describe(graph, a);
        check(!image.previous, kWrong, what, " is wanted: only this frame's contents can be");
        check(a.layer_count > 0 && a.end_layer() <= graph.images()[image.id].layers, kWrong, what,
              " is wanted, but the image has layers [0,", graph.images()[image.id].layers, ")");
        const std::string missing = missing_layers(written, a);
        check(missing.empty(), kWrong, what, " is wanted, but no pass writes ", missing);
    }
    for (const Buffer& buffer : graph.wanted_buffers()) {
        check(buffer.id < graph.buffers().size(), kWrong, "buffer number ", buffer.id,
              " is wanted, but the graph has ", graph.buffers().size());
        const Access a{.is_buffer = true, .id = buffer.id};
        check(written.any(a, true), kWrong, describe(graph, a),
              " is wanted, but no pass writes it");
    }
}

} // namespace

void validate(const Graph& graph, const Accesses& all, const Limits& limits) {
    check_names(graph);
    for (const ImageDesc& desc : graph.images()) check_image(desc, limits);
    for (const BufferDesc& desc : graph.buffers())
        check(desc.bytes > 0, kWrong, "buffer '", desc.name, "' is empty: 0 bytes");
    for (std::size_t p = 0; p < graph.passes().size(); ++p)
        validate_pass(graph, graph.passes()[p], all.of(p), limits);
    const Ledger<char> written = check_order(graph, all);
    check_previous(graph, all, written);
    check_wanted(graph, written);
}

} // namespace catoptric::graph
