#pragma once

#include "import/load.hpp"
#include "scene/build.hpp"
#include "scene/scene.hpp"
#include "scene/shapes.hpp"

#include <array>
#include <string>

/// Small scenes whose pictures are known without rendering them.
namespace test {

using namespace catoptric;

using scene::add_ball, scene::add_material, scene::add_mesh, scene::add_quad, scene::make_box_wall;

/// Radiance of every wall of a furnace; exact in 16-bit floats.
constexpr vec3 kFurnaceWallRadiance{0.5f, 0.25f, 0.75f};

/// Turns all perfect mirrors of a scene into metals of this roughness, which stay mirrors.
inline void make_mirrors_rough(scene::Scene& scene, float roughness) {
    scene.mirror_max_roughness = roughness;
    for (scene::Object& object : scene.objects) object.mirror = scene::is_mirror(scene, object);
    for (scene::Material& material : scene.materials) {
        if (!material.mirror) continue;
        material.mirror = false;
        material.albedo = vec3(.9f), material.metallic = 1, material.roughness = roughness;
    }
}

/// Returns a furnace: a closed box with one or two mirror balls. Every point of the box emits
/// kFurnaceWallRadiance and reflects nothing, so every pixel must show kFurnaceWallRadiance.
inline scene::Scene make_furnace_scene(int mirrors) {
    scene::Scene scene{.name = "furnace"};
    const std::size_t hot = add_material(scene, {.name = "hot", .emission = kFurnaceWallRadiance});
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), hot);
    add_ball(scene, "ball1", mirror, {-1.2, -0.3, 1}, 1);
    if (mirrors > 1) add_ball(scene, "ball2", mirror, {1.3, 0.4, 1.5}, 1.2);
    scene.cameras.push_back({.name = "inside",
                             .eye = {0.2, 0.1, -4.5},
                             .target = {0, 0, 1},
                             .vertical_fov_degrees = 50});
    return scene;
}

/// Returns the scene with balls of only 256 triangles, because triangles take most of the time of
/// small pictures.
inline scene::Scene replace_balls_by_coarse_balls(scene::Scene scene) {
    for (const scene::Object& object : scene.objects)
        if (object.sphere) scene.meshes[object.mesh] = scene::ball("ball", 3);
    return scene;
}

/// Returns a white room with coloured side walls, `lights` lamps under the ceiling and `mirrors` (0
/// to 3) mirror balls.
inline scene::Scene make_lit_room(int mirrors, int lights) {
    scene::Scene scene{.name = "room"};
    const std::size_t white = add_material(scene, {.name = "white", .albedo = {.7f, .7f, .7f}});
    const std::size_t red = add_material(scene, {.name = "red", .albedo = {.6f, .1f, .1f}});
    const std::size_t green = add_material(scene, {.name = "green", .albedo = {.1f, .5f, .1f}});
    const std::size_t lamp = add_material(scene, {.name = "lamp", .emission = {9, 8, 6}});
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, make_box_wall(face, {-2, -2, -3}, {2, 2, 2}),
                 face == 0   ? red
                 : face == 1 ? green
                             : white);
    for (int i = 0; i < lights; ++i) {
        const double x = lights == 1 ? 0 : -1 + 2.0 * i / (lights - 1);
        add_quad(scene, "lamp" + std::to_string(i + 1), lamp, {x - .3, 1.99, -.4},
                 {x + .3, 1.99, -.4}, {x + .3, 1.99, .2}, {x - .3, 1.99, .2});
    }
    const std::array<dvec3, 3> places{{{-.9, -1.2, .3}, {.8, -.9, .9}, {.3, .3, -.4}}};
    const std::array<double, 3> radii{.7, .9, .4};
    for (std::size_t i = 0; i < static_cast<std::size_t>(mirrors); ++i)
        add_ball(scene, "ball" + std::to_string(i + 1), mirror, places[i], radii[i]);
    scene.cameras.push_back({.name = "inside",
                             .eye = {.1, .2, -2.9},
                             .target = {0, -.2, 0},
                             .vertical_fov_degrees = 70});
    return scene;
}

/// Returns the room with one lamp, a mirror ball, a mirrored block, and a flat mirror on the wall
/// behind them. The mirrors reflect each other, and only the ball is an exact sphere.
inline scene::Scene make_mirror_hall() {
    scene::Scene scene = make_lit_room(0, 1);
    scene.name = "hall";
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    add_ball(scene, "ball", mirror, {-.9, -1.2, -.2}, .7);
    scene::Mesh block{.name = "block"};
    for (int face = 0; face < 6; ++face) {
        // The walls of the block face outwards, because the low and high corners are exchanged.
        const scene::Mesh side = make_box_wall(face, {1.5, -.7, .9}, {.5, -1.9, -.1});
        const auto first = static_cast<std::uint32_t>(block.positions.size());
        block.positions.insert(block.positions.end(), side.positions.begin(), side.positions.end());
        block.normals.insert(block.normals.end(), side.normals.begin(), side.normals.end());
        for (const auto& triangle : side.triangles) block.triangles.push_back(triangle + first);
    }
    add_mesh(scene, block, mirror);
    add_quad(scene, "panel", mirror, {-1.5, -1, 1.9}, {1.5, -1, 1.9}, {1.5, 1.2, 1.9},
             {-1.5, 1.2, 1.9});
    return scene;
}

/// Returns a mesh of two boards at a right angle that face each other. As a mirror, the mesh
/// reflects itself.
inline scene::Mesh make_hollow_corner() {
    scene::Mesh corner = scene::quad("corner", {-1.5, -1.5, 1.5}, {0, -1.5, 1.9}, {0, 1.5, 1.9},
                                     {-1.5, 1.5, 1.5});
    const scene::Mesh other = scene::quad("", {0, -1.5, 1.9}, {.4, -1.5, .4}, {.4, 1.5, .4},
                                          {0, 1.5, 1.9});
    corner.positions.insert(corner.positions.end(), other.positions.begin(), other.positions.end());
    corner.normals.insert(corner.normals.end(), other.normals.begin(), other.normals.end());
    for (const uvec3& triangle : other.triangles) corner.triangles.push_back(triangle + 4u);
    return corner;
}

} // namespace test
