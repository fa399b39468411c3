#include "graph/validate.hpp"

#include "core/error.hpp"

namespace catoptric::graph {

namespace {

constexpr auto kWrong = Failure::internal;

bool may_read(Use use, bool is_buffer) {
    switch (use) {
    case Use::sampled:
    case Use::storage_read:
    case Use::copy_from: return true;
    case Use::depth: return !is_buffer;
    case Use::indirect: return is_buffer;
    default: return false;
    }
}

bool may_write(Use use, bool is_buffer) {
    switch (use) {
    case Use::storage_write:
    case Use::storage:
    case Use::copy_to: return true;
    case Use::colour:
    case Use::depth: return !is_buffer;
    default: return false;
    }
}

void check_handle(const Graph& graph, const Pass& pass, const Access& a) {
    const std::size_t count = a.is_buffer ? graph.buffers().size() : graph.images().size();
    check(a.id < count, kWrong, "pass '", pass.name, "' names ", a.is_buffer ? "buffer" : "image",
          " number ", a.id, ", but the graph has ", count);
    if (a.is_buffer) return;
    const std::uint32_t layers = graph.images()[a.id].layers;
    check(a.layer_count > 0, kWrong, "pass '", pass.name, "' names no layer of ",
          quoted_name(graph, a), " as ", name_of(a.use));
    check(a.end_layer() <= layers, kWrong, "pass '", pass.name, "' uses ", describe(graph, a),
          " as ", name_of(a.use), ", but the image has layers [0,", layers, ")");
}

void check_use(const Graph& graph, const Pass& pass, const Access& a) {
    const std::string what = describe(graph, a);
    check(!(a.write && a.previous), kWrong, "pass '", pass.name, "' writes ", what, " as ",
          name_of(a.use), ": last frame's contents are only read");
    check(a.write ? may_write(a.use, a.is_buffer) : may_read(a.use, a.is_buffer), kWrong, "pass '",
          pass.name, "' ", a.write ? "writes " : "reads ", what, " as ", name_of(a.use),
          ", which is not a way to ", a.write ? "write " : "read ",
          a.is_buffer ? "a buffer" : "an image");
    check(!a.clears || is_attachment(a.use), kWrong, "pass '", pass.name, "' clears ", what, " as ",
          name_of(a.use), ", but only attachments are cleared");
    check(!pass.is_raster() || (a.use != Use::copy_from && a.use != Use::copy_to), kWrong, "pass '",
          pass.name, "' has attachments and uses ", what, " as ", name_of(a.use),
          ": copies need a pass of their own");
    if (a.is_buffer || !is_attachment(a.use)) return;
    const Format format = graph.images()[a.id].format;
    check(is_depth(format) == (a.use == Use::depth), kWrong, "pass '", pass.name, "' uses ", what,
          " as ", name_of(a.use), ", but its format ", name_of(format), " is a ",
          is_depth(format) ? "depth" : "colour", " format");
}

void check_attachments(const Graph& graph, const Pass& pass, const std::vector<Access>& all) {
    const Access* first = nullptr;
    const Access* depth = nullptr;
    for (const Access& a : all) {
        if (a.is_buffer || !is_attachment(a.use)) continue;
        check(a.layer_count == pass.layer_count, kWrong, "pass '", pass.name, "' renders ",
              pass.layer_count, " layer(s), but attaches ", describe(graph, a), " as ",
              name_of(a.use), ", which are ", a.layer_count);
        check(a.use != Use::depth || !depth, kWrong, "pass '", pass.name, "' attaches both ",
              depth ? describe(graph, *depth) : "", " and ", describe(graph, a), " as depth");
        if (a.use == Use::depth) depth = &a;
        if (!first) first = &a;
        const ImageDesc& x = graph.images()[first->id];
        const ImageDesc& y = graph.images()[a.id];
        check(x.width == y.width && x.height == y.height, kWrong, "pass '", pass.name,
              "' attaches ", describe(graph, *first), " as ", name_of(first->use), " (", x.width,
              "x", x.height, ") and ", describe(graph, a), " as ", name_of(a.use), " (", y.width,
              "x", y.height, "): attachments have one size");
    }
}

/// Two uses of the same contents in one pass: harmless, or why not.
void check_pair(const Graph& graph, const Pass& pass, const Access& a, const Access& b) {
    const std::uint64_t first = std::max(a.first_layer, b.first_layer);
    const std::uint64_t end = std::min(a.end_layer(), b.end_layer());
    const bool same = a.is_buffer == b.is_buffer && a.id == b.id && a.previous == b.previous;
    if (!same || first >= end) return;
    const std::string where = a.is_buffer ? "" : ", in " + layers_text(first, end);
    check(!(a.write && b.write), kWrong, "pass '", pass.name, "' writes ", describe(graph, a),
          " as ", name_of(a.use), " and ", describe(graph, b), " as ", name_of(b.use),
          ": written twice", where);
    const Access& read = a.write ? b : a;
    const Access& other = a.write ? a : b;
    check(!other.write, kWrong, "pass '", pass.name, "' reads ", describe(graph, read), " as ",
          name_of(read.use), " while it writes ", describe(graph, other), " as ",
          name_of(other.use), where);
    check(a.is_buffer || a.use == b.use, kWrong, "pass '", pass.name, "' reads ",
          describe(graph, a), " as ", name_of(a.use), " and ", describe(graph, b), " as ",
          name_of(b.use), ": one image cannot be in two layouts at once", where);
}

} // namespace

void validate_pass(const Graph& graph, const Pass& pass, const Limits& limits) {
    check(static_cast<bool>(pass.body), kWrong, "pass '", pass.name, "' has no body");
    check(pass.layer_count > 0, kWrong, "pass '", pass.name, "' renders 0 layers");
    const std::vector<Access> all = accesses(pass);
    for (const Access& a : all) {
        check_handle(graph, pass, a);
        check_use(graph, pass, a);
    }
    check(std::ranges::any_of(all, &Access::write), kWrong, "pass '", pass.name,
          "' writes nothing");
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size(); ++j) check_pair(graph, pass, all[i], all[j]);
    check_attachments(graph, pass, all);
    check(pass.layer_count <= limits.max_framebuffer_layers, Failure::exhausted, "pass '",
          pass.name, "' wants ", pass.layer_count, " framebuffer layers for ",
          quoted_name(graph, *std::ranges::find_if(all, &Access::write)),
          ", device allows max_framebuffer_layers = ", limits.max_framebuffer_layers);
}

} // namespace catoptric::graph
