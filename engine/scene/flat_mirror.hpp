#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <vector>

/// Mirrors that are flat, which show what a camera behind them would see.
namespace catoptric::scene {

/// A surface that lies in a plane, or nearly so; world units.
struct Flat {
    dvec3 point{0};             ///< in the plane
    dvec3 normal{0};            ///< unit; to which side it points means nothing
    std::vector<dvec3> corners; ///< of the surface's convex hull, in order
    /// How far it is from flat: the largest angle, in radians, between the plane's normal and a
    /// vertex's, or a vertex's distance from the plane as a part of the surface's size if that is
    /// more.
    double off = 0;
};

/// What is further from flat than this is no Flat, whatever the picture.
inline constexpr double kFarFromFlat = .01;

/// Nothing where some vertex is too far off, or without a triangle that has an area. O(vertices),
/// and O(1) for most that are curved: it ends at the first vertex that is off.
std::optional<Flat> flat(const Mesh& mesh, const dmat4& world_from_object);

/// How far from flat a mirror may be that shows what a plane would, in a picture so many pixels
/// high: a sixteenth of the angle of a pixel in the picture's middle. A normal that is off by so
/// much turns a reflected ray by an eighth of a pixel; an orthographic picture's pixels are those
/// of an angle whose tangent is 2 / height.
double flat_tolerance(const Camera& camera, uvec2 size);

} // namespace catoptric::scene
