// Built-in scene: a room with a ball, a pane, a lens and a bottle of glass. It shows how far each
// model of refraction is from ray tracing.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"

#include <cmath>

namespace catoptric::scene {

namespace {

/// Returns a lens around the y axis with two spherical faces. `radius`: radius of the rim. `half`:
/// half of the thickness.
Mesh make_lens(std::string name, double radius, double half) {
    constexpr int kSteps = 12; // points of each face from the middle to the rim
    const double curvature = (radius * radius + half * half) / (2 * half); // radius of the faces
    std::vector<dvec2> profile;
    for (const double side : {-1., 1.})
        for (int i = 0; i <= kSteps; ++i) {
            const double share = side < 0 ? double(i) / kSteps : 1 - double(i) / kSteps;
            const double r = radius * share;
            profile.emplace_back(
                r, side * (half - curvature + std::sqrt(curvature * curvature - r * r)));
        }
    return lathe(std::move(name), profile, 64);
}

/// Returns an empty bottle that stands on the origin, with a wall of `wall` metres.
Mesh make_bottle(std::string name, double wall) {
    const double out = .17, neck = .05, shoulder = .5, throat = .68, top = .85;
    return lathe(std::move(name),
                 {{0, 0},
                  {out, 0},
                  {out, 0},
                  {out, shoulder},
                  {.7 * out, shoulder + .09},
                  {neck, throat},
                  {neck, top},
                  {neck, top},
                  {neck - wall, top},
                  {neck - wall, top},
                  {neck - wall, throat},
                  {.7 * out - wall, shoulder + .08},
                  {out - wall, shoulder},
                  {out - wall, wall},
                  {out - wall, wall},
                  {0, wall}},
                 64);
}

Scene make_glass_room() {
    Scene scene{.name = "glass"};
    const auto [orange, blue] = add_papered_room(scene, {-2.6, 0, -3}, {2.6, 2.6, 2.4},
                                                 {70, 62, 56}, {205, 200, 190}, 4);
    const auto glass = [&](const char* name, float ior, vec3 absorption) {
        const float root = (ior - 1) / (ior + 1);
        return add_material(scene, {.name = name,
                                    .albedo = vec3(1),
                                    .roughness = 0,
                                    .dielectric_f0 = vec3(root * root),
                                    .dielectric_f90 = vec3(1),
                                    .transmission = 1,
                                    .ior = ior,
                                    .solid = true,
                                    .absorption = absorption});
    };
    add_mesh(scene, ball("glass ball", 5), glass("crown glass", 1.52f, vec3(0)));
    scene.objects.back().world_from_object = dmat4(dvec4(.34, 0, 0, 0), dvec4(0, .34, 0, 0),
                                                   dvec4(0, 0, .34, 0), dvec4(-1, .35, .1, 1));
    add_mesh(scene, box("pane", {.1, kSupportGap, .3}, {1, 1, .33}),
             glass("window glass", 1.5f, {2.f, .6f, 1.2f}));
    add_mesh(scene, make_lens("lens", .36, .12), glass("flint glass", 1.62f, vec3(0)));
    scene.objects.back().world_from_object = dmat4(dvec4(1, 0, 0, 0), dvec4(0, 0, 1, 0),
                                                   dvec4(0, -1, 0, 0), dvec4(-.3, .4, -.5, 1));
    add_mesh(scene, make_bottle("bottle", .012), glass("bottle glass", 1.5f, {9.f, 2.5f, 7.f}));
    scene.objects.back().world_from_object[3] = dvec4(1.35, kSupportGap, -.4, 1);
    add_ball(scene, "mirror ball",
             add_material(scene, {.name = "mirror", .mirror = true, .reflectance = vec3(.9f)}),
             {.45, .3, 1.3}, .3, 5);
    add_mesh(scene, box("block", {-1.9, kSupportGap, 1.1}, {-1.4, .8, 1.6}), orange);
    add_mesh(scene, box("post", {1.6, kSupportGap, 1.2}, {1.8, 1.5, 1.4}), blue);
    add_quad(scene, "lamp", add_material(scene, {.name = "lamp", .emission = {20, 18, 15}}),
             {-.5, 2.59, -.8}, {.5, 2.59, -.8}, {.5, 2.59, .2}, {-.5, 2.59, .2});
    scene.cameras.push_back({.name = "row",
                             .eye = {.1, 1.05, -2.7},
                             .target = {.1, .4, .4},
                             .vertical_fov_degrees = 50});
    scene.cameras.push_back({.name = "side",
                             .eye = {-2.2, .9, -1.7},
                             .target = {.3, .4, .4},
                             .vertical_fov_degrees = 50});
    return scene;
}

const RegisteredBuiltInScene kGlassScene{
    {"glass", "room with a ball, a pane, a lens and a bottle of glass", make_glass_room, 7}};

} // namespace

} // namespace catoptric::scene
