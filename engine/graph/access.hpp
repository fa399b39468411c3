#pragma once

#include "graph/plan.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace catoptric::graph {

/// One use by one pass; images and buffers alike: a buffer is a resource of one layer.
struct Access {
    bool is_buffer = false;
    std::uint32_t id = 0;
    bool previous = false;
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 1;
    Use use = Use::sampled;
    bool write = false;
    bool needs = false; ///< contents from before: a read, an attachment without clear, `storage`
    bool clears = false;

    std::uint64_t end_layer() const { return std::uint64_t{first_layer} + layer_count; }
};

/// What the pass touches: images in order of declaration, then buffers.
std::vector<Access> accesses(const Pass& pass);

/// The touch that an access leaves behind.
Touch touch_of(const Access& access, const Pass& pass);

constexpr bool is_attachment(Use use) { return use == Use::colour || use == Use::depth; }

/// "'cubes' [0,6)", "previous('cubes') [0,6)" or "buffer 'args'".
std::string describe(const Graph& graph, const Access& access);
/// "layers [6,12)"
std::string layers_text(std::uint64_t first, std::uint64_t end);
/// "'cubes'"; also for buffers.
std::string quoted_name(const Graph& graph, const Access& access);

/// A value for each layer of each image and for each buffer.
template <typename T>
class PerLayer {
public:
    explicit PerLayer(const Graph& graph, const T& value = {}) {
        for (const ImageDesc& desc : graph.images()) images_.emplace_back(desc.layers, value);
        buffers_.assign(graph.buffers().size(), std::vector<T>(1, value));
    }
    /// All layers of the access's resource.
    std::vector<T>& of(const Access& access) { return of(access.is_buffer, access.id); }
    std::vector<T>& of(bool is_buffer, std::uint32_t id) {
        return is_buffer ? buffers_[id] : images_[id];
    }
    /// Of truth values: whether any layer of the access has it.
    bool any(const Access& access) {
        const auto first = of(access).begin() + access.first_layer;
        return std::any_of(first, first + access.layer_count, [](const T& value) { return value; });
    }
    void set(const Access& access, const T& value) {
        std::fill_n(of(access).begin() + access.first_layer, access.layer_count, value);
    }

private:
    std::vector<std::vector<T>> images_, buffers_;
};

} // namespace catoptric::graph
