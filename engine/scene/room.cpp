// A furnished room: textures, furniture that shares its meshes, a wall mirror, a smooth floor, two
// lamps and a spot.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/material_facts.hpp"
#include "scene/pattern.hpp"
#include "scene/shapes.hpp"

#include <cmath>
#include <utility>

namespace catoptric::scene {

namespace {

dmat4 placement(dvec3 at, double degrees = 0) {
    const double angle = glm::radians(degrees);
    dmat4 world(1);
    world[0] = {std::cos(angle), 0, -std::sin(angle), 0};
    world[2] = {std::sin(angle), 0, std::cos(angle), 0};
    world[3] = dvec4(at, 1);
    return world;
}

/// Returns a wall whose texture repeats `times` a metre and stands upright on the vertical walls.
Mesh make_papered_wall(int face, dvec3 lo, dvec3 hi, float times) {
    Mesh mesh = make_box_wall(face, lo, hi);
    for (const dvec3& p : mesh.positions)
        mesh.uv[0].push_back(times * (face / 2 == 0   ? vec2(p.z, -p.y)
                                      : face / 2 == 1 ? vec2(p.x, p.z)
                                                      : vec2(p.x, -p.y)));
    return mesh;
}

void add_copies(Scene& scene, Mesh mesh, std::size_t material, const std::vector<dmat4>& places) {
    for (const dmat4& place : places)
        scene.objects.push_back(
            {.name = mesh.name + " " + std::to_string(1 + (&place - places.data())),
             .mesh = scene.meshes.size(),
             .material = material,
             .world_from_object = place});
    scene.meshes.push_back(std::move(mesh));
}

Mesh make_boxes(const std::string& name, const std::vector<std::pair<dvec3, dvec3>>& of) {
    Mesh all{.name = name};
    for (const auto& [lo, hi] : of) {
        const Mesh one = box(name, lo, hi);
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), one.positions.begin(), one.positions.end());
        all.normals.insert(all.normals.end(), one.normals.begin(), one.normals.end());
        all.uv[0].insert(all.uv[0].end(), one.uv[0].begin(), one.uv[0].end());
        for (const uvec3& triangle : one.triangles) all.triangles.push_back(triangle + first);
    }
    return all;
}

void add_furniture(Scene& scene) {
    const std::size_t oak = add_material(
        scene,
        {.name = "oak", .albedo = vec3(1), .albedo_texture = make_plank_texture({150, 104, 60})});
    const std::size_t linen = add_material(
        scene,
        {.name = "linen", .albedo = vec3(1), .albedo_texture = make_cloth_texture({206, 96, 70})});
    const std::size_t glaze = add_material(scene, {.name = "glaze",
                                                   .albedo = {.08f, .25f, .3f},
                                                   .two_sided = true,
                                                   .roughness = .04f,
                                                   .dielectric_f0 = vec3(kUsualDielectricF0),
                                                   .dielectric_f90 = vec3(1)});
    const Mesh chair = make_boxes("chair", {{{-.22, .42, -.22}, {.22, .46, .22}},
                                            {{-.22, .46, .18}, {.22, .95, .22}},
                                            {{-.22, 0, -.22}, {-.18, .42, -.18}},
                                            {{.18, 0, -.22}, {.22, .42, -.18}},
                                            {{-.22, 0, .18}, {-.18, .42, .22}},
                                            {{.18, 0, .18}, {.22, .42, .22}}});
    add_copies(scene, chair, oak,
               {placement({-.45, kSupportGap, .95}), placement({.45, kSupportGap, .95}),
                placement({-.45, kSupportGap, -.35}, 180), placement({.45, kSupportGap, -.35}, 180),
                placement({1.05, kSupportGap, .3}, 90), placement({1.9, kSupportGap, 1.7}, 130)});
    Mesh cushion = box("cushion", {-.2, .46 + 2 * kSupportGap, -.2}, {.2, .5, .17});
    for (vec2& uv : cushion.uv[0]) uv *= 4;
    add_copies(scene, cushion, linen,
               {placement({-.45, 0, .95}), placement({.45, 0, .95}),
                placement({-.45, 0, -.35}, 180), placement({.45, 0, -.35}, 180)});
    add_mesh(scene, box("table top", {-.8, .71, -.2}, {.8, .75, .8}), oak);
    add_copies(
        scene,
        lathe("leg", {{.05, 0}, {.05, .06}, {.025, .12}, {.045, .35}, {.025, .55}, {.05, .71}}, 16),
        oak,
        {placement({-.7, 0, -.1}), placement({.7, 0, -.1}), placement({-.7, 0, .7}),
         placement({.7, 0, .7})});
    add_copies(scene, lathe("bowl", {{0, 0}, {.1, 0}, {.16, .07}, {.2, .16}}, 32), glaze,
               {placement({.15, .75 + kSupportGap, .3})});
    add_copies(
        scene,
        lathe("vase", {{0, 0}, {.07, 0}, {.11, .12}, {.08, .26}, {.03, .36}, {.05, .42}}, 32),
        glaze,
        {placement({-.45, .75 + kSupportGap, .45}), placement({2.2, .9 + kSupportGap, -1.2}),
         placement({2.2, .9 + kSupportGap, -1.6})});
    add_mesh(scene, box("sideboard", {1.95, kSupportGap, -2}, {2.45, .9, -.8}), oak);
}

