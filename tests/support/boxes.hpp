#pragma once

#include "scene/shapes.hpp"
#include "support/paths.hpp"

#include <vector>

namespace test {

/// Returns a box with a mirror ball near its middle. Each wall emits its own colour. `open` leaves
/// out the wall behind the eye. `boards` are the centres of green light-emitting boards.
inline scene::Scene make_coloured_box(const std::vector<dvec3>& boards, bool open = false) {
    scene::Scene scene{.name = open ? "open box" : "box"};
    for (int face = 0; face < (open ? 5 : 6); ++face)
        add_mesh(
            scene, make_box_wall(face, {-4, -3, -5}, {4, 3, 5}),
            add_material(scene, {.name = "wall",
                                 .emission = vec3(face & 1 ? .75f : .25f, face & 2 ? .75f : .25f,
                                                  face & 4 ? .75f : .25f)}));
    add_ball(scene, "ball", add_halving_mirror(scene, 1), {.5, -.2, 1}, 1, 5);
    for (const dvec3& centre : boards)
        add_glowing_board(scene, {0, .1f, 0}, centre, {.5, 0, .3}, {0, .5, 0});
    scene.cameras.push_back(
        {.eye = {-.8, .8, -3.6}, .target = {.5, -.2, 1}, .vertical_fov_degrees = 24});
    return scene;
}

} // namespace test
