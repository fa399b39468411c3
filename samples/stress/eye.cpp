// Stress properties of cameras in extreme places, compared with a ray tracer in double precision.
#include "stress/double_tracer.hpp"
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

struct TestedEyePlacement {
    const char* what;
    scene::Camera camera;
};

constexpr double kMaxChannelDifference = .01;

double max_channel_difference(const dvec3& a, const dvec3& b) {
    const dvec3 difference = abs(a - b);
    return std::max({difference.x, difference.y, difference.z});
}

/// Returns the share of pixels that differ from the double tracer by more than
/// kMaxChannelDifference.
double share_unlike_tracer(const session::TechniqueResult& part, const scene::Scene& scene,
                           const session::Request& request) {
    const DoubleTracer tracer(scene, request.ambient);
    std::size_t off = 0;
    for (std::uint32_t y = 0; y < request.size.y; ++y)
        for (std::uint32_t x = 0; x < request.size.x; ++x) {
            const dvec3 wanted = tracer.trace_pixel(request.camera, request.size, x, y, 16);
            const dvec3 found(part.hdr.at(static_cast<int>(x), static_cast<int>(y)));
            off += !(max_channel_difference(found, wanted) <= kMaxChannelDifference);
        }
    return double(off) / double(part.hdr.pixels.size());
}

/// Returns how many of 32 rows of the reference show an edge.
int count_rows_with_edge(const DoubleTracer& tracer, const scene::Camera& camera) {
    constexpr uvec2 kEyeTestPictureSize{32, 32};
    int rows = 0;
    for (std::uint32_t y = 0; y < kEyeTestPictureSize.y; ++y) {
        bool has_edge = false;
        dvec3 last = tracer.trace_pixel(camera, kEyeTestPictureSize, 0, y, 16);
        for (std::uint32_t x = 1; x < kEyeTestPictureSize.x; ++x) {
            const dvec3 next = tracer.trace_pixel(camera, kEyeTestPictureSize, x, y, 16);
            has_edge |= max_channel_difference(next, last) > kMaxChannelDifference;
            last = next;
        }
        rows += has_edge;
    }
    return rows;
}

/// Returns a tilted camera with a very narrow field of view, which looks at an edge of the far
/// wall. If rounding errors made rays coincide, the picture would show the wrong side of the edge.
/// Several edges are tried, because a ball may hide an edge and two walls may have the same colour.
/// `rows` gets the number of rows, of 32, that show the edge.
scene::Camera make_narrow_camera(const scene::Scene& scene, double ambient, int& rows) {
    const Bounds<double> walls = scene::bounds(scene);
    const DoubleTracer tracer(scene, ambient);
    scene::Camera camera = scene.cameras.front();
    camera.vertical_fov_degrees = .01;
    camera.up = normalize(dvec3(.5, 1, 0));
    for (const double height : {.8, .5, .2})
        for (const double x : {walls.lo.x, walls.hi.x}) {
            camera.target = {x, std::lerp(walls.lo.y, walls.hi.y, height), walls.hi.z};
            rows = count_rows_with_edge(tracer, camera);
            if (rows >= 16) return camera;
        }
    return camera;
}

/// Returns the share of pixels without a mirror in which two pictures differ.
double share_off_mirrors(const session::TechniqueResult& drawn,
                         const session::TechniqueResult& traced) {
    std::size_t off = 0, seen = 0;
    for (std::size_t i = 0; i < traced.hits.size(); ++i) {
        if (traced.hits[i] != 0) continue;
        ++seen,
            off += !(max_channel_difference(dvec3(drawn.hdr.pixels[i]),
                                            dvec3(traced.hdr.pixels[i])) <= kMaxChannelDifference);
    }
    return double(off) / double(seen);
}

void judge_eye_placement(Bench& bench) {
    const scene::Scene scene = make_room(bench, 2);
    const Bounds<double> walls = scene::bounds(scene);
    scene::Camera low = scene.cameras.front(), wide = low;
    low.eye.y = walls.lo.y + 1e-3, low.eye.z = 0, low.target = low.eye + dvec3(0, .2, 1);
    wide.vertical_fov_degrees = 179.9;
    int rows = 0;
    const scene::Camera narrow = make_narrow_camera(
        scene, bench.make_request(scene, "raytrace").ambient, rows);
    bench.add_case("field of view .01: rows of 32 without an edge", 32 - rows, 16);
    for (const TestedEyePlacement& eye : {TestedEyePlacement{"1e-3 above the floor", low},
                                          {"field of view .01", narrow},
                                          {"field of view 179.9", wide}}) {
        session::Request request = bench.make_request(scene, "raytrace:sphere=exact,depth=16");
        request.camera = eye.camera;
        const auto render = [&](const std::string& technique) {
            request.techniques = {technique};
            return bench.render_technique(request);
        };
        const session::TechniqueResult traced = render("raytrace:sphere=exact,depth=16");
        bench.add_nonfinite(fmt::format("{}, raytrace", eye.what), traced);
        bench.add_case(
            fmt::format("{}, raytrace: share of pixels more than .01 off a reference in doubles",
                        eye.what),
            share_unlike_tracer(traced, scene, request), .005);
        bench.add_nonfinite(fmt::format("{}, pyramid", eye.what), render("pyramid"));
        // A texel of the shadow map is wider than the narrow picture, so neither picture has
        // shadows.
        bench.add_case(
            fmt::format("{}, pyramid: share of pixels beside mirrors more than .01 off ray "
                        "tracing, both without shadows",
                        eye.what),
            share_off_mirrors(render("pyramid:shadow=none"),
                              render("raytrace:sphere=exact,shadow=none")),
            .005);
    }
}

const RegisteredProperty kEyePlacementProperty{
    {"N24", "camera 1e-3 above the floor; field of view .01 and 179.9",
     "finite; as a reference in doubles", judge_eye_placement, "near_of_eye_fixed"}};

} // namespace

} // namespace catoptric::stress
