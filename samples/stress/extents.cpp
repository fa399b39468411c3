// Stress properties of scenes with objects of very different sizes: the visible object must keep
// its precision.
#include "scene/build.hpp"
#include "stress/double_tracer.hpp"
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

namespace catoptric::stress {

namespace {

constexpr const char* kComparedTechniques[] = {"raytrace", "parallax", "pyramid"};
constexpr double kMaxEqualFlip = .001; // largest FLIP of pictures that count as equal

/// Judges a triangle of edge 1 far outside the room. The picture must not change.
void judge_stray_triangle(Bench& bench) {
    const scene::Scene scene = make_room(bench, 3);
    for (const char* technique : kComparedTechniques) {
        const session::TechniqueResult plain = bench.render_technique(scene, technique);
        for (const double distance : {1e2, 1e4, 1e6, 1e9}) {
            scene::Scene with = scene;
            const dvec3 at(distance, 0, distance);
            add_mesh(with,
                     {.name = "stray",
                      .positions = {at, at + dvec3(1, 0, 0), at + dvec3(0, 1, 0)},
                      .normals = std::vector<vec3>(3, vec3(0, 0, 1)),
                      .triangles = {{0, 1, 2}}},
                     0);
            bench.add_flip(fmt::format("{}, a triangle {} away", technique, distance),
                           bench.render_technique(with, technique), plain, kMaxEqualFlip);
        }
    }
}

/// Judges a grey sky, which must look the same at a distance of 100 and of a million.
void judge_distant_sky(Bench& bench) {
    const scene::Scene scene = make_room(bench, 3);
    const auto under = [&](double radius) {
        scene::Scene with = scene;
        const std::size_t grey = add_material(with, {.name = "sky", .albedo = {.5f, .5f, .5f}});
        scene::Mesh sky = scene::ball("sky", 4);
        for (dvec3& position : sky.positions) position *= radius;
        add_mesh(with, sky, grey);
        return with;
    };
    const scene::Scene near = under(1e2), far = under(1e6);
    for (const char* technique : kComparedTechniques)
        bench.add_flip(fmt::format("{}, sky 1e6 away", technique),
                       bench.render_technique(far, technique),
                       bench.render_technique(near, technique), kMaxEqualFlip);
}

/// Judges the room on a ground 1e6 wide against one 1e3 wide. Positions on such a large triangle
/// are rounded in proportion to its size, for rays as for rasterisation. The difference therefore
/// counts as quality.
void judge_large_ground(Bench& bench) {
    const scene::Scene scene = make_room(bench, 3);
    const double y = scene::bounds(scene).lo.y - .01;
    const auto on = [&](double half) {
        scene::Scene with = scene;
        add_quad(with, 0, {-half, y, -half}, {-half, y, half}, {half, y, half}, {half, y, -half});
        return with;
    };
    const scene::Scene narrow = on(5e2), wide = on(5e5);
    for (const char* technique : kComparedTechniques)
        bench.add_flip(fmt::format("{}, ground 1e6 wide", technique),
                       bench.render_technique(wide, technique),
                       bench.render_technique(narrow, technique), kMaxEqualFlip,
                       "edges on the wide ground may move by its rounding, .03 units");
}

/// Judges a ball of 1e-3 off the centre of a room of 1e3, seen from close by.
void judge_tiny_ball(Bench& bench) {
    scene::Scene scene = transform_scene(make_room(bench, 0), scale_matrix(250));
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    const dvec3 centre(bench.random(-300, 300), bench.random(-300, 300), bench.random(-300, 300));
    add_ball(scene, mirror, {centre, 1e-3});
    scene.cameras = {
        {.eye = centre + dvec3(1e-3, 2e-3, -6e-3), .target = centre, .vertical_fov_degrees = 30}};
    const session::Request request = bench.make_request(scene, "raytrace:sphere=exact");
    const DoubleTracer tracer(scene, request.ambient);
    session::TechniqueResult wanted;
    wanted.hdr = measure::Picture(static_cast<int>(request.size.x),
                                  static_cast<int>(request.size.y));
    for (std::uint32_t y = 0; y < request.size.y; ++y)
        for (std::uint32_t x = 0; x < request.size.x; ++x)
            wanted.hdr.at(static_cast<int>(x), static_cast<int>(y)) = vec3(
                tracer.trace_pixel(request.camera, request.size, x, y, 8));
    wanted.display = measure::to_display(wanted.hdr, request.exposure);
    bench.add_flip("a ball of 1e-3 in a room of 1e3, raytrace:sphere=exact against doubles",
                   bench.render_technique(request), wanted, kMaxEqualFlip);
    const scene::Scene shifted = transform_scene(scene, translation_matrix(-centre));
    for (const char* technique : kComparedTechniques)
        bench.add_flip(
            fmt::format("{}, a ball of 1e-3 in a room of 1e3, against the same about 0", technique),
            bench.render_technique(scene, technique), bench.render_technique(shifted, technique),
            kMaxEqualFlip);
}

void judge_scene_extents(Bench& bench) {
    judge_stray_triangle(bench);
    judge_distant_sky(bench);
    judge_large_ground(bench);
    judge_tiny_ball(bench);
}

const RegisteredProperty kSceneExtentsProperty{
    {"N5", "a stray triangle to 1e9 away, a sky and a ground of 1e6, a ball of 1e-3 in 1e3",
     "the objects in view keep precision (FLIP)", judge_scene_extents, "core_is_everything"}};

} // namespace

} // namespace catoptric::stress
