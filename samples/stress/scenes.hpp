#pragma once

#include "scene/build.hpp"
#include "stress/bench.hpp"

/// Scenes that are made from the run's seed, so that code cannot be fitted to them beforehand.
namespace catoptric::stress {

struct MirrorBall {
    dvec3 centre{0};
    double radius = 1;
};

/// Returns a room about 4 units wide with an open front, coloured walls and a lamp under the
/// ceiling. Up to 8 mirror balls, which do not touch, are on the floor. The camera is in front of
/// the room.
scene::Scene make_room(Bench& bench, int balls);

/// Returns a closed box about 8 units wide with mirror balls. Each point of the box emits exactly 1
/// and reflects nothing.
scene::Scene make_white_furnace(const std::vector<MirrorBall>& balls);

/// Returns a plane of 20 by 20 units at y = 0 with a small lamp 4 units above it. The camera sees
/// it at a slant. No object casts a shadow.
scene::Scene make_plane_with_lamp();

using scene::add_material, scene::add_mesh;
void add_quad(scene::Scene& scene, std::size_t material, dvec3 a, dvec3 b, dvec3 c, dvec3 d);
/// Adds an exact sphere that is represented by 4^(levels+1) triangles.
void add_ball(scene::Scene& scene, std::size_t material, const MirrorBall& ball, int levels = 4);

/// Returns the scene, including cameras and motions, under a root transform. The transform must not
/// shear, so that exact spheres stay spheres.
scene::Scene transform_scene(const scene::Scene& scene, const dmat4& root);

dmat4 scale_matrix(double factor);
dmat4 translation_matrix(dvec3 by);
/// Returns the rotation about an axis of any length.
dmat4 rotation_matrix(double radians, dvec3 axis);

} // namespace catoptric::stress
