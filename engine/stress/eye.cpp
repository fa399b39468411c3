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

void judge_eye(Bench& bench) {
    const scene::Scene scene = room(bench, 2);
    const Bounds<double> walls = scene::bounds(scene);
    scene::Camera low = scene.cameras.front(), narrow = low, wide = low;
    low.eye.y = walls.lo.y + 1e-3, low.eye.z = 0, low.target = low.eye + dvec3(0, .2, 1);
    wide.vertical_fov_degrees = 179.9;
    // At the ridge of the far wall and a side wall, askew: so much of the picture is beside an edge that rays
    // which fell together would show the wrong side of it.
    narrow.vertical_fov_degrees = .01;
    narrow.target = {walls.lo.x, walls.lo.y + .8 * (walls.hi.y - walls.lo.y), walls.hi.z};
    narrow.up = normalize(dvec3(.5, 1, 0));
    for (const Eye& eye : {Eye{"1e-3 above the floor", low}, {"field of view .01", narrow}, {"field of view 179.9", wide}}) {
        const auto render = [&](const std::string& technique) {
            app::Request request = bench.asked(scene, technique);
            request.camera = eye.camera;
            return bench.render(request);
        };
        const app::Part traced = render("raytrace:sphere=exact,depth=16");
        bench.add_nonfinite(fmt::format("{}, raytrace", eye.what), traced);
        bench.add_nonfinite(fmt::format("{}, pyramid", eye.what), render("pyramid"));
        const DoubleTracer tracer(scene, bench.asked(scene, "raytrace").ambient);
        std::size_t off = 0, colours = 0;
        dvec3 last(-1);
        for (std::uint32_t y = 0; y < bench.size().y; ++y)
            for (std::uint32_t x = 0; x < bench.size().x; ++x) {
                const dvec3 wanted = tracer.pixel(eye.camera, bench.size(), x, y, 16);
                const dvec3 difference = abs(dvec3(traced.hdr.at(static_cast<int>(x), static_cast<int>(y))) - wanted);
                off += !(std::max({difference.x, difference.y, difference.z}) <= .01);
                colours += length(wanted - last) > .05;
                last = wanted;
            }
        const double pixels = double(bench.size().x) * bench.size().y;
        bench.add(fmt::format("{}: share of pixels more than .01 off a reference in doubles", eye.what), double(off) / pixels, .005);
        bench.add(fmt::format("{}: fewer edges in the picture than half its rows", eye.what), colours < bench.size().y / 2 ? 1 : 0, 0);
    }
}

const Row kEye{{"N24", "camera 1e-3 above the floor; field of view .01 and 179.9", "finite; as a reference in doubles", judge_eye}};

} // namespace

} // namespace catoptric::stress
