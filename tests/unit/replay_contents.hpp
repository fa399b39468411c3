#pragma once

#include "graph/graph.hpp"
#include "graph/plan.hpp"

#include <map>

// Simulated contents of images and buffers: a number computed from the pass that wrote the contents
// and from everything that this pass read.
namespace catoptric::graph {

enum class Kind { image, previous, buffer };

/// A unit of contents: one layer of an image, one layer of the image's contents in the last frame,
/// or a whole buffer.
struct Cell {
    Kind kind = Kind::image;
    std::uint32_t id = 0;
    std::uint32_t layer = 0;
    friend auto operator<=>(const Cell&, const Cell&) = default;
};

struct CellUse {
    Cell cell;
    ResourceUse use = ResourceUse::sampled;
    bool write = false;
    bool needs = false;
};

using Value = std::uint64_t; // stands for the contents of a cell
constexpr Value kGarbage = 0xdead;

inline Value mix(Value a, Value b) {
    return (a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2))) * 31;
}

inline std::vector<CellUse> uses_of(const Pass& pass) {
    std::vector<CellUse> uses;
    for (const ImageUse& u : pass.images) {
        const bool attached = u.use == ResourceUse::colour || u.use == ResourceUse::depth;
        const bool needs = !u.write || u.use == ResourceUse::storage || (attached && !u.clear);
        for (std::uint32_t l = 0; l < u.image.layer_count; ++l)
            uses.push_back({{u.image.previous ? Kind::previous : Kind::image, u.image.id,
                             u.image.first_layer + l},
                            u.use,
                            u.write,
                            needs});
    }
    for (const BufferUse& u : pass.buffers)
        uses.push_back({{Kind::buffer, u.buffer.id, 0},
                        u.use,
                        u.write,
                        !u.write || u.use == ResourceUse::storage});
    return uses;
}

class Contents {
public:
    Value at(const Cell& cell) const {
        if (cell.kind == Kind::previous) return mix(mix(7, cell.id), cell.layer);
        const auto found = values_.find(cell);
        return found == values_.end() ? kGarbage : found->second;
    }
    void set(const Cell& cell, Value value) { values_[cell] = value; }
    void lose(Kind kind, std::uint32_t id) {
        for (auto& [cell, value] : values_)
            if (cell.kind == kind && cell.id == id) value = kGarbage;
    }
    /// Executes a pass. The value of each written cell is a hash of the pass's number and of all
    /// values that the pass reads.
    void execute(const Pass& pass, std::uint32_t index) {
        const std::vector<CellUse> uses = uses_of(pass);
        Value inputs = index + 1;
        for (const CellUse& u : uses)
            if (u.needs) inputs = mix(inputs, at(u.cell));
        for (std::size_t i = 0; i < uses.size(); ++i)
            if (uses[i].write) set(uses[i].cell, mix(inputs, i));
    }

private:
    std::map<Cell, Value> values_;
};

/// Returns the cells (image layers and buffers) whose contents matter after a frame: all outputs,
/// and the images whose contents of the last frame the plan's passes read.
inline std::vector<Cell> outcome_cells(const Graph& graph, const GraphPlan& plan) {
    std::vector<Cell> cells;
    for (const ImageHandle& image : graph.output_images())
        for (std::uint32_t l = 0; l < image.layer_count; ++l)
            cells.push_back({Kind::image, image.id, image.first_layer + l});
    for (const BufferHandle& buffer : graph.output_buffers())
        cells.push_back({Kind::buffer, buffer.id, 0});
    for (const PlannedPass& planned : plan.passes)
        for (const CellUse& u : uses_of(graph.passes()[planned.pass]))
            if (u.cell.kind == Kind::previous)
                cells.push_back({Kind::image, u.cell.id, u.cell.layer});
    return cells;
}

/// Returns the values of `cells` after the passes have run, if each resource has its own memory.
inline std::vector<Value> ideal_outcome(const Graph& graph,
                                        const std::vector<std::uint32_t>& passes,
                                        const std::vector<Cell>& cells) {
    Contents contents;
    for (const std::uint32_t p : passes) contents.execute(graph.passes()[p], p);
    std::vector<Value> values;
    for (const Cell& cell : cells) values.push_back(contents.at(cell));
    return values;
}

} // namespace catoptric::graph