void add_room_lights(Scene& scene) {
    const std::size_t bulb = add_material(
        scene, {.name = "bulb", .emission = {2080, 1760, 1280}, .two_sided = true});
    const std::size_t shade = add_material(
        scene, {.name = "shade", .albedo = {.8f, .75f, .62f}, .two_sided = true});
    const std::vector<dmat4> places{placement({0, 1.75, .3}), placement({-2.1, 1.5, 2})};
    Mesh lamp = ball("bulb", 2);
    for (dvec3& position : lamp.positions) position *= .04;
    add_copies(scene, lamp, bulb, places);
    add_copies(scene, lathe("shade", {{.24, -.12}, {.1, .14}}, 32), shade, places);
    add_copies(scene, lathe("stand", {{.14, 0}, {.14, .02}, {.012, .04}, {.012, 1.42}}, 12), shade,
               {placement({-2.1, 0, 2})});
    PunctualLight spot{.name = "spot on the wall",
                       .kind = PunctualLight::Kind::spot,
                       .intensity = {16, 16, 18},
                       .cos_inner = std::cos(glm::radians(14.0)),
                       .cos_outer = std::cos(glm::radians(24.0))};
    const dvec3 at(1.2, 2.5, .6), to(2.5, 1.1, .9),
        back = glm::normalize(at - to), right = glm::normalize(glm::cross(dvec3(0, 1, 0), back));
    spot.world_from_light = dmat4(dvec4(right, 0), dvec4(glm::cross(back, right), 0),
                                  dvec4(back, 0), dvec4(at, 1));
    scene.punctual.push_back(spot);
}

} // namespace

Scene make_furnished_room() {
    Scene scene{.name = "room"};
    const std::size_t parquet = add_material(
        scene, {.name = "parquet",
                .albedo = vec3(1),
                .roughness = .04f,
                .dielectric_f0 = vec3(kUsualDielectricF0),
                .dielectric_f90 = vec3(1),
                .albedo_texture = make_plank_texture({168, 120, 74})});
    const std::size_t paper = add_material(
        scene, {.name = "wallpaper",
                .albedo = vec3(1),
                .albedo_texture = make_wallpaper_texture({214, 206, 186}, {150, 170, 160})});
    const std::size_t plaster = add_material(scene, {.name = "plaster", .albedo = vec3(.75f)});
    const dvec3 lo(-2.5, 0, -2.5), hi(2.5, 2.6, 2.5);
    for (const int face : {0, 1, 4, 5})
        add_mesh(scene, make_papered_wall(face, lo, hi, 1.6f), paper);
    add_mesh(scene, make_papered_wall(3, lo, hi, .8f), parquet);
    add_mesh(scene, make_box_wall(2, lo, hi), plaster);
    add_quad(scene, "wall mirror", add_material(scene, {.name = "mirror", .mirror = true}),
             {1.1, .8, 2.48}, {-1.1, .8, 2.48}, {-1.1, 2.2, 2.48}, {1.1, 2.2, 2.48});
    add_furniture(scene);
    add_room_lights(scene);
    scene.cameras.push_back({.name = "door",
                             .eye = {-1.8, 1.6, -2.2},
                             .target = {.3, .9, 1},
                             .vertical_fov_degrees = 58});
    scene.cameras.push_back({.name = "above the table",
                             .eye = {1.6, 2.3, -1.6},
                             .target = {-.2, .5, .6},
                             .vertical_fov_degrees = 50});
    return scene;
}

namespace {

const RegisteredBuiltInScene kFurnishedRoomScene{
    {"room",
     "furnished room: textures, a wall mirror, a smooth floor, two lamps "
     "and a spot",
     make_furnished_room, 3}};

} // namespace

} // namespace catoptric::scene
