// Properties of a light too bright for a half float, and of a surface too dark for a float.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::stress {

namespace {

/// Returns the number of texels in the captures of `technique` that are clipped at the largest
/// half.
double count_saturated(Bench& bench, const scene::Scene& scene, const std::string& technique) {
    session::Request request = bench.make_request(scene, bench.fit_captures(technique));
    request.with_lookup = true;
    return double(bench.render_technique(request).saturated.value());
}

/// Frame numbers, from 1: the last frame with the lamp of 1e30, and frames 2 and 20 after its
/// removal.
constexpr int kFramesBefore = 4, kFrameSoonAfter = kFramesBefore + 2,
              kFrameLongAfter = kFramesBefore + 20;

void judge_lamp_removal(Bench& bench, const scene::Scene& lit, const scene::Scene& dark,
                        std::size_t lamp, const std::string& technique, const std::string& what) {
    const session::Request request = bench.make_request(lit, bench.fit_captures(technique));
    const scene::Edit out = scene::set_material(lamp, dark.materials[lamp]);
    session::Session session(bench.bench_engine(), lit);
    session::TechniqueResult soon, late;
    for (int k = 1; k <= kFrameLongAfter; ++k) {
        if (k == kFramesBefore + 1) session.change(out);
        const session::Frame frame = bench.render_frame(session, request);
        if (k == kFramesBefore) bench.add_nonfinite(what + ", with it", frame.read());
        if (k == kFrameSoonAfter) soon = frame.read();
        if (k == kFrameLongAfter) late = frame.read();
    }
    session::Session untouched(bench.bench_engine(), dark);
    measure::Picture wanted;
    for (int k = 1; k <= kFrameLongAfter; ++k)
        wanted = bench.render_frame(untouched, request).hdr();
    bench.add_case(what + ", frame 20 without it: pixels unlike a run that never had it",
                   double(count_different(late.hdr, wanted)), 0);
    const std::string early = what + ", frame 2 without it: pixels unlike frame 20";
    const double unlike = double(count_different(soon.hdr, late.hdr));
    // If mirrors use last frame's captures, light travels between them for one frame a mirror.
    if (late.remembers && scene::mirrors(dark).size() > 1)
        bench.add_warning(early, unlike, 0,
                          "a light that goes out stays in the mirrors that are seen in "
                          "mirrors, for one frame a mirror");
    else
        bench.add_case(early, unlike, 0);
}

void judge_bright_emission(Bench& bench) {
    for (const int balls : {1, 3}) {
        scene::Scene dark = make_room(bench, balls);
        const std::size_t lamp = add_material(dark, {.name = "second lamp"});
        add_quad(dark, lamp, {-1.2, 1.2, .8}, {-.9, 1.2, .8}, {-.9, 1.2, 1.1}, {-1.2, 1.2, 1.1});
        scene::Scene lit = dark;
        lit.materials[lamp].emission = vec3(1e30f);
        for (const std::string technique :
             {"raytrace", "reuse:face=128", "parallax:face=128", "pyramid:face=128"})
            judge_lamp_removal(bench, lit, dark, lamp, technique,
                               fmt::format("emission 1e30, {} balls, {}", balls, technique));
        for (const std::string technique : {"reuse:face=64", "hybrid:face=64"}) {
            const double full = count_saturated(bench, lit, technique);
            bench.add_case(
                fmt::format("emission 1e30, {} balls, {}: none of {} saturated texels is counted",
                            balls, technique, full),
                full > 0 ? 0 : 1, 0);
            bench.add_case(
                fmt::format("without it, {} balls, {}: texels saturated", balls, technique),
                count_saturated(bench, dark, technique), 0);
        }
    }
    scene::Scene dim = make_room(bench, 3), black = dim;
    dim.materials.front().albedo = vec3(1e-40f);
    black.materials.front().albedo = vec3(0);
    for (const std::string technique : {"raytrace", "pyramid"}) {
        const session::TechniqueResult found = bench.render_technique(dim, technique),
                                       wanted = bench.render_technique(black, technique);
        double most = 0;
        for (std::size_t i = 0; i < found.hdr.pixels.size(); ++i) {
            const dvec3 off = abs(dvec3(found.hdr.pixels[i]) - dvec3(wanted.hdr.pixels[i]));
            most = std::max({most, off.x, off.y, off.z});
        }
        bench.add_case(technique + ", albedo 1e-40: radiance unlike that of black", most,
                       std::numeric_limits<float>::min());
        bench.add_case(technique + ", albedo 1e-40: pixels shown unlike black",
                       double(count_different(found.display, wanted.display)), 0);
    }
}

const RegisteredProperty kBrightEmissionProperty{
    {"N26", "emission 1e30, taken away in mid-run; albedo 1e-40",
     "saturates, is counted, later frames unharmed; equals black", judge_bright_emission,
     "saturated_uncounted"}};

} // namespace

} // namespace catoptric::stress
