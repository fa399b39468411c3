// Property of smooth surfaces: up to the sharp limit they are perfect mirrors, and just above it
// nearly so.
#include "shared.h"
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace catoptric::stress {

namespace {

/// Returns the room with a ball of roughness .3 and two balls of `material`. The rough ball makes
/// the scene one with lobes, whatever the roughness of the others.
scene::Scene make_mixed_room(const scene::Scene& room, const scene::Material& material) {
    scene::Scene scene = room;
    scene.mirror_max_roughness = 1;
    const std::size_t smooth = add_material(scene, material);
    const std::size_t rough = add_material(
        scene, {.name = "rough", .albedo = vec3(1), .metallic = 1, .roughness = .3f});
    std::size_t next = rough;
    for (scene::Object& object : scene.objects) {
        if (!object.sphere) continue;
        object.material = std::exchange(next, smooth);
        object.mirror = true;
    }
    return scene;
}

/// Returns the largest difference of a channel, or NaN if a pixel is not finite.
double largest_channel_difference(const measure::Picture& a, const measure::Picture& b) {
    if (count_nonfinite(a) + count_nonfinite(b) > 0) return std::nan("");
    double largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const vec3 off = abs(a.pixels[i] - b.pixels[i]);
        largest = std::max({largest, double{off.x}, double{off.y}, double{off.z}});
    }
    return largest;
}

/// Technique, and how far its pictures may be from those of a perfect mirror: the largest
/// difference of radiance up to the sharp limit, and FLIP just above the limit.
struct SharpLimitRow {
    const char* technique;
    int frames;
    double most_below, most_above;
};

void judge_sharp_limit(Bench& bench) {
    const scene::Scene room = make_room(bench, 3);
    for (const auto& [technique, frames, most_below, most_above] :
         {SharpLimitRow{"raytrace:rays=64,depth=3", 1, 0, .005},
          SharpLimitRow{"reuse:face=64", 4, .005, .005},
          SharpLimitRow{"pyramid:face=64", 4, .005, .005}}) {
        const auto render = [&, &technique = technique,
                             &frames = frames](scene::Material material) {
            material.name = "smooth";
            session::Request request = bench.make_request(make_mixed_room(room, material),
                                                          technique, frames);
            request.size = {96, 96};
            return bench.render_technique(request);
        };
        const session::TechniqueResult wanted = render({.mirror = true});
        for (const float roughness : {0.f, 1e-8f, .01f, shared::kMaxSharpRoughness})
            bench.add_case(
                fmt::format("{}, roughness {}: largest difference from a perfect mirror", technique,
                            roughness),
                largest_channel_difference(
                    render({.albedo = vec3(1), .metallic = 1, .roughness = roughness}).hdr,
                    wanted.hdr),
                most_below);
        const float above = shared::kMaxSharpRoughness + 1e-4f;
        bench.add_flip(
            fmt::format("{}, roughness {:.4f}, against a perfect mirror", technique, above),
            render({.albedo = vec3(1), .metallic = 1, .roughness = above}), wanted, most_above);
    }
}

const RegisteredProperty kSharpLimitProperty{{"S5",
                                              "metal of roughness 0, 1e-8, .01, .04 and .0401",
                                              "a perfect mirror up to .04, nearly one above (FLIP)",
                                              judge_sharp_limit, "lobes_below_limit"}};

} // namespace

} // namespace catoptric::stress
