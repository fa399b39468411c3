#pragma once

#include "graph/plan.hpp"
#include "graph/run_length_array.hpp"

#include <span>
#include <string>
#include <vector>

namespace catoptric::graph {

/// How one pass uses one image or buffer. A buffer counts as a resource with one layer and one mip.
struct ResourceAccess {
    bool is_buffer = false;
    std::uint32_t id = 0;
    bool previous = false;
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 1;
    std::uint32_t first_mip = 0;
    std::uint32_t mip_count = 1;
    ResourceUse use = ResourceUse::sampled;
    bool write = false;
    bool needs = false; ///< needs earlier contents: a read, an attachment without clear, `storage`
    bool clears = false;

    /// Returns the layer after the last, in 64 bits: the sum can exceed 32 bits for an invalid
    /// access.
    std::uint64_t end_layer() const { return std::uint64_t{first_layer} + layer_count; }
    std::uint64_t end_mip() const { return std::uint64_t{first_mip} + mip_count; }
};

/// Returns the accesses of the pass: images in order of declaration, then buffers.
std::vector<ResourceAccess> pass_accesses(const Pass& pass);

/// The accesses of every pass of a graph, gathered once.
class GraphAccesses {
public:
    explicit GraphAccesses(const Graph& graph);
    std::span<const ResourceAccess> of_pass(std::size_t pass) const {
        return {all_.data() + first_[pass], all_.data() + first_[pass + 1]};
    }

private:
    std::vector<ResourceAccess> all_;
    std::vector<std::size_t> first_; // index of each pass's first access in `all_`, then the total
};

/// Returns the access state that an access of this pass leaves on its image or buffer.
AccessState access_state(const ResourceAccess& access, const Pass& pass);

constexpr bool is_attachment(ResourceUse use) {
    return use == ResourceUse::colour || use == ResourceUse::depth;
}

/// Returns "'cubes' [0,6)", "previous('cubes') [0,6)" or "buffer 'args'", for messages.
std::string describe_access(const Graph& graph, const ResourceAccess& access);
/// Returns a range of an image's layers as text: "layers [6,12)", with the mip if the image has
/// several. `first` and `end` are numbers as in `for_each_range`. The range is cut
/// at the end of its first mip.
std::string format_layers(const ImageDesc& desc, std::uint32_t first, std::uint32_t end);
std::string quoted_name(const Graph& graph, const ResourceAccess& access);

/// Calls visit(first, end) for the layers of each mip of `part`, a part of an image with `layers`
/// layers. Layer l of mip m has the number m * layers + l. A part with all layers is visited as one
/// range.
template <typename Part, typename Visit>
void for_each_range(const Part& part, std::uint32_t layers, const Visit& visit) {
    if (part.layer_count == layers)
        return visit(part.first_mip * layers, (part.first_mip + part.mip_count) * layers);
    for (std::uint32_t m = part.first_mip; m < part.first_mip + part.mip_count; ++m)
        visit(m * layers + part.first_layer, m * layers + part.first_layer + part.layer_count);
}

/// A value for each layer of each mip of every image of a graph, and for every buffer.
template <typename T>
class SubresourceValues {
public:
    explicit SubresourceValues(const Graph& graph, const T& value = {})
        : image_count_(graph.images().size()) {
        entries_.reserve(image_count_ + graph.buffers().size());
        for (const ImageDesc& desc : graph.images())
            entries_.push_back({RunLengthArray<T>(desc.layers * desc.mips, value), desc.layers});
        entries_.resize(image_count_ + graph.buffers().size(), {RunLengthArray<T>(1, value), 1});
    }
    RunLengthArray<T>& runs(const ResourceAccess& a) { return entry(a).runs; }
    const RunLengthArray<T>& runs(const ResourceAccess& a) const { return entry(a).runs; }
    std::uint32_t layer_count(const ResourceAccess& a) const { return entry(a).layers; }

    /// Calls visit(first, end, value) for each run of layers with equal values among the layers of
    /// the access.
    template <typename Visit>
    void for_each(const ResourceAccess& a, const Visit& visit) const {
        const LayerRuns& e = entry(a);
        for_each_range(a, e.layers, [&](std::uint32_t first, std::uint32_t end) {
            e.runs.for_each_run(first, end, visit);
        });
    }
    template <typename Visit>
    void modify(const ResourceAccess& a, const Visit& visit) {
        LayerRuns& e = entries_[value_index(a)];
        for_each_range(a, e.layers, [&](std::uint32_t first, std::uint32_t end) {
            e.runs.modify_runs(first, end, visit);
        });
    }
    void set(const ResourceAccess& a, const T& value) {
        modify(a, [&](std::uint32_t, std::uint32_t, T& old) { old = value; });
    }
    bool has_any(const ResourceAccess& a, const T& value) const {
        bool found = false;
        for_each(a, [&](std::uint32_t, std::uint32_t, const T& v) { found |= v == value; });
        return found;
    }

private:
    struct LayerRuns {
        RunLengthArray<T> runs;
        std::uint32_t layers;
    };
    std::size_t value_index(const ResourceAccess& a) const {
        return a.is_buffer ? image_count_ + a.id : a.id;
    }
    LayerRuns& entry(const ResourceAccess& a) { return entries_[value_index(a)]; }
    const LayerRuns& entry(const ResourceAccess& a) const { return entries_[value_index(a)]; }

    std::size_t image_count_;
    std::vector<LayerRuns> entries_; // images, then buffers
};

/// Returns an access to a part of an image. Its use is left at the default.
ResourceAccess part_access(const ImageHandle& image);
/// Returns an access to all layers and mips of an image. Its use is left at the default.
ResourceAccess whole_image(const Graph& graph, std::uint32_t image);
/// Returns an access to all of the image or buffer of an access, in this frame.
ResourceAccess whole_resource(const Graph& graph, const ResourceAccess& part);
/// Returns a table that is true for each image layer and each buffer that is an output of the
/// graph.
SubresourceValues<char> output_parts(const Graph& graph);

} // namespace catoptric::graph
