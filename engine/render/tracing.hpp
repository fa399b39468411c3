#pragma once

#include "bvh/two_level.hpp"
#include "graph/commands.hpp"
#include "render/geometry.hpp"
#include "render/resident.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace catoptric::render {

/// A refitted hierarchy is built anew once its cost (bvh::cost) is this many times what it was.
inline constexpr double kWorstRefit = 2;

/// The hierarchy that rays walk, made when somebody asks for it: built once for a layout of
/// objects, refitted where objects have moved since.
class Tracing {
public:
    explicit Tracing(std::size_t slots);

    /// The objects are others than before.
    void lay_out();
    /// `vertices`: these changed, not only where an object's own space stands.
    void move(std::size_t object, bool vertices) { moved_.push_back({object, vertices}); }
    /// Brings the hierarchy up to date for slot `slot`; nothing to do where nothing has changed
    /// since. Building is O(n log^2 n), refitting O(n).
    void prepare(gpu::Device& device, const Geometry& geometry, std::size_t slot);
    void bind(graph::Commands& commands, std::size_t slot) const;

    std::size_t built() const { return built_; }
    std::size_t refitted() const { return refitted_; }
    std::size_t writes() const { return writes_; } ///< of device memory, all together
    double ms() const { return ms_; }              ///< of the host, all together
    /// Of the host, what is in `ms` of the first time that somebody asked: trees, and their way to
    /// the device.
    double first_build_ms() const { return first_build_ms_; }
    double first_write_ms() const { return first_write_ms_; }

private:
    struct Move {
        std::size_t object;
        bool vertices;
    };
    void bring_up_to_date(const Geometry& geometry);
    void build(const Geometry& geometry);
    void refit(const Geometry& geometry, const std::vector<char>& objects);
    void build_own(const Geometry& geometry, std::size_t object);
    void follow(const Geometry& geometry);
    void fill(const Geometry& geometry);

    std::vector<bvh::Triangle> triangles_; ///< as Geometry::indices lists them
    std::vector<vec4> normals_;
    /// Of normals and of the tree's triangles, outside of which none has changed since they were
    /// filled.
    bvh::Run changed_normals_, changed_triangles_;
    bvh::Bvh tree_;                             ///< of what is in scene units
    std::map<std::size_t, bvh::Bvh> own_trees_; ///< by the object whose vertices they are
    double cost_when_built_ = 0;
    bool laid_out_ = false;
    std::vector<Move> moved_; ///< since the hierarchy was made
    Resident nodes_buffer_, triangles_buffer_, normals_buffer_;
    std::size_t built_ = 0, refitted_ = 0, writes_ = 0;
    double ms_ = 0, first_build_ms_ = 0, first_write_ms_ = 0;
};

} // namespace catoptric::render
