#pragma once

#include "require/wall.hpp"
#include "scene/light.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

/// The data of a scene that the rules for required work use: places of objects, movers, and walls
/// that hide objects.
namespace catoptric::require {

/// Relative enlargement of boxes, as a part of two lengths: the extent of all objects that stand
/// still, and the distance from their middle. Device and rules round differently, by at most 2^-24
/// of these lengths.
inline constexpr double kPositionRoundingError = 0x1p-20;
/// Largest number of walls that are tested. Only the largest quadrilaterals that never moved are
/// walls.
inline constexpr std::size_t kMaxWalls = 32;
/// Least area of a wall, as a part of the square of the extent of all objects that never moved.
inline constexpr double kMinWallAreaShare = 1e-3;

/// Facts about a mesh that do not depend on where an object is.
struct MeshShape {
    Bounds<double> box; ///< in the mesh's own space
    double radius = 0;  ///< radius of all triangles of the mesh, around the middle of `box`
    std::uint64_t content_hash = 0;
    std::vector<QuadCorners> quads;
    dvec3 flat_normal{0}; ///< normal of a flat mesh, zero for other meshes (require/reach.hpp)
};

struct VisibilityObject {
    std::size_t mesh = 0, material = 0;
    dmat4 rest{1}, place{1}; ///< world from object: at rest, and now
    std::optional<scene::Sphere> sphere;
    bool seen_by_camera = true, is_mirror = false, casts_shadow = true;
    bool is_glass = false;          ///< rays pass through (scene::is_glass)
    bool has_lobe = false;          ///< a mirror that may be rough (scene::may_reflect_by_lobe)
    bool is_mover = false;          ///< whether the object has a motion or was ever moved
    bool has_moved = false;         ///< whether the object moved since the previous instant
    Bounds<double> tight_rest;      ///< bounds of its vertices at rest
    Bounds<double> tight;           ///< bounds now; larger for a turned mover that is no mirror
    Bounds<double> box;             ///< `tight` enlarged for roundings; empty: no triangle
    dvec3 middle{0};                ///< centre of a sphere that contains the object
    double radius = 0;              ///< radius of this sphere, enlarged for roundings
    std::uint64_t content_hash = 0; ///< content hash of its mesh, place, sphere and material
};

/// A scene as the rules see it, from instant to instant. Objects that never moved are kept apart
/// from movers. Objects that never moved cannot change a capture, so one hash (`static_hash`)
/// covers all of them in content hashes.
class VisibilityScene {
public:
    /// Takes the scene at rest. O(vertices + texels of images), for the bounds and content hashes
    /// of meshes and the content hashes of materials.
    explicit VisibilityScene(const scene::Scene& rest);

    /// Takes over an instant. O(objects), and O(vertices) for mirrors that turn and lamps that
    /// move. An object that stood still and has moved (an edit) is a mover from then on. Such an
    /// edit changes `static_hash`, and so does another number of objects, material, light or
    /// environment.
    void update(const scene::Scene& now);

    const std::vector<VisibilityObject>& objects() const { return things_; }
    const std::vector<std::size_t>& mirrors() const {
        return mirrors_;
    } ///< indices of the mirrors' objects
    const std::vector<std::size_t>& movers() const {
        return movers_;
    }                                                         ///< indices of the moving objects
    const std::vector<Wall>& walls() const { return walls_; } ///< the largest first
    const std::vector<scene::PointLight>& lights() const { return lights_; }
    const std::vector<MeshShape>& mesh_shapes() const { return meshes_; }
    const Bounds<double>& static_bounds() const {
        return still_;
    } ///< bounds of all that never moved
    /// Returns the largest rounding error of a position, in world units.
    double rounding_error() const { return rounding_; }
    std::uint64_t static_hash() const {
        return static_hash_;
    } ///< content hash of all that is no mover, and of the lights
    /// Returns the number of calls of set_layout.
    std::uint64_t layout_version() const { return layout_version_; }
    bool has_changed() const {
        return has_changed_;
    } ///< whether anything changed since the previous instant

private:
    void set_layout(const scene::Scene& now);
    bool has_same_layout(const scene::Scene& now) const;
    void move_object(const scene::Scene& now, std::size_t object);
    void find_walls();
    void update_static_hash();

    std::vector<MeshShape> meshes_;
    std::vector<scene::Material> materials_;
    std::vector<scene::PunctualLight> punctual_;
    std::shared_ptr<const scene::Environment> environment_;
    std::uint64_t materials_stamp_ = 0, environment_stamp_ = 0, static_hash_ = 0,
                  layout_version_ = 0;
    std::vector<VisibilityObject> things_;
    std::vector<std::size_t> mirrors_, movers_;
    std::vector<Wall> walls_;
    std::vector<scene::PointLight> lights_;
    Bounds<double> still_;
    dvec3 middle_{0};
    double rounding_ = 0;
    bool has_changed_ = true;
};

} // namespace catoptric::require
