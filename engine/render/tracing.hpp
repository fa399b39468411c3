#pragma once

#include "bvh/tlas.hpp"
#include "graph/commands.hpp"
#include "render/geometry.hpp"
#include "render/resident.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace catoptric::render {

/// A refitted hierarchy is built anew once its cost (bvh::cost) is this many times what it was.
inline constexpr double kWorstRefit = 2;

/// What rays meet of a thing that stands for an exact sphere: its triangles, or a ball in their
/// place. Each has a hierarchy of its own.
enum class Spheres { mesh, exact };

/// What the tracer's shaders are to be built for by a device's choices, but for its defaults, where
/// nodes and triangles have so many bytes: more than a storage buffer may are texels.
gpu::Constants constants_of(const gpu::Choices& choices, std::uint64_t bytes,
                            std::uint64_t most_of_storage);

/// The hierarchies that rays walk, each made when somebody asks for it: built once for a layout of
/// objects, refitted where objects have moved since.
class Tracing {
public:
    explicit Tracing(std::size_t slots);

    /// The objects are others than before.
    void lay_out();
    /// `vertices`: these changed, not only where an object's own space stands.
    void move(std::size_t object, bool vertices) { moved_.push_back({object, vertices}); }
    /// Brings a hierarchy up to date for slot `slot`; nothing to do where nothing has changed
    /// since. `surfaces`: of each object, scene units. Building is O(n log^2 n), refitting O(n).
    void prepare(gpu::Device& device, const Geometry& geometry,
                 std::span<const shared::Surface> surfaces, Spheres spheres, std::size_t slot);
    void bind(graph::Commands& commands, Spheres spheres, std::size_t slot) const;
    /// Bytes of nodes or of triangles, the more, as `prepare` wrote them for the slot.
    std::uint64_t largest_bytes(Spheres spheres, std::size_t slot) const;

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
    /// What changed so far: a hierarchy that has seen less is behind.
    struct Version {
        std::size_t layouts = 0, moves = 0;
        friend bool operator==(const Version&, const Version&) = default;
    };
    struct Hierarchy {
        explicit Hierarchy(std::size_t slots)
            : nodes("bvh_nodes", gpu::BufferUse::texels, slots),
              triangles("bvh_triangles", gpu::BufferUse::texels, slots) {}
        bvh::Bvh tree; ///< of what is in scene units
        double cost_when_built = 0;
        Version seen;
        std::vector<char> moved;   ///< by object in scene units, since then
        std::vector<char> reached; ///< likewise, those of `reach`
        bvh::Reach reach;
        bvh::Run changed; ///< of the tree's triangles, since they were filled
        Resident nodes, triangles;
    };
    Hierarchy& of(Spheres spheres) { return hierarchies_[static_cast<std::size_t>(spheres)]; }
    void read(const Geometry& geometry);
    void bring_up_to_date(Hierarchy& hierarchy, const Geometry& geometry,
                          std::span<const bvh::Triangle> flat);
    void build(Hierarchy& hierarchy, const Geometry& geometry, std::span<const bvh::Triangle> flat);
    void refit(Hierarchy& hierarchy, const Geometry& geometry, std::span<const bvh::Triangle> flat);
    void follow(const Geometry& geometry);
    void build_own(const Geometry& geometry, std::size_t object);
    void fill(Hierarchy& hierarchy, const Geometry& geometry) const;

    std::vector<bvh::Triangle> triangles_; ///< as Geometry::indices lists them
    std::vector<vec4> normals_;
    std::map<std::size_t, bvh::Bvh> own_trees_; ///< by the object whose vertices they are
    Version version_{1, 0};
    bool is_read_ = false;    ///< this layout
    std::vector<Move> moved_; ///< since the triangles were read
    std::array<Hierarchy, 2> hierarchies_;
    Resident normals_buffer_;
    std::size_t built_ = 0, refitted_ = 0, writes_ = 0;
    double ms_ = 0, first_build_ms_ = 0, first_write_ms_ = 0;
};

} // namespace catoptric::render
