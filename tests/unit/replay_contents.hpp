#pragma once

#include "graph/graph.hpp"
#include "graph/plan.hpp"

#include <map>

// Simulated contents of images and buffers: a number computed from the pass that wrote the contents
// and from everything that this pass read.
namespace catoptric::graph {

enum class GraphSubresourceKind { image, previous, buffer };

/// A unit of contents: one layer of an image, one layer of the image's contents in the last frame,
/// or a whole buffer.
struct GraphSubresource {
    GraphSubresourceKind kind = GraphSubresourceKind::image;
    std::uint32_t id = 0;
    std::uint32_t layer = 0;
    friend auto operator<=>(const GraphSubresource&, const GraphSubresource&) = default;
};

struct GraphSubresourceUse {
    GraphSubresource subresource;
    ResourceUse use = ResourceUse::sampled;
    bool write = false;
    bool needs = false;
};

using Value = std::uint64_t; // stands for the contents of a subresource
constexpr Value kGarbageContent = 0xdead;

inline Value mix_content_values(Value a, Value b) {
    return (a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2))) * 31;
}

inline std::vector<GraphSubresourceUse> list_subresource_uses_of_pass(const Pass& pass) {
    std::vector<GraphSubresourceUse> uses;
    for (const ImageUse& u : pass.images) {
        const bool attached = u.use == ResourceUse::colour || u.use == ResourceUse::depth;
        const bool needs = !u.write || u.use == ResourceUse::storage || (attached && !u.clear);
        for (std::uint32_t l = 0; l < u.image.layer_count; ++l)
            uses.push_back(
                {{u.image.previous ? GraphSubresourceKind::previous : GraphSubresourceKind::image,
                  u.image.id, u.image.first_layer + l},
                 u.use,
                 u.write,
                 needs});
    }
    for (const BufferUse& u : pass.buffers)
        uses.push_back({{GraphSubresourceKind::buffer, u.buffer.id, 0},
                        u.use,
                        u.write,
                        !u.write || u.use == ResourceUse::storage});
    return uses;
}

class SimulatedGraphContents {
public:
    Value content_of_subresource(const GraphSubresource& subresource) const {
        if (subresource.kind == GraphSubresourceKind::previous)
            return mix_content_values(mix_content_values(7, subresource.id), subresource.layer);
        const auto found = values_.find(subresource);
        return found == values_.end() ? kGarbageContent : found->second;
    }
    void set_content_of_subresource(const GraphSubresource& subresource, Value value) {
        values_[subresource] = value;
    }
    void set_contents_to_garbage(GraphSubresourceKind kind, std::uint32_t id) {
        for (auto& [subresource, value] : values_)
            if (subresource.kind == kind && subresource.id == id) value = kGarbageContent;
    }
    /// Executes a pass. The value of each written subresource is a hash of the pass's number and of
    /// all values that the pass reads.
    void execute_pass(const Pass& pass, std::uint32_t index) {
        const std::vector<GraphSubresourceUse> uses = list_subresource_uses_of_pass(pass);
        Value inputs = index + 1;
        for (const GraphSubresourceUse& u : uses)
            if (u.needs) inputs = mix_content_values(inputs, content_of_subresource(u.subresource));
        for (std::size_t i = 0; i < uses.size(); ++i)
            if (uses[i].write)
                set_content_of_subresource(uses[i].subresource, mix_content_values(inputs, i));
    }

private:
    std::map<GraphSubresource, Value> values_;
};

/// Returns the subresources (image layers and buffers) whose contents matter after a frame: all
/// outputs, and the images whose contents of the last frame the plan's passes read.
inline std::vector<GraphSubresource> list_outcome_subresources(const Graph& graph,
                                                               const GraphPlan& plan) {
    std::vector<GraphSubresource> subresources;
    for (const ImageHandle& image : graph.output_images())
        for (std::uint32_t l = 0; l < image.layer_count; ++l)
            subresources.push_back({GraphSubresourceKind::image, image.id, image.first_layer + l});
    for (const BufferHandle& buffer : graph.output_buffers())
        subresources.push_back({GraphSubresourceKind::buffer, buffer.id, 0});
    for (const PlannedPass& planned : plan.passes)
        for (const GraphSubresourceUse& u :
             list_subresource_uses_of_pass(graph.passes()[planned.pass]))
            if (u.subresource.kind == GraphSubresourceKind::previous)
                subresources.push_back(
                    {GraphSubresourceKind::image, u.subresource.id, u.subresource.layer});
    return subresources;
}

/// Returns the values of `subresources` after the passes have run, if each resource has its own
/// memory.
inline std::vector<Value>
simulate_with_separate_memory(const Graph& graph, const std::vector<std::uint32_t>& passes,
                              const std::vector<GraphSubresource>& subresources) {
    SimulatedGraphContents contents;
    for (const std::uint32_t p : passes) contents.execute_pass(graph.passes()[p], p);
    std::vector<Value> values;
    for (const GraphSubresource& subresource : subresources)
        values.push_back(contents.content_of_subresource(subresource));
    return values;
}

} // namespace catoptric::graph
