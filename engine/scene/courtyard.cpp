// An open court under a sky: a hollow dish that is a mirror, a ball, columns, a sun.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/pattern.hpp"
#include "scene/shapes.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace catoptric::scene {

namespace {

const dvec3 kDirectionToSun = glm::normalize(dvec3(-.5, .75, .45));

/// Returns the sky: blue above, haze at the horizon, ground below. The sun is a separate light.
std::shared_ptr<const Environment> make_sky() {
    auto sky = std::make_shared<Environment>();
    sky->name = "sky";
    sky->size = {64, 32};
    for (std::uint32_t row = 0; row < sky->size.y; ++row) {
        const double elevation = std::numbers::pi * (.5 - (row + .5) / sky->size.y);
        const double up = std::sin(elevation);
        for (std::uint32_t column = 0; column < sky->size.x; ++column) {
            const double angle = 2 * std::numbers::pi * ((column + .5) / sky->size.x - .5);
            const dvec3 way(std::sin(angle) * std::cos(elevation), up,
                            -std::cos(angle) * std::cos(elevation));
            const dvec3 blue = glm::mix(dvec3(.75, .82, .9), dvec3(.16, .32, .75),
                                        std::pow(std::max(up, 0.0), .6));
            const double glow = .6 * std::pow(std::max(dot(way, kDirectionToSun), 0.0), 6);
            sky->texels.push_back(
                vec3(up < 0 ? dvec3(.2, .18, .15) : blue + glow * dvec3(1, .85, .6)));
        }
    }
    return sky;
}

void add_columns(Scene& scene, std::size_t stone) {
    const Mesh column = lathe("column",
                              {{.28, 0},
                               {.28, .12},
                               {.28, .12},
                               {.2, .18},
                               {.18, 1.2},
                               {.15, 2.3},
                               {.26, 2.42},
                               {.26, 2.42},
                               {.26, 2.55},
                               {.26, 2.55},
                               {0, 2.55}},
                              24);
    for (int k = 0; k < 8; ++k) {
        dmat4 place(1);
        place[3] = dvec4(k % 2 ? 3 : -3, 0, 4 - 2.2 * (k / 2), 1);
        scene.objects.push_back({.name = "column " + std::to_string(k + 1),
                                 .mesh = scene.meshes.size(),
                                 .material = stone,
                                 .world_from_object = place});
    }
    scene.meshes.push_back(column);
}

/// Adds the dish. Its hollow side, up and to the front, is the mirror; its back is stone.
void add_mirror_dish(Scene& scene, std::size_t mirror, std::size_t stone) {
    std::vector<dvec2> hollow, back;
    for (int k = 16; k >= 0; --k) {
        const double r = k / 16.0;
        hollow.push_back({r, .4 * r * r});
        back.insert(back.begin(), dvec2(r, .4 * r * r - .04));
    }
    const double tilt = glm::radians(55.0);
    const dmat4 place(dvec4(1, 0, 0, 0), dvec4(0, std::cos(tilt), std::sin(tilt), 0),
                      dvec4(0, -std::sin(tilt), std::cos(tilt), 0), dvec4(-.9, 1.15, -1, 1));
    add_mesh(scene, lathe("dish", hollow, 64), mirror);
    scene.objects.back().world_from_object = place;
    add_mesh(scene, lathe("back of the dish", back, 64), stone);
    scene.objects.back().world_from_object = place;
    add_mesh(scene, box("foot", {-1.2, kSupportGap, -1.5}, {-.6, .7, -.9}), stone);
}

} // namespace

Scene make_courtyard() {
    Scene scene{.name = "courtyard"};
    const std::size_t paving = add_material(
        scene, {.name = "paving",
                .albedo = vec3(1),
                .albedo_texture = make_checker_texture({128, 112, 96}, {176, 164, 148}, 8)});
    const std::size_t brick = add_material(scene, {.name = "brick", .albedo = {.5f, .26f, .18f}});
    const std::size_t stone = add_material(
        scene, {.name = "stone", .albedo = {.68f, .64f, .56f}, .two_sided = true});
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    const std::size_t brass = add_material(
        scene, {.name = "brass", .albedo = {.9f, .72f, .38f}, .metallic = 1, .roughness = .02f});
    Mesh ground = quad("ground", {-5, 0, 6}, {5, 0, 6}, {5, 0, -6}, {-5, 0, -6});
    for (const dvec3& p : ground.positions) ground.uv[0].push_back(vec2(dvec2(p.x, p.z) / 4.0));
    add_mesh(scene, std::move(ground), paving);
    add_mesh(scene, box("back wall", {-5, 0, -6.3}, {5, 1.6, -6}), brick);
    add_mesh(scene, box("side wall", {-5.3, 0, -6}, {-5, 1, 6}), brick);
    add_columns(scene, stone);
    add_mirror_dish(scene, mirror, stone);
    add_ball(scene, "ball", mirror, {1.3, .7, .4}, .7, 5);
    add_mesh(scene, torus("brass ring", .5, .14, 48), brass);
    scene.objects.back().world_from_object[3] = dvec4(.2, .15, 1.7, 1);
    scene.objects.back().mirror = true;
    PunctualLight sun{
        .name = "sun", .kind = PunctualLight::Kind::directional, .intensity = {3.2f, 2.9f, 2.4f}};
    const dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), kDirectionToSun));
    sun.world_from_light = dmat4(dvec4(right, 0), dvec4(glm::cross(kDirectionToSun, right), 0),
                                 dvec4(kDirectionToSun, 0), dvec4(0, 0, 0, 1));
    scene.punctual.push_back(sun);
    scene.environment = make_sky();
    scene.cameras.push_back(
        {.name = "gate", .eye = {.4, 1.7, 6}, .target = {-.1, .8, 0}, .vertical_fov_degrees = 48});
    scene.cameras.push_back({.name = "corner",
                             .eye = {4.2, 3.2, 4.6},
                             .target = {-.3, .4, -.4},
                             .vertical_fov_degrees = 46});
    return scene;
}

namespace {

const RegisteredBuiltInScene kCourtyardScene{
    {"courtyard", "open court under a sky: hollow dish, ball and ring, sun", make_courtyard, 5}};

} // namespace

} // namespace catoptric::scene
