// Properties of the contents of captures: distances, colours, and the right walls in the right
// orientation.
#include "stress/double_tracer.hpp"
#include "stress/glyph_room.hpp"
#include "stress/property.hpp"
#include "stress/scenes.hpp"
#include "stress/texels.hpp"

#include "core/format.hpp"
#include "import/load.hpp"
#include "render/captured.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace catoptric::stress {

namespace {

/// Returns the room of the built-in scene with only one of its mirrors (from 0), or with no mirror.
scene::Scene one_mirror_room(std::size_t mirror) {
    scene::Scene scene = scene::make_cornell();
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    for (std::size_t i = mirrors.size(); i-- > 0;)
        if (i != mirror)
            scene.objects.erase(scene.objects.begin() + static_cast<std::ptrdiff_t>(mirrors[i]));
    return scene;
}

/// Returns the cubes of all mirrors, without shadows and ambient light. Other mirrors are black in
/// them.
render::CapturedCubes read_captures(Bench& bench, const scene::Scene& scene, std::uint32_t edge,
                                    TexelFormat format) {
    session::Request request = bench.make_request(
        scene, fmt::format("parallax:shadow=none,face={},distance={}", edge, format_name(format)));
    request.size = {16, 16};
    request.ambient = 0;
    session::Session session(bench.bench_engine(), scene);
    return session::Access::read_captures(
        bench.render_frame(session, request, {.with_captures = true}));
}

void judge_captured_distances(Bench& bench) {
    constexpr std::uint32_t kCaptureFaceEdge = 128;
    constexpr double kMaxStoredDistance =
        200; // largest distance of the seed report's 8-bit storage
    const std::size_t mirrors = scene::mirrors(scene::make_cornell()).size();
    const scene::Scene walls = one_mirror_room(mirrors);
    const DoubleTracer tracer(walls, 0);
    for (const TexelFormat format : {TexelFormat::r32f, TexelFormat::r16f})
        for (std::size_t mirror = 0; mirror < mirrors; ++mirror) {
            const scene::Scene scene = one_mirror_room(mirror);
            const dvec3 centre =
                scene::bounds(scene, scene.objects[scene::mirrors(scene).front()]).centre();
            const render::CapturedCubes cubes = read_captures(bench, scene, kCaptureFaceEdge,
                                                              format);
            std::size_t off = 0, clamped = 0, far = 0, judged = 0;
            for_each_texel(kCaptureFaceEdge, [&](const dvec3& direction, int face, std::uint32_t x,
                                                 std::uint32_t y) {
                const double wanted = tracer.hit_distance(centre, normalize(direction));
                const double found = cubes.distance(0, face, x, y, format) / cubes.space.scale;
                ++judged, far += wanted > 2 * kMaxStoredDistance;
                off += !(std::isinf(wanted) ? std::isinf(found)
                                            : std::abs(found / wanted - 1) <= 0x1p-10);
                clamped += wanted > 1.01 * kMaxStoredDistance && !(found > kMaxStoredDistance);
            });
            const std::string what = fmt::format("ball {}, {}", mirror + 1, format_name(format));
            bench.add_case(what + ": share of texels off by more than 2^-10",
                           double(off) / double(judged), .001);
            bench.add_case(what + ": texels clamped at 200", double(clamped), 0);
            bench.add_case(what + ": no texel beyond 400", far > 0 ? 0 : 1, 0);
        }
}

/// Judges a wall close to the ball, in each of six directions in turn. The test reads the texel at
/// the centre of the cube face that shows the wall.
void judge_near_wall(Bench& bench) {
    constexpr std::uint32_t kCaptureFaceEdge = 65;
    constexpr double kNearWallDistance = .6;
    for (int face = 0; face < 6; ++face) {
        scene::Scene scene = make_white_furnace({{{0, 0, 0}, .5}});
        dvec3 lo(-4, -3, -5), hi(4, 3, 5);
        (face % 2 ? lo : hi)[face / 2] = face % 2 ? -kNearWallDistance : kNearWallDistance;
        for (int wall = 0; wall < 6; ++wall)
            scene.meshes[static_cast<std::size_t>(wall)] = scene::make_box_wall(wall, lo, hi);
        const render::CapturedCubes cubes = read_captures(bench, scene, kCaptureFaceEdge,
                                                          TexelFormat::r32f);
        const double found = cubes.distance(0, face, kCaptureFaceEdge / 2, kCaptureFaceEdge / 2,
                                            TexelFormat::r32f) /
                             cubes.space.scale;
        bench.add_case(
            fmt::format("face {}: central texel off {} by a share of", face, kNearWallDistance),
            std::abs(found / kNearWallDistance - 1), .01);
        bench.add_case(
            fmt::format("face {}: central texel shows no wall", face),
            cubes.colour(0, face, kCaptureFaceEdge / 2, kCaptureFaceEdge / 2) == vec3(1) ? 0 : 1,
            0);
    }
}

void judge_captured_glyphs(Bench& bench) {
    constexpr std::uint32_t kCaptureFaceEdge = 64;
    constexpr double kWallEdgeMargin =
        .001; // share of a wall by which a rasteriser may move its edges
    const LetterRoom room;
    const render::CapturedCubes cubes = read_captures(bench, room.make_scene(), kCaptureFaceEdge,
                                                      TexelFormat::r32f);
    std::array<std::size_t, 6> wrong{}, judged{}, inked{};
    for_each_texel(kCaptureFaceEdge,
                   [&](const dvec3& direction, int face, std::uint32_t x, std::uint32_t y) {
                       const LetterRoom::WallPoint seen = room.seen_point(direction);
                       if (seen.margin < kWallEdgeMargin)
                           return; // the texel's centre may lie on an edge
                       const auto wall = static_cast<std::size_t>(seen.face);
                       ++judged[wall], inked[wall] += seen.glyph;
                       wrong[wall] += cubes.colour(0, face, x, y) != LetterRoom::point_colour(seen);
                   });
    for (std::size_t wall = 0; wall < 6; ++wall) {
        bench.add_case(fmt::format("wall {}: texels of another colour", wall), double(wrong[wall]),
                       0);
        bench.add_case(fmt::format("wall {}: fewer than 100 texels of its letter", wall),
                       inked[wall] < 100 ? 1 : 0, 0);
    }
    bench.add_case("share of texels on an edge",
                   1 - double(std::accumulate(judged.begin(), judged.end(), std::size_t{0})) /
                           (6.0 * kCaptureFaceEdge * kCaptureFaceEdge),
                   .05);
}

/// Returns a camera that looks at a mirror ball of radius 1 around 0. The ray through the centre of
/// the picture is reflected by the ball in the direction `wanted`.
scene::Camera make_camera_along(dvec3 wanted) {
    const dvec3 n = normalize(wanted + .4 * normalize(cross(wanted, dvec3(.3, -.5, .8))));
    const dvec3 incoming = wanted - 2 * dot(wanted, n) * n;
    return {.eye = n - 2.0 * incoming,
            .target = n,
            .up = normalize(cross(incoming, dvec3(.1, .7, -.2))),
            .vertical_fov_degrees = 1};
}

/// Returns the number of pixels whose ray a unit ball around 0 reflects to within two texels of a
/// cube edge.
std::size_t count_near_edges(const scene::Camera& camera, uvec2 size, double edge) {
    std::size_t near = 0;
    for (std::uint32_t y = 0; y < size.y; ++y)
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const dvec3 d = ray_direction(camera, size, x, y);
            const double b = dot(camera.eye, d), c = dot(camera.eye, camera.eye) - 1;
            const dvec3 n = camera.eye + (-b - std::sqrt(b * b - c)) * d,
                        sent = d - 2 * dot(d, n) * n, most = abs(sent);
            const double first = std::max({most.x, most.y, most.z}),
                         least = std::min({most.x, most.y, most.z});
            near += (most.x + most.y + most.z - first - least) / first > 1 - 4 / edge;
        }
    return near;
}

