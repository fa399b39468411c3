#include "stress/scenes.hpp"

#include "scene/build.hpp"
#include "scene/shapes.hpp"

#include <cmath>

namespace catoptric::stress {

namespace {

bool is_apart(const scene::Scene& scene, const MirrorBall& ball) {
    for (const scene::Object& object : scene.objects)
        if (object.sphere &&
            length(object.sphere->centre - ball.centre) < object.sphere->radius + ball.radius + .05)
            return false;
    return true;
}

} // namespace

void add_quad(scene::Scene& scene, std::size_t material, dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    scene::add_quad(scene, "quad" + std::to_string(scene.objects.size()), material, a, b, c, d);
}

void add_ball(scene::Scene& scene, std::size_t material, const MirrorBall& ball, int levels) {
    scene::add_ball(scene, "ball" + std::to_string(scene.objects.size()), material, ball.centre,
                    ball.radius, levels);
}

scene::Scene make_room(Bench& bench, int balls) {
    scene::Scene scene{.name = "room"};
    const auto colour = [&] {
        return vec3(bench.random(.1, .8), bench.random(.1, .8), bench.random(.1, .8));
    };
    const dvec3 hi(bench.random(1.8, 2.2), bench.random(1.6, 2.0), bench.random(1.8, 2.4)),
        lo = -hi;
    for (int face = 0; face < 5; ++face)
        add_mesh(scene, scene::make_box_wall(face, lo, hi),
                 add_material(scene, {.name = "wall", .albedo = colour()}));
    const std::size_t lamp = add_material(scene, {.name = "lamp", .emission = vec3(6, 5, 4)});
    const double x = bench.random(-.5, .5), z = bench.random(-.5, .5), y = hi.y - .01;
    add_quad(scene, lamp, {x - .5, y, z - .5}, {x + .5, y, z - .5}, {x + .5, y, z + .5},
             {x - .5, y, z + .5});
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    for (int made = 0; made < balls;) {
        const double radius = bench.random(.2, .5);
        const MirrorBall ball{{bench.random(lo.x + radius + .05, hi.x - radius - .05),
                               lo.y + radius + bench.random(.01, .6),
                               bench.random(lo.z + radius + .05, hi.z - radius - .05)},
                              radius};
        if (!is_apart(scene, ball)) continue;
        add_ball(scene, mirror, ball);
        ++made;
    }
    scene.cameras.push_back({.eye = {bench.random(-.4, .4), bench.random(-.3, .3), lo.z - 4},
                             .target = {0, -.3, 0},
                             .vertical_fov_degrees = 42});
    return scene;
}

scene::Scene make_white_furnace(const std::vector<MirrorBall>& balls) {
    scene::Scene scene{.name = "furnace"};
    const std::size_t hot = add_material(scene, {.name = "hot", .emission = vec3(1)});
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, scene::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), hot);
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    for (const MirrorBall& ball : balls) add_ball(scene, mirror, ball);
    scene.cameras.push_back(
        {.eye = {.2, .1, -4.5}, .target = {0, 0, 1}, .vertical_fov_degrees = 50});
    return scene;
}

scene::Scene make_plane_with_lamp() {
    scene::Scene scene{.name = "plane"};
    add_quad(scene, add_material(scene, {.name = "grey", .albedo = vec3(.7f)}), {-10, 0, -10},
             {-10, 0, 10}, {10, 0, 10}, {10, 0, -10});
    add_quad(scene, add_material(scene, {.name = "lamp", .emission = vec3(40)}), {-.2, 4, -.2},
             {.2, 4, -.2}, {.2, 4, .2}, {-.2, 4, .2});
    scene.cameras.push_back({.eye = {0, 3, -9}, .target = {0, 0, 0}, .vertical_fov_degrees = 50});
    return scene;
}

scene::Scene transform_scene(const scene::Scene& scene, const dmat4& root) {
    scene::Scene result = scene;
    const double factor = std::cbrt(std::abs(determinant(dmat3(root))));
    const auto point = [&](dvec3 p) { return dvec3(root * dvec4(p, 1)); };
    for (scene::Object& object : result.objects) {
        object.world_from_object = root * object.world_from_object;
        if (object.sphere)
            object.sphere = scene::Sphere{point(object.sphere->centre),
                                          object.sphere->radius * factor};
        if (auto* swing = std::get_if<scene::HarmonicMotion>(&object.motion))
            swing->amplitude = dmat3(root) * swing->amplitude;
    }
    for (scene::Camera& camera : result.cameras) {
        camera.eye = point(camera.eye);
        camera.target = point(camera.target);
        camera.up = normalize(dmat3(root) * camera.up);
    }
    return result;
}

dmat4 scale_matrix(double factor) {
    dmat4 matrix(factor);
    matrix[3][3] = 1;
    return matrix;
}

dmat4 translation_matrix(dvec3 by) {
    dmat4 matrix(1);
    matrix[3] = dvec4(by, 1);
    return matrix;
}

dmat4 rotation_matrix(double radians, dvec3 axis) {
    const dvec3 n = normalize(axis);
    const double c = std::cos(radians), s = std::sin(radians);
    dmat4 matrix(1);
    for (int column = 0; column < 3; ++column) {
        dvec3 e(0);
        e[column] = 1;
        matrix[column] = dvec4(c * e + s * cross(n, e) + (1 - c) * dot(n, e) * n, 0);
    }
    return matrix;
}

} // namespace catoptric::stress
