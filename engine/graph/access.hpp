#pragma once

#include "graph/plan.hpp"
#include "graph/runs.hpp"

#include <span>
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

    /// Also of a wrong access, whose layers may be more than 32 bits hold.
    std::uint64_t end_layer() const { return std::uint64_t{first_layer} + layer_count; }
};

/// What the pass touches: images in order of declaration, then buffers.
std::vector<Access> accesses(const Pass& pass);

/// The same of every pass of a graph, gathered once.
class Accesses {
public:
    explicit Accesses(const Graph& graph);
    std::span<const Access> of(std::size_t pass) const {
        return {all_.data() + first_[pass], all_.data() + first_[pass + 1]};
    }

private:
    std::vector<Access> all_;
    std::vector<std::size_t> first_; // of each pass, and the end
};

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
class Ledger {
public:
    explicit Ledger(const Graph& graph, const T& value = {}) : images_(graph.images().size()) {
        runs_.reserve(images_ + graph.buffers().size());
        for (const ImageDesc& desc : graph.images()) runs_.emplace_back(desc.layers, value);
        runs_.resize(images_ + graph.buffers().size(), Runs<T>(1, value));
    }
    Runs<T>& of(const Access& a) { return runs_[a.is_buffer ? images_ + a.id : a.id]; }
    const Runs<T>& of(const Access& a) const { return runs_[a.is_buffer ? images_ + a.id : a.id]; }

    /// Calls visit(first layer, end layer, value) for the runs that the access meets.
    template <typename Visit>
    void each(const Access& a, const Visit& visit) const {
        of(a).each(a.first_layer, a.first_layer + a.layer_count, visit);
    }
    template <typename Visit>
    void change(const Access& a, const Visit& visit) {
        of(a).change(a.first_layer, a.first_layer + a.layer_count, visit);
    }
    void set(const Access& a, const T& value) {
        of(a).set(a.first_layer, a.first_layer + a.layer_count, value);
    }
    /// Whether some layer of the access has the value.
    bool any(const Access& a, const T& value) const {
        return of(a).any(a.first_layer, a.first_layer + a.layer_count, value);
    }

private:
    std::size_t images_;
    std::vector<Runs<T>> runs_; // images, then buffers
};

/// True for every layer and buffer that the graph wants.
Ledger<char> wanted_parts(const Graph& graph);

} // namespace catoptric::graph
