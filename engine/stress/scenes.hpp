#pragma once

#include "scene/build.hpp"
#include "stress/bench.hpp"

/// Scenes that are made for a run from its seed, so that nothing can be known of them beforehand.
namespace catoptric::stress {

struct Ball {
    dvec3 centre{0};
    double radius = 1;
};

/// A room about 4 units wide with an open front, coloured walls, a lamp under the ceiling and
/// mirror balls on the floor, up to 8, that do not touch. The camera stands before it.
scene::Scene room(Bench& bench, int balls);

/// A closed box about 8 units wide, every point of which emits exactly 1 and reflects nothing, with
/// mirror balls.
scene::Scene furnace(const std::vector<Ball>& balls);

/// A plane of 20 by 20 units at y = 0 with a small lamp 4 above it, seen at a slant; nothing throws
/// a shadow.
scene::Scene plane();

using scene::add_material, scene::add_mesh;
void add_quad(scene::Scene& scene, std::size_t material, dvec3 a, dvec3 b, dvec3 c, dvec3 d);
/// 4^(levels+1) triangles that stand for an exact sphere.
void add_ball(scene::Scene& scene, std::size_t material, const Ball& ball, int levels = 4);

/// The whole scene, cameras and motions included, through a root transform. Exact spheres stay
/// spheres: no shear.
scene::Scene through(const scene::Scene& scene, const dmat4& root);

dmat4 scaled(double factor);
dmat4 moved(dvec3 by);
/// About an axis of any length.
dmat4 turned(double radians, dvec3 axis);

} // namespace catoptric::stress
