#include "render/vertices.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::render {

DeviceVertices::DeviceVertices(const std::vector<bool>& moves, std::size_t slots)
    : static_vertices_("vertices", gpu::BufferUsage::vertex, slots),
      moving_("moving vertices", gpu::BufferUsage::vertex, slots),
      indices_("indices", gpu::BufferUsage::index, slots) {
    for (const bool one : moves) places_.push_back({one, 0});
}

void DeviceVertices::set_geometry(const FrameGeometry& geometry) {
    ++layouts_;
    places_.resize(geometry.ranges.size());
    std::vector<shared::Vertex> still, moving;
    std::vector<std::uint32_t> indices(geometry.indices.size());
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        if (range.shares) places_[i].moves = false; // the mesh's vertices never move
        if (range.storage != i) continue;
        std::vector<shared::Vertex>& home = places_[i].moves ? moving : still;
        places_[i].first = static_cast<std::uint32_t>(home.size());
        const auto first = geometry.vertices.begin() + range.first_vertex;
        home.insert(home.end(), first, first + range.vertex_count);
        for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; ++k)
            indices[k] = geometry.indices[k] - range.first_vertex + places_[i].first;
    }
    anything_moves_ = std::ranges::any_of(places_, &VertexRange::moves);
    static_vertices_.set(still);
    moving_.set(moving);
    indices_.set(indices);
}

bool DeviceVertices::record_move(std::size_t object) {
    return !std::exchange(places_[object].moves, true);
}

void DeviceVertices::copy_moved(const FrameGeometry& geometry) {
    std::vector<shared::Vertex> moving;
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        const auto first = geometry.vertices.begin() + range.first_vertex;
        if (places_[i].moves && range.storage == i)
            moving.insert(moving.end(), first, first + range.vertex_count);
    }
    moving_.set(moving);
}

std::size_t DeviceVertices::write(gpu::Device& device, std::size_t slot) {
    return static_vertices_.write(device, slot) + moving_.write(device, slot) +
           indices_.write(device, slot);
}

void DeviceVertices::bind(graph::PassCommands& commands, std::size_t slot) const {
    commands.bind_geometry(static_vertices_.buffer(slot), indices_.buffer(slot));
}

void DeviceVertices::bind(graph::PassCommands& commands, std::size_t slot,
                          std::size_t object) const {
    if (!anything_moves_) return;
    const DeviceList& vertices = places_[object].moves ? moving_ : static_vertices_;
    commands.bind_geometry(vertices.buffer(slot), indices_.buffer(slot));
}

} // namespace catoptric::render
