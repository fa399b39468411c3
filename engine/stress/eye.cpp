// Cameras where nobody would put them, against a reference in doubles.
#include "stress/double_tracer.hpp"
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::stress {

namespace {

struct Eye {
    const char* what;
    scene::Camera camera;
};

/// Shares of the pixels that are more than .01 off, and how often the reference changes by more
/// along a row.
struct Off {
    double share = 0;
    std::size_t edges = 0;
};

constexpr double kOff = .01;

double largest_difference(const dvec3& a, const dvec3& b) {
    const dvec3 difference = abs(a - b);
    return std::max({difference.x, difference.y, difference.z});
}

Off against_doubles(const app::Part& part, const scene::Scene& scene, const app::Request& request) {
    const DoubleTracer tracer(scene, request.ambient);
    std::size_t off = 0, edges = 0;
    for (std::uint32_t y = 0; y < request.size.y; ++y) {
        dvec3 last;
        for (std::uint32_t x = 0; x < request.size.x; ++x) {
            const dvec3 wanted = tracer.pixel(request.camera, request.size, x, y, 16);
            off += !(
                largest_difference(dvec3(part.hdr.at(static_cast<int>(x), static_cast<int>(y))),
                                   wanted) <= kOff);
            edges += x > 0 && largest_difference(wanted, last) > kOff;
            last = wanted;
        }
    }
    return {double(off) / double(part.hdr.pixels.size()), edges};
}

/// Share of the pixels without a mirror in which two pictures differ.
double beside_mirrors(const app::Part& drawn, const app::Part& traced) {
    std::size_t off = 0, seen = 0;
    for (std::size_t i = 0; i < traced.hits.size(); ++i) {
        if (traced.hits[i] != 0) continue;
        ++seen, off += !(largest_difference(dvec3(drawn.hdr.pixels[i]),
                                            dvec3(traced.hdr.pixels[i])) <= kOff);
    }
    return double(off) / double(seen);
}

void judge_eye(Bench& bench) {
    const scene::Scene scene = room(bench, 2);
    const Bounds<double> walls = scene::bounds(scene);
    scene::Camera low = scene.cameras.front(), narrow = low, wide = low;
    low.eye.y = walls.lo.y + 1e-3, low.eye.z = 0, low.target = low.eye + dvec3(0, .2, 1);
    wide.vertical_fov_degrees = 179.9;
    // At the ridge of the far wall and a side wall, askew: rays that fell together would show its
    // wrong side.
    narrow.vertical_fov_degrees = .01;
    narrow.target = {walls.lo.x, walls.lo.y + .8 * (walls.hi.y - walls.lo.y), walls.hi.z};
    narrow.up = normalize(dvec3(.5, 1, 0));
    for (const Eye& eye : {Eye{"1e-3 above the floor", low},
                           {"field of view .01", narrow},
                           {"field of view 179.9", wide}}) {
        app::Request request = bench.asked(scene, "raytrace:sphere=exact,depth=16");
        request.camera = eye.camera;
        const auto render = [&](const std::string& technique) {
            request.techniques = {technique};
            return bench.render(request);
        };
        const app::Part traced = render("raytrace:sphere=exact,depth=16");
        const Off off = against_doubles(traced, scene, request);
        bench.add_nonfinite(fmt::format("{}, raytrace", eye.what), traced);
        bench.add(
            fmt::format("{}, raytrace: share of pixels more than .01 off a reference in doubles",
                        eye.what),
            off.share, .005);
        if (eye.camera.vertical_fov_degrees < 1)
            bench.add(fmt::format("{}: fewer edges in the picture than half its rows", eye.what),
                      off.edges < request.size.y / 2 ? 1 : 0, 0);
        bench.add_nonfinite(fmt::format("{}, pyramid", eye.what), render("pyramid"));
        // A texel of the shadow map is wider than the narrow picture, so both worlds go without.
        bench.add(fmt::format("{}, pyramid: share of pixels beside mirrors more than .01 off ray "
                              "tracing, both without shadows",
                              eye.what),
                  beside_mirrors(render("pyramid:shadow=none"),
                                 render("raytrace:sphere=exact,shadow=none")),
                  .005);
    }
}

const Row kEye{{"N24", "camera 1e-3 above the floor; field of view .01 and 179.9",
                "finite; as a reference in doubles", judge_eye}};

} // namespace

} // namespace catoptric::stress
