// Lights where nobody would put them, pictures and scenes of no or enormous size.
#include "stress/property.hpp"
#include "stress/scenes.hpp"


#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

/// The room with its lamp's four corners moved by `place`.
scene::Scene with_lamp(scene::Scene scene, const std::function<dvec3(dvec3)>& place) {
    for (const scene::Object& object : scene.objects)
        if (scene.materials[object.material].emission != vec3(0))
            for (dvec3& corner : scene.meshes[object.mesh].positions) corner = place(corner);
    return scene;
}

void judge_light(Bench& bench) {
    const scene::Scene scene = room(bench, 2);
    dvec3 ball(0), lamp(0);
    for (const scene::Object& object : scene.objects) {
        if (object.sphere) ball = object.sphere->centre;
        if (scene.materials[object.material].emission != vec3(0)) lamp = scene.meshes[object.mesh].positions[0];
    }
    const double ceiling = scene::bounds(scene).hi.y;
    const auto flat = [](dvec3 p, double y) { return dvec3(p.x, y, p.z); };
    const std::pair<const char*, scene::Scene> places[] = {
        {"inside a ball", with_lamp(scene, [&](dvec3 p) { return ball + (p - lamp) * .05; })},
        {"on the ceiling's plane", with_lamp(scene, [&](dvec3 p) { return flat(p, ceiling); })},
        {"at the camera", with_lamp(scene, [&](dvec3 p) { return scene.cameras.front().eye + (p - lamp - dvec3(.5, 0, .5)) * .1; })}};
    for (const auto& [what, moved] : places)
        for (const std::string technique : {"raytrace", "parallax"}) bench.add_nonfinite(std::string(what) + ", " + technique, bench.render(moved, technique));
    // Above the ceiling and turned upwards: what is left is the ambient term alone.
    scene::Scene away = with_lamp(scene, [&](dvec3 p) { return flat(p, ceiling + 1); });
    for (const scene::Object& object : away.objects)
        if (away.materials[object.material].emission != vec3(0))
            for (vec3& normal : away.meshes[object.mesh].normals) normal = -normal;
    scene::Scene dark = away;
    for (const scene::Object& object : dark.objects)
        if (dark.materials[object.material].emission != vec3(0)) dark.materials[object.material].emission = vec3(0);
    for (const std::string technique : {"raytrace", "reuse"}) {
        const app::Part a = bench.render(away, technique), b = bench.render(dark, technique);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < a.hdr.pixels.size(); ++i) differ += a.hdr.pixels[i] != b.hdr.pixels[i] && a.hdr.pixels[i].x < 1; // the lamp itself may be seen
        bench.add("facing away, " + technique + ": lit pixels", double(differ), 0);
    }
}

void judge_shadow_map(Bench& bench) {
    for (const double factor : {1e-6, 1.0, 1e6})
        for (const int edge : {1, 16, 1024}) {
            const scene::Scene scene = through(plane(), scaled(factor));
            const auto render = [&](const std::string& technique) {
                app::Request request = bench.asked(scene, technique, 1);
                request.ambient = 0; // what is not black is lit by the lamp
                return bench.render(request);
            };
            const app::Part with = render(fmt::format("reuse:shadow_map={}", edge)), without = render("reuse:shadow=none");
            std::size_t lit = 0, judged = 0;
            for (std::size_t i = 0; i < with.hdr.pixels.size(); ++i) {
                if (!(without.hdr.pixels[i].x > 0)) continue;
                ++judged;
                lit += with.hdr.pixels[i].x >= .999f * without.hdr.pixels[i].x;
            }
            bench.add(fmt::format("edge {}, times {}: less than a tenth of the picture is lit", edge, factor), judged * 10 < with.hdr.pixels.size() ? 1 : 0, 0);
            bench.add(fmt::format("edge {}, times {}: plane in shadow of itself", edge, factor), 1 - double(lit) / double(judged), .005);
        }
}

void judge_sizes(Bench& bench) {
    const scene::Scene scene = room(bench, 1);
    for (const uvec2 size : {uvec2(1, 1), uvec2(1, 16384), uvec2(16384, 1)})
        for (const std::string technique : {"raytrace", "parallax:face=32"}) {
            app::Request request = bench.asked(scene, technique, 2);
            request.size = size;
            bench.add_nonfinite(fmt::format("{}x{}, {}", size.x, size.y, technique), bench.render(request));
        }
    for (const uvec2 size : {uvec2(0, 0), uvec2(0, 7)})
        bench.add_refused(fmt::format("{}x{}", size.x, size.y), Failure::usage, [&] {
            app::Request request = bench.asked(scene, "raytrace");
            request.size = size;
            bench.render(request);
        });
    bench.add_refused("65536x65536", Failure::exhausted, [&] {
        app::Request request = bench.asked(scene, "raytrace");
        request.size = {65536, 65536};
        bench.engine().plan(request, app::PlanFormat::json);
    });
}

void judge_triangles(Bench& bench) {
    scene::Scene empty{.name = "empty"};
    empty.cameras.push_back({.eye = {0, 0, -3}, .target = {0, 0, 0}});
    scene::Scene one = empty, many = empty;
    const std::size_t hot = add_material(one, {.name = "hot", .emission = vec3(1)});
    one.meshes.push_back({"triangle", {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}}, {{0, 1, 2}}});
    one.objects.push_back({.name = "triangle", .mesh = 0, .material = hot});
    add_ball(many, add_material(many, {.name = "hot", .emission = vec3(1)}), {{0, 0, 0}, 1}, 9); // 4^10
    for (const std::string technique : {"raytrace", "parallax"}) {
        const auto sum = [&](const scene::Scene& scene, const std::string& what) {
            const app::Part part = bench.render(scene, technique, 2);
            bench.add_nonfinite(what + ", " + technique, part);
            double bright = 0;
            for (const vec3& pixel : part.hdr.pixels) bright += pixel.x > .5f;
            return bright / double(part.hdr.pixels.size());
        };
        bench.add("empty, " + technique + ": pixels that are not background", sum(empty, "empty"), 0);
        bench.add("one triangle, " + technique + ": not seen", sum(one, "one triangle") > .1 ? 0 : 1, 0);
    }
    const app::Part part = bench.render(many, "raytrace", 1);
    bench.add_nonfinite("1,048,576 triangles, raytrace", part);
}

const Row kLight{{"L1", "light inside a ball, on the ceiling, at the camera, facing away", "finite; unlit where it faces away", judge_light}};
const Row kShadowMap{{"L2", "shadow map edge 1, 16, 1024; scene times 1e-6, 1, 1e6", "no acne on an open plane", judge_shadow_map}};
const Row kSizes{{"Z1", "picture 1x1, 1x16384, 16384x1, 0x0, 65536x65536", "works, or is refused with the limit", judge_sizes}};
const Row kTriangles{{"Z2", "empty scene, one triangle, a million", "background; finite", judge_triangles, {}, "ten million triangles, and build time"}};

} // namespace

} // namespace catoptric::stress
