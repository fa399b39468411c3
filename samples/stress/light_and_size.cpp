// Stress properties of lights in extreme places, and of pictures and scenes of size zero or of
// enormous size.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

namespace catoptric::stress {

namespace {

/// Returns the scene with the corners of its lamp moved by `place`.
scene::Scene move_lamp_corners(scene::Scene scene, const std::function<dvec3(dvec3)>& place) {
    for (const scene::Object& object : scene.objects)
        if (scene.materials[object.material].emission != vec3(0))
            for (dvec3& corner : scene.meshes[object.mesh].positions) corner = place(corner);
    return scene;
}

void judge_lamp_position(Bench& bench) {
    const scene::Scene scene = make_room(bench, 2);
    dvec3 ball(0), lamp(0);
    for (const scene::Object& object : scene.objects) {
        if (object.sphere) ball = object.sphere->centre;
        if (scene.materials[object.material].emission != vec3(0))
            lamp = scene.meshes[object.mesh].positions[0];
    }
    const double ceiling = scene::bounds(scene).hi.y;
    const auto flat = [](dvec3 p, double y) { return dvec3(p.x, y, p.z); };
    const std::pair<const char*, scene::Scene> places[] = {
        {"inside a ball",
         move_lamp_corners(scene, [&](dvec3 p) { return ball + (p - lamp) * .05; })},
        {"on the ceiling's plane",
         move_lamp_corners(scene, [&](dvec3 p) { return flat(p, ceiling); })},
        {"at the camera", move_lamp_corners(scene, [&](dvec3 p) {
             return scene.cameras.front().eye + (p - lamp - dvec3(.5, 0, .5)) * .1;
         })}};
    for (const auto& [what, moved] : places)
        for (const std::string technique : {"raytrace", "parallax"})
            bench.add_nonfinite(std::string(what) + ", " + technique,
                                bench.render_technique(moved, technique));
    // The lamp is above the ceiling and shines upwards, so only ambient light remains in the room.
    scene::Scene away = move_lamp_corners(scene, [&](dvec3 p) { return flat(p, ceiling + 1); });
    for (const scene::Object& object : away.objects)
        if (away.materials[object.material].emission != vec3(0))
            for (vec3& normal : away.meshes[object.mesh].normals) normal = -normal;
    scene::Scene dark = away;
    for (const scene::Object& object : dark.objects)
        if (dark.materials[object.material].emission != vec3(0))
            dark.materials[object.material].emission = vec3(0);
    for (const std::string technique : {"raytrace", "reuse"}) {
        const session::TechniqueResult a = bench.render_technique(away, technique),
                                       b = bench.render_technique(dark, technique);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < a.hdr.pixels.size(); ++i)
            differ += a.hdr.pixels[i] != b.hdr.pixels[i] &&
                      a.hdr.pixels[i].x < 1; // the lamp itself may be seen
        bench.add_case("facing away, " + technique + ": lit pixels", double(differ), 0);
    }
}

void judge_picture_sizes(Bench& bench) {
    const scene::Scene scene = make_room(bench, 1);
    for (const uvec2 size : {uvec2(1, 1), uvec2(1, 16384), uvec2(16384, 1)})
        for (const std::string technique : {"raytrace", "parallax:face=32"}) {
            session::Request request = bench.make_request(scene, technique, 2);
            request.size = size;
            bench.add_nonfinite(fmt::format("{}x{}, {}", size.x, size.y, technique),
                                bench.render_technique(request));
        }
    for (const uvec2 size : {uvec2(0, 0), uvec2(0, 7)})
        bench.add_expected_error(
            fmt::format("{}x{}", size.x, size.y), Failure::usage, "at least 1x1", [&] {
                session::Request request = bench.make_request(scene, "raytrace");
                request.size = size;
                bench.render_technique(request);
            });
    for (const uvec2 size : {uvec2(65536, 65536), uvec2(~0u, 1)})
        bench.add_expected_error(
            fmt::format("{}x{}", size.x, size.y), Failure::exhausted, "allows max_", [&] {
                session::Request request = bench.make_request(scene, "raytrace");
                request.size = size;
                bench.plan_technique(request);
            });
    for (const std::string technique : {"raytrace", "parallax:face=32"}) {
        session::Request request = bench.make_request(scene, technique, 1);
        request.size = {16384, 16384};
        bench.add_attempt("16384x16384, " + technique + ", planned",
                          [&] { bench.plan_technique(request); });
    }
    session::Request large = bench.make_request(scene, "raytrace", 1);
    large.size = uvec2(bench.has_small_pictures() ? 2048 : 4096);
    bench.add_nonfinite(fmt::format("{0}x{0}, raytrace", large.size.x),
                        bench.render_technique(large));
}

/// Returns the number of black pixels in the middle ninth of a picture.
double count_black_pixels(const measure::Picture& picture) {
    std::size_t black = 0;
    for (int y = picture.height / 3; y < picture.height * 2 / 3; ++y)
        for (int x = picture.width / 3; x < picture.width * 2 / 3; ++x)
            black += picture.at(x, y) == vec3(0);
    return double(black);
}

/// Returns a rippled square of 2 n^2 triangles around 0.
scene::Mesh make_rippled_grid(std::uint32_t n) {
    scene::Mesh mesh{.name = "grid"};
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) {
            const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
            mesh.positions.emplace_back(x, y, .05 * std::sin(40 * x) * std::sin(40 * y));
            mesh.normals.emplace_back(0, 0, -1);
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            mesh.triangles.emplace_back(a, a + 1, b);
            mesh.triangles.emplace_back(b, a + 1, b + 1);
        }
    return mesh;
}

