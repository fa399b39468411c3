// A room with balls and slanted slabs of metal, from nearly smooth to rough. It shows how the error
// of each look-up depends on roughness.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/pattern.hpp"
#include "scene/shapes.hpp"

#include <array>

namespace catoptric::scene {

namespace {

constexpr std::array<float, 6> kMirrorRoughnesses{.05f, .1f, .2f, .3f, .45f, .6f};
constexpr std::array<const char*, 6> kRoughnessLabels{"0.05", "0.1", "0.2", "0.3", "0.45", "0.6"};

/// Adds a slab that leans back against the air, so that it reflects floor and ceiling.
void add_slanted_slab(Scene& scene, const std::string& name, std::size_t material, dvec3 foot) {
    add_mesh(scene, box(name, {-.28, 0, -.02}, {.28, .9, .02}), material);
    const double slope = glm::radians(25.0);
    scene.objects.back().world_from_object = dmat4(
        dvec4(1, 0, 0, 0), dvec4(0, std::cos(slope), std::sin(slope), 0),
        dvec4(0, -std::sin(slope), std::cos(slope), 0), dvec4(foot, 1));
}

} // namespace

Scene make_roughness_room() {
    Scene scene{.name = "roughness"};
    scene.mirror_max_roughness = .6f;
    const auto [orange, blue] = add_papered_room(scene, {-3.2, 0, -3}, {3.2, 3, 3}, {58, 62, 70},
                                                 {205, 200, 190}, 5);
    for (std::size_t i = 0; i < kMirrorRoughnesses.size(); ++i) {
        const auto metal = [&](const char* what, vec3 colour) {
            return add_material(scene,
                                {.name = std::string(what) + " of roughness " + kRoughnessLabels[i],
                                 .albedo = colour,
                                 .metallic = 1,
                                 .roughness = kMirrorRoughnesses[i]});
        };
        const double x = .64 * (static_cast<double>(i) - 2.5);
        // The third ball has the colour of copper.
        const std::size_t material = metal("metal", i == 2 ? vec3(.95f, .64f, .54f) : vec3(.92f));
        add_ball(scene, std::string("ball ") + kRoughnessLabels[i], material, {x, .29, -.4}, .28,
                 5);
        add_slanted_slab(scene, std::string("slab ") + kRoughnessLabels[i],
                         metal("slab", vec3(.9f)), {x, kSupportGap, .9});
    }
    scene.objects[scene.objects.size() - 6].motion = HarmonicMotion{.amplitude = {0, 0, .25},
                                                                    .period = 4};
    Texture worn = make_checker_texture({0, 40, 255}, {0, 140, 255}, 4);
    worn.srgb = false;
    const std::size_t plate = add_material(scene, {.name = "worn metal",
                                                   .albedo = vec3(.9f),
                                                   .metallic = 1,
                                                   .roughness = 1,
                                                   .roughness_texture = worn});
    add_mesh(scene, box("worn plate", {-.9, .01, -1.5}, {.9, .06, -.9}), plate);
    add_mesh(scene, box("post", {2.5, kSupportGap, -1.6}, {2.8, 1.4, -1.3}), orange);
    add_mesh(scene, box("block", {-2.9, kSupportGap, -1.8}, {-2.4, .6, -1.3}), blue);
    add_quad(scene, "lamp", add_material(scene, {.name = "lamp", .emission = {22, 20, 17}}),
             {-.5, 2.99, -.9}, {.5, 2.99, -.9}, {.5, 2.99, .1}, {-.5, 2.99, .1});
    scene.cameras.push_back(
        {.name = "row", .eye = {0, 1.35, -2.9}, .target = {0, .5, .2}, .vertical_fov_degrees = 58});
    scene.cameras.push_back({.name = "side",
                             .eye = {-2.3, 1, -2.2},
                             .target = {.4, .5, .5},
                             .vertical_fov_degrees = 55});
    return scene;
}

namespace {

const RegisteredBuiltInScene kRoughnessScene{
    {"roughness", "room with balls and slabs of metal, of roughness 0.05 to 0.6",
     make_roughness_room, 6}};

} // namespace

} // namespace catoptric::scene
