// A hall with sixteen mirrors of different shape and size, through which the camera walks.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/motion.hpp"
#include "scene/pattern.hpp"
#include "scene/shapes.hpp"

#include <array>

namespace catoptric::scene {

namespace {

constexpr double kGalleryLength = 14;

/// Mirror on a plinth of height `plinth`: a mesh or a ball.
struct Exhibit {
    const char* name;
    dvec3 at; ///< position of the plinth's foot
    double plinth, size;
    enum { ball, box, vase, ring, bell, drum } shape;
};
constexpr std::array<Exhibit, 12> kExhibits{{
    {"large ball", {-1.3, 0, 1.8}, .4, .45, Exhibit::ball},
    {"ring", {1.3, 0, 2.6}, .9, .3, Exhibit::ring},
    {"cube", {-1.4, 0, 3.8}, .8, .3, Exhibit::box},
    {"small ball", {1.4, 0, 4.5}, 1.1, .15, Exhibit::ball},
    {"vase", {-1.3, 0, 5.7}, .7, .45, Exhibit::vase},
    {"bell", {1.3, 0, 6.4}, .8, .4, Exhibit::bell},
    {"drum", {-1.4, 0, 7.6}, .5, .35, Exhibit::drum},
    {"huge ball", {1.2, 0, 8.6}, .1, .7, Exhibit::ball},
    {"second ring", {-1.3, 0, 9.6}, 1, .4, Exhibit::ring},
    {"marble", {1.4, 0, 10.4}, 1.2, .06, Exhibit::ball},
    {"second vase", {-1.3, 0, 11.5}, .6, .6, Exhibit::vase},
    {"block", {1.3, 0, 12.2}, .3, .5, Exhibit::box},
}};

Mesh make_exhibit_mesh(const Exhibit& exhibit) {
    switch (exhibit.shape) {
    case Exhibit::box: return box(exhibit.name, {-.7, -1, -.7}, {.7, 1, .7});
    case Exhibit::vase:
        return lathe(exhibit.name,
                     {{0, -1},
                      {.3, -1},
                      {.3, -1},
                      {.55, -.6},
                      {.62, -.2},
                      {.5, .25},
                      {.28, .6},
                      {.24, .8},
                      {.4, 1},
                      {.4, 1},
                      {0, 1}},
                     48);
    case Exhibit::bell:
        return lathe(exhibit.name,
                     {{0, -1},
                      {.9, -1},
                      {.9, -1},
                      {.7, -.7},
                      {.55, -.2},
                      {.5, .3},
                      {.42, .7},
                      {.25, .93},
                      {0, 1}},
                     48);
    case Exhibit::drum:
        return lathe(exhibit.name, {{0, -1}, {.6, -1}, {.6, -1}, {.6, 1}, {.6, 1}, {0, 1}}, 48);
    default: return torus(exhibit.name, 1, .35, 48);
    }
}

void add_exhibit(Scene& scene, const Exhibit& exhibit, std::size_t stone, std::size_t mirror) {
    const double half = .8 * std::max(exhibit.size, .2);
    Mesh plinth = box(std::string("plinth of ") + exhibit.name,
                      exhibit.at + dvec3(-half, kSupportGap, -half),
                      exhibit.at + dvec3(half, exhibit.plinth, half));
    for (vec2& uv : plinth.uv[0]) uv *= 2;
    add_mesh(scene, std::move(plinth), stone);
    // The exhibit stands just above the plinth, so that no surfaces touch.
    const double low = exhibit.shape == Exhibit::ring ? .35 : 1;
    const dvec3 centre = exhibit.at + dvec3(0, exhibit.plinth + exhibit.size * low + .01, 0);
    if (exhibit.shape == Exhibit::ball)
        return add_ball(scene, exhibit.name, mirror, centre, exhibit.size, 4);
    add_mesh(scene, make_exhibit_mesh(exhibit), mirror);
    dmat4 place(exhibit.size);
    place[3] = dvec4(centre, 1);
    scene.objects.back().world_from_object = place;
}

/// Adds the mirrors on the walls: two panels, a tall panel, and a dish that faces down the hall.
void add_wall_mirrors(Scene& scene, std::size_t mirror) {
    add_quad(scene, "left panel", mirror, {-2.48, .8, 4.2}, {-2.48, .8, 2.2}, {-2.48, 2.4, 2.2},
             {-2.48, 2.4, 4.2});
    add_quad(scene, "right panel", mirror, {2.48, .8, 6.8}, {2.48, .8, 8.8}, {2.48, 2.4, 8.8},
             {2.48, 2.4, 6.8});
    add_quad(scene, "tall panel", mirror, {-2.48, .1, 10.6}, {-2.48, .1, 9.8}, {-2.48, 2.8, 9.8},
             {-2.48, 2.8, 10.6});
    std::vector<dvec2> bowl; // the outside of the profile is the inside of the bowl
    for (int k = 12; k >= 0; --k) bowl.push_back({k / 12.0, .35 * (k / 12.0) * (k / 12.0)});
    add_mesh(scene, lathe("dish", bowl, 48), mirror);
    // The dish's axis, +y, turns to -z.
    scene.objects.back().world_from_object = dmat4(dvec4(1, 0, 0, 0), dvec4(0, 0, -1, 0),
                                                   dvec4(0, 1, 0, 0),
                                                   dvec4(0, 1.7, kGalleryLength - .05, 1));
}

/// Returns a walk to the far end and back in twelve seconds, slow at the turns.
RigAttachment make_camera_walk() {
    NodeRig rig{.repeats = true};
    const TranslationTrack keys{.interpolation = Interpolation::cubic,
                                .times = {0, 6, 12},
                                .values = {{0, 0, 0}, {.3, 0, kGalleryLength - 5}, {0, 0, 0}},
                                .in_tangents = {{}, {}, {}},
                                .out_tangents = {{}, {}, {}}};
    rig.nodes.push_back({.translations = std::make_shared<const TranslationTrack>(keys)});
    return {.rig = std::make_shared<const NodeRig>(std::move(rig))};
}

} // namespace

Scene make_gallery() {
    Scene scene{.name = "gallery"};
    const std::size_t floor = add_material(
        scene, {.name = "floor",
                .albedo = vec3(1),
                .albedo_texture = make_checker_texture({70, 62, 58}, {196, 190, 180}, 8)});
    const std::size_t wall_paint = add_material(scene,
                                                {.name = "wall", .albedo = {.55f, .24f, .2f}});
    const std::size_t ceiling = add_material(scene, {.name = "ceiling", .albedo = vec3(.78f)});
    const std::size_t stone = add_material(scene,
                                           {.name = "stone",
                                            .albedo = vec3(1),
                                            .albedo_texture = make_cloth_texture({188, 184, 172})});
    const std::size_t lamp = add_material(scene, {.name = "lamp", .emission = {15, 14, 12}});
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    const dvec3 lo(-2.5, 0, 0), hi(2.5, 3.2, kGalleryLength);
    for (const int face : {0, 1, 4, 5}) add_mesh(scene, make_box_wall(face, lo, hi), wall_paint);
    add_mesh(scene, make_box_wall(2, lo, hi), ceiling);
    Mesh ground = make_box_wall(3, lo, hi);
    for (const dvec3& p : ground.positions) ground.uv[0].push_back(vec2(dvec2(p.x, p.z) / 2.0));
    add_mesh(scene, std::move(ground), floor);
    for (const Exhibit& exhibit : kExhibits) add_exhibit(scene, exhibit, stone, mirror);
    add_wall_mirrors(scene, mirror);
    for (const double z : {2.5, 7.0, 11.5})
        add_quad(scene, "lamp", lamp, {-.5, 3.19, z - .5}, {.5, 3.19, z - .5}, {.5, 3.19, z + .5},
                 {-.5, 3.19, z + .5});
    scene.cameras.push_back({.name = "visitor",
                             .eye = {0, 1.6, .6},
                             .target = {0, 1.3, 5},
                             .vertical_fov_degrees = 62,
                             .follows = make_camera_walk()});
    scene.cameras.push_back({.name = "from the end",
                             .eye = {1.9, 2.6, 13.4},
                             .target = {-.4, 1, 9},
                             .vertical_fov_degrees = 62});
    return scene;
}

namespace {

const RegisteredBuiltInScene kGalleryScene{
    {"gallery",
     "hall with sixteen mirrors of different shape and size; the "
     "camera walks",
     make_gallery, 4}};

} // namespace

} // namespace catoptric::scene