void judge_cube_edges(Bench& bench) {
    constexpr int kCaptureFaceEdge = 64;
    constexpr uvec2 kCaptureTestPictureSize{128, 128};
    constexpr float kEmittingRoomColour = .7f; // a colour that no half-float stores exactly
    scene::Scene scene = make_white_furnace({});
    scene.materials.front().emission = vec3(kEmittingRoomColour);
    add_ball(scene, add_material(scene, {.name = "mirror", .mirror = true}), {{0, 0, 0}, 1}, 5);
    double step = 0, off = 0;
    std::size_t near = 0;
    for (int edge = 0; edge < 12; ++edge) {
        dvec3 wanted;
        const int along = edge / 4;
        wanted[along] = bench.random(-1, 1);
        wanted[(along + 1) % 3] = edge & 1 ? 1 : -1;
        wanted[(along + 2) % 3] = edge & 2 ? 1 : -1;
        session::Request request = bench.make_request(
            scene, fmt::format("naive:bounces=1,shadow=none,face={}", kCaptureFaceEdge), 1);
        request.camera = make_camera_along(normalize(wanted));
        request.size = kCaptureTestPictureSize;
        const measure::Picture picture = bench.render_technique(request).hdr;
        near += count_near_edges(request.camera, kCaptureTestPictureSize, kCaptureFaceEdge);
        for (int y = 1; y < picture.height; ++y)
            for (int x = 1; x < picture.width; ++x) {
                const float here = picture.at(x, y).x;
                step = std::max<double>(
                    {step, std::abs(here - picture.at(x - 1, y).x) / kEmittingRoomColour,
                     std::abs(here - picture.at(x, y - 1).x) / kEmittingRoomColour});
                off = std::max<double>(off,
                                       std::abs(here - kEmittingRoomColour) / kEmittingRoomColour);
                if (!std::isfinite(here)) step = std::nan("");
            }
    }
    bench.add_case("largest step from neighbour to neighbour", step, 2.0 / 1024);
    bench.add_case("largest departure from the room's colour", off, 2.0 / 1024);
    bench.add_case("directions within two texels of an edge: fewer than 1e5", near < 100000 ? 1 : 0,
                   0);
}

const RegisteredProperty kCapturedDistancesProperty{
    {"N11", "distance cubes of the room's four mirrors, r32f and r16f",
     "equal the analytic distance, nothing is clamped at 200", judge_captured_distances,
     "distance_along_axis"}};
const RegisteredProperty kCaptureNearWallProperty{
    {"C3", "a ball with a wall .6 units from its centre",
     "the wall is in the capture, at its distance", judge_near_wall, "near_one"}};
const RegisteredProperty kCubeEdgesProperty{{"C11",
                                             "a room of one colour, 1e5 directions near cube edges",
                                             "continuous", judge_cube_edges, "edge_texels_black"}};
const RegisteredProperty kCapturedGlyphsProperty{{"C12", "six coloured walls with a letter each",
                                                  "each face sees its wall, letters read right",
                                                  judge_captured_glyphs, "face_mirrored"}};

} // namespace

} // namespace catoptric::stress