void judge_triangle_counts(Bench& bench) {
    scene::Scene empty{.name = "empty"};
    empty.cameras.push_back({.eye = {0, 0, -3}, .target = {0, 0, 0}});
    scene::Scene one = empty, many = empty;
    const std::size_t hot = add_material(one, {.name = "hot", .emission = vec3(1)});
    one.meshes.push_back({"triangle",
                          {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
                          {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}},
                          {{0, 1, 2}}});
    one.objects.push_back({.name = "triangle", .mesh = 0, .material = hot});
    add_ball(many, add_material(many, {.name = "hot", .emission = vec3(1)}), {{0, 0, 0}, 1},
             9); // 4^10 triangles
    for (const std::string technique : {"raytrace", "parallax"}) {
        const auto sum = [&](const scene::Scene& scene, const std::string& what) {
            const session::TechniqueResult part = bench.render_technique(scene, technique, 2);
            bench.add_nonfinite(what + ", " + technique, part);
            double bright = 0;
            for (const vec3& pixel : part.hdr.pixels) bright += pixel.x > .5f;
            return bright / double(part.hdr.pixels.size());
        };
        bench.add_case("empty, " + technique + ": pixels that are not background",
                       sum(empty, "empty"), 0);
        bench.add_case("one triangle, " + technique + ": not seen",
                       sum(one, "one triangle") > .1 ? 0 : 1, 0);
    }
    const bool on_processor = bench.bench_engine().device().type == "cpu";
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t start_of_processor = std::clock();
    const session::TechniqueResult part = bench.render_technique(many, "raytrace", 1);
    // On a processor, other programs change the elapsed time.
    const double seconds =
        on_processor
            ? double(std::clock() - start_of_processor) / CLOCKS_PER_SEC
            : std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    bench.add_case(fmt::format("1,048,576 triangles, raytrace: {} from mesh to picture",
                               on_processor ? "seconds of processor time" : "seconds"),
                   seconds, 30);
    bench.add_nonfinite("1,048,576 triangles, raytrace", part);
    constexpr std::uint32_t kLeastEdgeForTenMillion = 128;
    if (glm::min(bench.picture_size().x, bench.picture_size().y) < kLeastEdgeForTenMillion)
        return bench.add_skipped(
            "10,008,338 triangles, raytrace",
            Error(Failure::usage, fmt::format("takes 20 s of processor time, so only pictures of "
                                              "{0}x{0} and more draw it",
                                              kLeastEdgeForTenMillion)));
    scene::Scene ten = empty;
    add_mesh(ten, make_rippled_grid(2237),
             add_material(ten, {.name = "grey", .albedo = vec3(.5f)}));
    bench.add_attempt("10,008,338 triangles, raytrace", [&] {
        const session::TechniqueResult seen = bench.render_technique(ten, "raytrace", 1);
        bench.add_nonfinite("10,008,338 triangles, raytrace", seen);
        bench.add_case("10,008,338 triangles, raytrace: pixels of the middle that show none",
                       count_black_pixels(seen.hdr), 0);
    });
}

const RegisteredProperty kLampPositionProperty{
    {"L1", "light inside a ball, on the ceiling, at the camera, facing away",
     "finite; unlit where it faces away", judge_lamp_position, "lamp_without_normal"}};
const RegisteredProperty kPictureSizesProperty{
    {"Z1", "picture 1x1, 1x16384, 16384x1, 4096x4096, 16384x16384, 0x0, 65536x65536",
     "works, or is refused with the limit", judge_picture_sizes, "no_width_taken",
     "rendering 16384x16384, which is planned only"}};
const RegisteredProperty kTriangleCountsProperty{
    {"Z2", "empty scene, one triangle, a million, ten million",
     "background; finite; a million in 30 s (of a processor: its time); runs or names the limit",
     judge_triangle_counts, "places_in_22_bits"}};

} // namespace

} // namespace catoptric::stress
