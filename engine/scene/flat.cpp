// A closed room with one flat mirror, the commonest kind of mirror.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"

namespace catoptric::scene {

Scene make_flat_room() {
    Scene scene{.name = "flat"};
    const auto add_paint_material = [&](const char* name, vec3 albedo) {
        return add_material(scene, {.name = name, .albedo = albedo});
    };
    const dvec3 lo(-2, 0, -3), hi(2, 2.6, 3);
    const std::size_t white = add_paint_material("white", {.72f, .71f, .68f}),
                      red = add_paint_material("red", {.6f, .12f, .08f}),
                      blue = add_paint_material("blue", {.12f, .2f, .5f}),
                      wood = add_paint_material("wood", {.42f, .27f, .14f});
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, make_box_wall(face, lo, hi),
                 face == 0   ? red
                 : face == 1 ? blue
                 : face == 3 ? wood
                             : white);
    add_quad(scene, "mirror", add_material(scene, {.name = "mirror", .mirror = true}),
             {1.3, .5, 2.98}, {-1.3, .5, 2.98}, {-1.3, 2.1, 2.98}, {1.3, 2.1, 2.98});
    add_mesh(scene, box("cupboard", {-1.95, kSupportGap, -1.5}, {-1.4, 1.6, .2}), wood);
    add_mesh(scene, box("stool", {.5, kSupportGap, .9}, {1, .5, 1.4}), red);
    const std::size_t clay = add_paint_material("clay", {.65f, .4f, .25f});
    scene.materials[clay].two_sided = true;
    add_mesh(scene,
             lathe("vase", {{0, .5}, {.09, .5}, {.14, .6}, {.12, .74}, {.05, .84}, {.07, .9}}, 32),
             clay);
    scene.objects.back().world_from_object[3] = dvec4(.75, kSupportGap, 1.15, 1);
    add_quad(scene, "lamp", add_material(scene, {.name = "lamp", .emission = {30, 27, 22}}),
             {-.4, 2.59, -.4}, {.4, 2.59, -.4}, {.4, 2.59, .4}, {-.4, 2.59, .4});
    scene.cameras.push_back({.name = "standing",
                             .eye = {-.7, 1.5, -2.6},
                             .target = {.1, 1.1, 2},
                             .vertical_fov_degrees = 55});
    scene.cameras.push_back({.name = "low",
                             .eye = {1.6, .25, -1.2},
                             .target = {-.2, 1.2, 3},
                             .vertical_fov_degrees = 60});
    return scene;
}

namespace {

const RegisteredBuiltInScene kFlatMirrorScene{
    {"flat", "closed room with one flat wall mirror", make_flat_room, 2}};

} // namespace

} // namespace catoptric::scene
