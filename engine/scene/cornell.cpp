#include "scene/build.hpp"
#include "scene/built_in.hpp"

namespace catoptric::scene {

namespace {

enum : std::size_t { kWhite, kGreen, kRed, kLight, kMirror };

std::vector<Material> make_cornell_materials() {
    return {{.name = "white", .albedo = {0.725f, 0.71f, 0.68f}},
            {.name = "green", .albedo = {0.14f, 0.45f, 0.091f}},
            {.name = "red", .albedo = {0.63f, 0.065f, 0.05f}},
            {.name = "light", .emission = {17, 12, 4}},
            {.name = "mirror", .mirror = true}};
}

void add_scaled_ball(Scene& scene, const std::string& name, std::size_t mesh, dvec3 centre,
                     double radius) {
    dmat4 world_from_object(radius);
    world_from_object[3] = dvec4(centre, 1);
    scene.objects.push_back({.name = name,
                             .mesh = mesh,
                             .material = kMirror,
                             .world_from_object = world_from_object,
                             .sphere = Sphere{centre, radius}});
}

/// Adds the walls of the measured box. The left wall is 3.2 units off the plane at the floor's back
/// corner, as published.
void add_cornell_walls(Scene& scene) {
    add_quad(scene, "floor", kWhite, //
             {552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2});
    add_quad(scene, "ceiling", kWhite, //
             {556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0});
    add_quad(scene, "back", kWhite, //
             {549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2});
    add_quad(scene, "right", kGreen, //
             {0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2});
    add_quad(scene, "left", kRed, //
             {552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0});
    add_quad(scene, "light", kLight, //
             {343, 548.7, 227}, {343, 548.7, 332}, {213, 548.7, 332}, {213, 548.7, 227});
}

} // namespace

Scene make_cornell() {
    Scene scene{.name = "cornell-mirrors", .materials = make_cornell_materials(), .exposure = 0};
    add_cornell_walls(scene);
    const std::size_t unit_ball = scene.meshes.size();
    scene.meshes.push_back(ball("ball", 5));
    add_scaled_ball(scene, "ball1", unit_ball, {445, 73, 320}, 72);
    add_scaled_ball(scene, "ball2", unit_ball, {90, 100, 110}, 72);
    add_scaled_ball(scene, "ball3", unit_ball, {190, 113, 410}, 110);
    add_scaled_ball(scene, "ball4", unit_ball, {500, 80, 210}, 36);
    scene.objects.back().motion = HarmonicMotion{.amplitude = {0, 50, 0}, .period = 4};
    scene.cameras.push_back({.name = "contract",
                             .eye = {278, 273, -800},
                             .target = {278, 273, 0},
                             .vertical_fov_degrees = 37.5});
    return scene;
}

Scene make_closed_cornell() {
    Scene scene = make_cornell();
    scene.name = "cornell-mirrors-closed";
    add_quad(scene, "front", kWhite, {0, 0, 0}, {552.8, 0, 0}, {556, 548.8, 0}, {0, 548.8, 0});
    scene.objects.back().seen_by_camera = false;
    return scene;
}

Scene make_rough_cornell() {
    Scene scene = make_cornell();
    scene.name = "cornell-rough";
    scene.mirror_max_roughness = .6f;
    const std::pair<float, const char*> balls[] = {
        {.05f, "0.05"}, {.15f, "0.15"}, {.3f, "0.3"}, {.5f, "0.5"}};
    for (std::size_t i = 0; i < std::size(balls); ++i) {
        const auto& [roughness, text] = balls[i];
        scene.objects[scene.objects.size() - std::size(balls) + i].material = add_material(
            scene, {.name = std::string("metal of roughness ") + text,
                    .albedo = vec3(.95f),
                    .metallic = 1,
                    .roughness = roughness});
    }
    return scene;
}

namespace {

const RegisteredBuiltInScene kOpenCornellScene{
    {"cornell-mirrors", "Cornell box with four mirror balls, one of them moving; front open",
     make_cornell, 0}};
const RegisteredBuiltInScene kClosedCornellScene{
    {"cornell-mirrors-closed",
     "Cornell box with four mirror balls, and a white front wall that camera rays ignore",
     make_closed_cornell, 1}};
const RegisteredBuiltInScene kRoughCornellScene{
    {"cornell-rough", "Cornell box with four metal balls of roughness 0.05 to 0.5",
     make_rough_cornell, 7}};

} // namespace

} // namespace catoptric::scene
