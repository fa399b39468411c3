#include "graph/graph_shape.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// A hash of the added values and their order.
class OrderDependentHash {
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
std::uint32_t enum_to_hash_number(E value) {
    return static_cast<std::uint32_t>(value);
}

void add(OrderDependentHash& hash, const ImageDesc& desc) {
    hash.add(desc.name);
    hash.add(desc.width, desc.height);
    hash.add(desc.layers, enum_to_hash_number(desc.format) << 1 | desc.cube);
    hash.add(desc.mips);
}

void add(OrderDependentHash& hash, const ImageHandle& image) {
    hash.add(image.id << 1 | image.previous, image.first_layer);
    hash.add(image.layer_count);
    hash.add(image.first_mip, image.mip_count);
}

void add(OrderDependentHash& hash, const Pass& pass) {
    hash.add(pass.name);
    hash.add(enum_to_hash_number(pass.tag) << 1 | static_cast<bool>(pass.body), pass.layer_count);
    hash.add(static_cast<std::uint32_t>(pass.images.size()),
             static_cast<std::uint32_t>(pass.buffers.size()));
    for (const ImageUse& use : pass.images) {
        add(hash, use.image);
        hash.add(enum_to_hash_number(use.use), std::uint32_t{use.stays} << 2 |
                                                   std::uint32_t{use.write} << 1 |
                                                   use.clear.has_value());
    }
    for (const BufferUse& use : pass.buffers)
        hash.add(use.buffer.id << 1 | use.buffer.previous,
                 enum_to_hash_number(use.use) << 1 | use.write);
}

/// Returns the ranges of a persistent image that have contents.
std::vector<std::uint32_t> list_ranges_with_contents(const Graph& graph, std::uint32_t image) {
    std::vector<std::uint32_t> ranges;
    graph.list_content_hashes_at_start(image).for_each_run(
        [&](std::uint32_t first, std::uint32_t end, const auto& content_hash) {
            if (!content_hash) return;
            const bool continues = !ranges.empty() && ranges.back() == first;
            if (continues) ranges.pop_back();
            if (!continues) ranges.push_back(first);
            ranges.push_back(end);
        });
    return ranges;
}

void add_image_lifetime_to_shape_hash(OrderDependentHash& hash, const Graph& graph,
                                      std::uint32_t image) {
    hash.add(enum_to_hash_number(graph.image_lifetime(image)));
    if (graph.image_lifetime(image) == Lifetime::imported) {
        const std::optional<ResourceUse> arrives = graph.resource_use_on_import(image);
        hash.add(arrives ? 1 + enum_to_hash_number(*arrives) : 0,
                 enum_to_hash_number(graph.resource_use_on_release(image)));
    }
    if (graph.image_lifetime(image) == Lifetime::persistent)
        for (const std::uint32_t end : list_ranges_with_contents(graph, image)) hash.add(end);
}

bool have_equal_lifetimes(const Graph& a, const Graph& b, std::uint32_t image) {
    const Lifetime lifetime = a.image_lifetime(image);
    if (lifetime != b.image_lifetime(image)) return false;
    if (lifetime == Lifetime::imported)
        return a.resource_use_on_import(image) == b.resource_use_on_import(image) &&
               a.resource_use_on_release(image) == b.resource_use_on_release(image);
    return lifetime != Lifetime::persistent ||
           list_ranges_with_contents(a, image) == list_ranges_with_contents(b, image);
}

bool are_equal_declarations(const ImageUse& a, const ImageUse& b) {
    return a.image == b.image && a.use == b.use && a.write == b.write &&
           a.clear.has_value() == b.clear.has_value() && a.stays == b.stays;
}

bool are_equal_declarations(const Pass& a, const Pass& b) {
    return a.name == b.name && a.tag == b.tag && a.layer_count == b.layer_count &&
           a.buffers == b.buffers &&
           std::ranges::equal(a.images, b.images, [](const ImageUse& x, const ImageUse& y) {
               return are_equal_declarations(x, y);
           });
}

} // namespace

std::uint64_t hash_graph_shape(const Graph& graph) {
    OrderDependentHash hash;
    hash.add(graph.list_images().size());
    for (std::uint32_t i = 0; i < graph.list_images().size(); ++i) {
        add(hash, graph.list_images()[i]);
        add_image_lifetime_to_shape_hash(hash, graph, i);
    }
    for (std::uint32_t b = 0; b < graph.list_buffers().size(); ++b) {
        hash.add(graph.list_buffers()[b].name);
        hash.add(graph.list_buffers()[b].bytes);
        hash.add(enum_to_hash_number(graph.buffer_lifetime(b)));
    }
    for (const ImageContentHashRecord& stamped : graph.list_image_content_hashes())
        add(hash, stamped.part);
    for (const Pass& pass : graph.list_passes()) add(hash, pass);
    for (const ImageHandle& image : graph.list_output_images()) add(hash, image);
    for (const BufferHandle& buffer : graph.list_output_buffers()) hash.add(buffer.id);
    return hash.hash_value();
}

bool have_equal_graph_declarations(const Graph& graph, const Graph& known) {
    if (graph.list_images() != known.list_images() ||
        graph.list_buffers() != known.list_buffers() ||
        graph.list_output_images() != known.list_output_images() ||
        graph.list_output_buffers() != known.list_output_buffers())
        return false;
    for (std::uint32_t i = 0; i < graph.list_images().size(); ++i)
        if (!have_equal_lifetimes(graph, known, i)) return false;
    for (std::uint32_t b = 0; b < graph.list_buffers().size(); ++b)
        if (graph.buffer_lifetime(b) != known.buffer_lifetime(b)) return false;
    if (!std::ranges::equal(graph.list_image_content_hashes(), known.list_image_content_hashes(),
                            {}, &ImageContentHashRecord::part, &ImageContentHashRecord::part))
        return false;
    return std::ranges::equal(
        graph.list_passes(), known.list_passes(),
        [](const Pass& a, const Pass& b) { return are_equal_declarations(a, b); });
}

} // namespace catoptric::graph
