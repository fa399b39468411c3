#pragma once

#include "bvh/tlas.hpp"
#include "graph/commands.hpp"
#include "render/device_list.hpp"
#include "render/geometry.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace catoptric::render {

/// A refitted hierarchy is rebuilt once its cost (bvh::sah_cost) exceeds this many times
/// the cost when built.
inline constexpr double kMaxRefitCostRatio = 2;

/// The two ways in which rays intersect an exact sphere: as the triangles of its mesh (`mesh`), or
/// as a sphere (`exact`). Each way has a hierarchy of its own.
enum class SphereMode { mesh, exact };

/// Returns the constants with which the tracer's shaders are built for a device's choices, without
/// defaults. `bytes`: the size of the nodes or triangles. If it exceeds `most_of_storage`, they are
/// texel buffers instead of storage buffers.
gpu::ShaderConstants make_tracer_constants(const gpu::VariantChoices& choices, std::uint64_t bytes,
                                           std::uint64_t most_of_storage);

/// The hierarchies that rays walk. Each is built at its first use for a layout of objects, and
/// refitted after objects have moved.
class RayTracingTrees {
public:
    explicit RayTracingTrees(std::size_t slots);

    void record_layout_change();
    /// Records which objects cast a shadow on nothing for any light, by object (see backdrop.hpp).
    /// Shadow rays pass through such objects. Another set needs new hierarchies.
    void set_backdrops(std::vector<std::uint8_t> backdrops);
    /// Records that an object moved. `vertices`: its vertices changed, not only the placement of
    /// its object space.
    void record_move(std::size_t object, bool vertices) { moved_.push_back({object, vertices}); }
    /// Brings a hierarchy up to date for slot `slot`. Does nothing if nothing changed since the
    /// last call. `surfaces`: by object, scene units. `first_hits`: the list that finds a triangle
    /// of the rasteriser in the hierarchy is needed, too. A build costs O(n log^2 n), a refit O(n).
    void prepare(gpu::Device& device, const FrameGeometry& geometry,
                 std::span<const shared::Surface> surfaces, SphereMode spheres, bool first_hits,
                 std::size_t slot);
    void bind(graph::PassCommands& commands, SphereMode spheres, std::size_t slot) const;
    /// Returns the size in bytes, as written for the slot, of the buffer of nodes or of the buffer
    /// of triangles, whichever is larger.
    std::uint64_t largest_buffer_bytes(SphereMode spheres, std::size_t slot) const;

    std::size_t built_count() const { return built_; }
    std::size_t refitted_count() const { return refitted_; }
    /// Number of writes to device memory since construction.
    std::size_t write_count() const { return writes_; }
    double bvh_update_ms() const { return ms_; } ///< host time in ms since construction
    /// Returns the host milliseconds of the first use, which `bvh_update_ms` includes: for building
    /// the trees, and for writing them to the device.
    double first_bvh_build_ms() const { return first_build_ms_; }
    double first_bvh_write_ms() const { return first_write_ms_; }

private:
    struct MovedObject {
        std::size_t object;
        bool vertices;
    };
    /// Version number of the scene's geometry. A hierarchy with an older version is out of date.
    struct GeometryVersion {
        std::size_t layouts = 0, moves = 0;
        friend bool operator==(const GeometryVersion&, const GeometryVersion&) = default;
    };
    struct DeviceBvh {
        explicit DeviceBvh(std::size_t slots)
            : nodes("bvh_nodes", gpu::BufferUsage::texels, slots),
              triangles("bvh_triangles", gpu::BufferUsage::texels, slots),
              first_hits("first_hits", gpu::BufferUsage::words, slots) {}
        bvh::Bvh tree; ///< tree of the triangles in scene units
        double built_cost = 0;
        GeometryVersion seen;
        std::vector<char> moved; ///< for each object in scene units: whether it moved since `seen`
        std::vector<char> reached; ///< for each object: whether `reach` includes it
        bvh::RefitRegion reach;
        bvh::IndexRange changed; ///< range of the tree's triangles that changed since the last
                                 ///< `assemble`
        bool lists_first_hits = false; ///< `first_hits` describes the hierarchy
        DeviceList nodes, triangles;
        /// Finds a triangle of the rasteriser in the hierarchy: see intersect_rasterised_triangle
        /// in shaders/lib/whitted.glsl.
        DeviceList first_hits;
    };
    DeviceBvh& bvh_of(SphereMode spheres) {
        return hierarchies_[static_cast<std::size_t>(spheres)];
    }
    std::uint32_t backdrop_flag(std::size_t object) const {
        return object < backdrops_.size() && backdrops_[object] != 0 ? bvh::kCastsNoShadowFlag : 0;
    }
    void read_changes(const FrameGeometry& geometry);
    void rebuild_or_refit(DeviceBvh& hierarchy, const FrameGeometry& geometry,
                          std::span<const bvh::Triangle> flat, bool first_hits);
    void build(DeviceBvh& hierarchy, const FrameGeometry& geometry,
               std::span<const bvh::Triangle> flat);
    void refit(DeviceBvh& hierarchy, const FrameGeometry& geometry,
               std::span<const bvh::Triangle> flat);
    void read_moves(const FrameGeometry& geometry);
    void build_object_tree(const FrameGeometry& geometry, std::size_t object);
    std::vector<bvh::BvhInstance> bvh_instances(const FrameGeometry& geometry) const;
    void assemble(DeviceBvh& hierarchy, const FrameGeometry& geometry, bool first_hits) const;

    std::vector<bvh::Triangle> triangles_; ///< triangles as FrameGeometry::indices lists them
    std::vector<std::uint8_t> backdrops_;  ///< backdrop objects, see set_backdrops
    std::vector<vec4> normals_;
    /// Trees of meshes in object space, by the object that owns the vertices.
    std::map<std::size_t, bvh::Bvh> own_trees_;
    GeometryVersion version_{1, 0};
    bool is_read_ = false;           ///< the present layout has been read
    std::vector<MovedObject> moved_; ///< moves since the triangles were read
    std::array<DeviceBvh, 2> hierarchies_;
    DeviceList corner_normals_;
    std::size_t built_ = 0, refitted_ = 0, writes_ = 0;
    double ms_ = 0, first_build_ms_ = 0, first_write_ms_ = 0;
};

} // namespace catoptric::render
