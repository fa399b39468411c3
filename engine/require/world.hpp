#pragma once

#include "require/wall.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

/// What rules go by: where everything is, what moves, what stands in the way.
namespace catoptric::require {

/// Boxes are larger than what they hold by this part of the extent of all that stands still and of
/// how far they are from its middle: device and rules round differently, by 2^-24 of it at most.
inline constexpr double kRounding = 0x1p-20;
/// The largest of what stands still, which are looked at for what they hide.
inline constexpr std::size_t kMostWalls = 32;
/// ... of those that have at least this part of the square of that extent.
inline constexpr double kLeastWall = 1e-3;

/// What does not depend on where an object is.
struct MeshFacts {
    Bounds<double> box; ///< in the mesh's own space
    double radius = 0;  ///< of all that is drawn, around the middle of `box`
    std::uint64_t content_hash = 0;
    std::vector<Quad> quads;
    dvec3 flat_normal{0}; ///< of a flat one (require/reach.hpp)
};

struct WorldObject {
    std::size_t mesh = 0, material = 0;
    dmat4 rest{1}, place{1}; ///< world from object: when it was found, and now
    std::optional<scene::Sphere> sphere;
    bool seen_by_camera = true, is_mirror = false, casts_shadow = true;
    bool is_mover = false;          ///< it has a motion, or was moved since
    bool has_moved = false;         ///< since the instant before
    Bounds<double> tight_rest;      ///< of its vertices
    Bounds<double> tight;           ///< now; of a turned mover that is no mirror a larger box
    Bounds<double> box;             ///< `tight` with room for roundings; empty: it has no triangle
    dvec3 middle{0};                ///< of a sphere that holds it
    double radius = 0;              ///< of that, with room for roundings
    std::uint64_t content_hash = 0; ///< of its mesh, place, sphere and material
};

/// A scene as rules see it, instant by instant. What has never moved is told apart from what has:
/// it cannot change what a capture shows, so one number stands for all of it.
class World {
public:
    /// O(vertices): bounds and stamps of meshes, texels of images.
    explicit World(const scene::Scene& rest);

    /// Takes over an instant. O(objects), O(vertices) in mirrors that turn and in lamps that move.
    /// What was still and is not any more (an edit) is a mover from then on; that, and another
    /// number of things or another material, light or environment, is another `epoch`.
    void follow(const scene::Scene& now);

    const std::vector<WorldObject>& things() const { return things_; }
    const std::vector<std::size_t>& mirrors() const { return mirrors_; } ///< objects
    const std::vector<std::size_t>& movers() const { return movers_; }   ///< objects
    const std::vector<Wall>& walls() const { return walls_; }            ///< the largest first
    const std::vector<scene::PointLight>& lights() const { return lights_; }
    const std::vector<MeshFacts>& meshes() const { return meshes_; }
    const Bounds<double>& still() const { return still_; } ///< of what has never moved
    double rounding() const { return rounding_; }          ///< world units
    std::uint64_t epoch() const { return epoch_; } ///< of all that is no mover, and of the lights
    std::uint64_t layouts() const { return layouts_; } ///< another where other things stand still
    bool has_changed() const { return has_changed_; }  ///< anything, since the instant before

private:
    void lay_out(const scene::Scene& now);
    bool fits(const scene::Scene& now) const;
    void move(const scene::Scene& now, std::size_t object);
    void find_walls();
    void find_epoch();

    std::vector<MeshFacts> meshes_;
    std::vector<scene::Material> materials_;
    std::vector<scene::Punctual> punctual_;
    std::shared_ptr<const scene::Environment> environment_;
    std::uint64_t materials_stamp_ = 0, environment_stamp_ = 0, epoch_ = 0, layouts_ = 0;
    std::vector<WorldObject> things_;
    std::vector<std::size_t> mirrors_, movers_;
    std::vector<Wall> walls_;
    std::vector<scene::PointLight> lights_;
    Bounds<double> still_;
    dvec3 middle_{0};
    double rounding_ = 0;
    bool has_changed_ = true;
};

} // namespace catoptric::require
