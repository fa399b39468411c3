#pragma once

#include "graph/commands.hpp"
#include "render/device_list.hpp"
#include "render/geometry.hpp"

namespace catoptric::render {

/// The vertices and indices of a geometry on the device. Static vertices are stored apart from
/// moving ones, which are written again.
class DeviceVertices {
public:
    /// `moves`: by object, whether it is expected to move.
    DeviceVertices(const std::vector<bool>& moves, std::size_t slots);

    /// Stores a new geometry layout, or one whose indices changed. Costs O(n).
    void set_geometry(const FrameGeometry& geometry);
    /// Records that the object's vertices changed. Returns true if the object was expected not to
    /// move. The caller must then lay out all vertices again.
    bool record_move(std::size_t object);
    /// Copies the moved vertices. Nothing else may have changed.
    void copy_moved(const FrameGeometry& geometry);
    /// Returns how often `set_geometry` ran.
    std::size_t layout_count() const { return layouts_; }
    /// Returns the index of the object's first vertex in the buffer that it is drawn from.
    std::uint32_t first_vertex(std::size_t object) const { return places_[object].first; }
    /// Writes the changes, like DeviceList::write.
    std::size_t write(gpu::Device& device, std::size_t slot);
    /// Binds the static vertices and all indices.
    void bind(graph::PassCommands& commands, std::size_t slot) const;
    /// Binds the vertices of the object and all indices.
    void bind(graph::PassCommands& commands, std::size_t slot, std::size_t object) const;

private:
    struct VertexRange {
        bool moves = false;
        std::uint32_t first = 0;
    };
    std::size_t layouts_ = 0;
    std::vector<VertexRange> places_; ///< range of each object's vertices
    bool anything_moves_ = false;
    DeviceList static_vertices_, moving_, indices_;
};

} // namespace catoptric::render
