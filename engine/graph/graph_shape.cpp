#include "graph/graph_shape.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// A hash of the added values and their order.
class OrderedHash {
public:
    void add(std::uint64_t value) {
        constexpr std::uint64_t kHashMultiplier = 0x9e3779b97f4a7c15u;
        value_ = (value_ ^ value) * kHashMultiplier;
        value_ ^= value_ >> 29;
    }
    void add(std::uint32_t high, std::uint32_t low) { add(std::uint64_t{high} << 32 | low); }
    void add(std::string_view text) { add(std::hash<std::string_view>()(text)); }
    std::uint64_t hash_value() const { return value_; }

private:
    std::uint64_t value_ = 0;
};

template <typename E>
std::uint32_t to_number(E value) {
    return static_cast<std::uint32_t>(value);
}

void add(OrderedHash& hash, const ImageDesc& desc) {
    hash.add(desc.name);
    hash.add(desc.width, desc.height);
    hash.add(desc.layers, to_number(desc.format) << 1 | desc.cube);
    hash.add(desc.mips);
}

void add(OrderedHash& hash, const ImageHandle& image) {
    hash.add(image.id << 1 | image.previous, image.first_layer);
    hash.add(image.layer_count);
    hash.add(image.first_mip, image.mip_count);
}

void add(OrderedHash& hash, const Pass& pass) {
    hash.add(pass.name);
    hash.add(to_number(pass.tag) << 1 | static_cast<bool>(pass.body), pass.layer_count);
    hash.add(static_cast<std::uint32_t>(pass.images.size()),
             static_cast<std::uint32_t>(pass.buffers.size()));
    for (const ImageUse& use : pass.images) {
        add(hash, use.image);
        hash.add(to_number(use.use), std::uint32_t{use.stays} << 2 | std::uint32_t{use.write} << 1 |
                                         use.clear.has_value());
    }
    for (const BufferUse& use : pass.buffers)
        hash.add(use.buffer.id << 1 | use.buffer.previous, to_number(use.use) << 1 | use.write);
}

/// Returns the ranges of a persistent image that have contents.
std::vector<std::uint32_t> written_ranges(const Graph& graph, std::uint32_t image) {
    std::vector<std::uint32_t> ranges;
    graph.hashes_at_start(image).for_each_run(
        [&](std::uint32_t first, std::uint32_t end, const auto& content_hash) {
            if (!content_hash) return;
            const bool continues = !ranges.empty() && ranges.back() == first;
            if (continues) ranges.pop_back();
            if (!continues) ranges.push_back(first);
            ranges.push_back(end);
        });
    return ranges;
}

void add_lifetime(OrderedHash& hash, const Graph& graph, std::uint32_t image) {
    hash.add(to_number(graph.image_lifetime(image)));
    if (graph.image_lifetime(image) == Lifetime::imported) {
        const std::optional<ResourceUse> arrives = graph.use_on_import(image);
        hash.add(arrives ? 1 + to_number(*arrives) : 0, to_number(graph.use_on_release(image)));
    }
    if (graph.image_lifetime(image) == Lifetime::persistent)
        for (const std::uint32_t end : written_ranges(graph, image)) hash.add(end);
}

bool same_lifetime(const Graph& a, const Graph& b, std::uint32_t image) {
    const Lifetime lifetime = a.image_lifetime(image);
    if (lifetime != b.image_lifetime(image)) return false;
    if (lifetime == Lifetime::imported)
        return a.use_on_import(image) == b.use_on_import(image) &&
               a.use_on_release(image) == b.use_on_release(image);
    return lifetime != Lifetime::persistent || written_ranges(a, image) == written_ranges(b, image);
}

bool same_declaration(const ImageUse& a, const ImageUse& b) {
    return a.image == b.image && a.use == b.use && a.write == b.write &&
           a.clear.has_value() == b.clear.has_value() && a.stays == b.stays;
}

bool same_declaration(const Pass& a, const Pass& b) {
    return a.name == b.name && a.tag == b.tag && a.layer_count == b.layer_count &&
           a.buffers == b.buffers &&
           std::ranges::equal(a.images, b.images, [](const ImageUse& x, const ImageUse& y) {
               return same_declaration(x, y);
           });
}

} // namespace

std::uint64_t hash_shape(const Graph& graph) {
    OrderedHash hash;
    hash.add(graph.images().size());
    for (std::uint32_t i = 0; i < graph.images().size(); ++i) {
        add(hash, graph.images()[i]);
        add_lifetime(hash, graph, i);
    }
    for (std::uint32_t b = 0; b < graph.buffers().size(); ++b) {
        hash.add(graph.buffers()[b].name);
        hash.add(graph.buffers()[b].bytes);
        hash.add(to_number(graph.buffer_lifetime(b)));
    }
    for (const ImageHash& stamped : graph.content_hashes()) add(hash, stamped.part);
    for (const Pass& pass : graph.passes()) add(hash, pass);
    for (const ImageHandle& image : graph.output_images()) add(hash, image);
    for (const BufferHandle& buffer : graph.output_buffers()) hash.add(buffer.id);
    return hash.hash_value();
}

bool same_declarations(const Graph& graph, const Graph& known) {
    if (graph.images() != known.images() || graph.buffers() != known.buffers() ||
        graph.output_images() != known.output_images() ||
        graph.output_buffers() != known.output_buffers())
        return false;
    for (std::uint32_t i = 0; i < graph.images().size(); ++i)
        if (!same_lifetime(graph, known, i)) return false;
    for (std::uint32_t b = 0; b < graph.buffers().size(); ++b)
        if (graph.buffer_lifetime(b) != known.buffer_lifetime(b)) return false;
    if (!std::ranges::equal(graph.content_hashes(), known.content_hashes(), {}, &ImageHash::part,
                            &ImageHash::part))
        return false;
    return std::ranges::equal(graph.passes(), known.passes(),
                              [](const Pass& a, const Pass& b) { return same_declaration(a, b); });
}

} // namespace catoptric::graph
