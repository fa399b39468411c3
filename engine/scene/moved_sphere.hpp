#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace catoptric::scene {

/// Returns the factor by which the matrix lengthens every vector, or nothing if the factor depends
/// on the vector.
std::optional<double> uniform_scale(const dmat3& matrix);

/// Returns the object's exact sphere in the world after a move of the object to
/// `world_from_object`. Returns nothing if the object has no exact sphere, or if the move turns it
/// into an ellipsoid.
std::optional<Sphere> move_sphere(const Object& object, const dmat4& world_from_object);

/// Returns whether a sphere that follows the node stays a sphere of positive radius at all times:
/// all scales of the node and its ancestors are positive and the same along all axes. Returns false
/// for cubic tracks of scales, which may reach zero between their keys. O(keys of scales).
bool preserves_spheres(const RigAttachment& follows);

} // namespace catoptric::scene
