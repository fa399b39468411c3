#pragma once

#include "graph/commands.hpp"
#include "render/geometry.hpp"
#include "render/resident.hpp"

namespace catoptric::render {

/// A geometry's vertices and indices on the device. What stands still has one copy there, apart
/// from what moves and is written again.
class Vertices {
public:
    /// `moves`: by object, whether it is expected to move.
    Vertices(const std::vector<bool>& moves, std::size_t slots);

    /// Of a geometry laid out anew, or of one whose indices changed. O(n).
    void lay_out(const Geometry& geometry);
    /// The object's vertices have changed. Returns whether nobody expected that, and all are to be
    /// laid out.
    bool move(std::size_t object);
    /// Takes over what has moved, where nothing else changed.
    void follow(const Geometry& geometry);
    /// How often they were laid out.
    std::size_t layouts() const { return layouts_; }
    /// Place of the object's first vertex among those that are drawn with it.
    std::uint32_t first_of(std::size_t object) const { return places_[object].first; }
    /// As Resident::write.
    std::size_t write(gpu::Device& device, std::size_t slot);
    /// Binds those of what stands still, and all indices.
    void bind(graph::Commands& commands, std::size_t slot) const;
    /// Binds the object's.
    void bind(graph::Commands& commands, std::size_t slot, std::size_t object) const;

private:
    struct Place {
        bool moves = false;
        std::uint32_t first = 0;
    };
    std::size_t layouts_ = 0;
    std::vector<Place> places_; ///< by object
    bool anything_moves_ = false;
    Resident still_, moving_, indices_;
};

} // namespace catoptric::render
