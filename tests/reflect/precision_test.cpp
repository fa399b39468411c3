// Tests of precision and of the ray tracer's rules for robustness. Each rule is compared with its
// alternative.
#include "scene/built_in.hpp"
#include "stress/double_tracer.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

/// Returns the mean error of a technique against the double-precision tracer: the largest channel
/// difference, averaged over the pixels that meet at least `mirrors` mirrors. Leaves out pixels
/// whose centre lies on an edge.
double error_against_double_tracer(const scene::Scene& scene, const std::string& technique,
                                   uvec2 size, int mirrors = 1) {
    const session::TechniqueResult part = test::render_technique(scene, technique, size);
    const stress::DoubleTracer tracer(scene, .05);
    double sum = 0;
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < size.y; ++y)
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const std::uint32_t hits = part.hits[x + y * size.x];
            if ((hits & 0xffff) == 0 || (mirrors == 2 && hits >> 16 == 0)) continue;
            const dvec3 wanted = tracer.trace_pixel(scene.cameras.front(), size, x, y, 8);
            const dvec3 off = abs(dvec3(part.hdr.at(static_cast<int>(x), static_cast<int>(y))) -
                                  wanted);
            const double most = std::max({off.x, off.y, off.z});
            if (most > 1e-3) continue;
            sum += most, ++count;
        }
    std::cout << "[ MEASURED ] " << technique << ": off " << sum / static_cast<double>(count)
              << " in the mean of " << count << " pixels\n";
    return sum / static_cast<double>(count);
}

TEST(Precision, DoubleHitPointsReduceTheError) {
    const scene::Scene room = test::make_lit_room(3, 1);
    for (const int mirrors : {1, 2}) {
        const double f32 = error_against_double_tracer(room, "raytrace:sphere=exact,depth=8",
                                                       {96, 96}, mirrors);
        const double f64 = error_against_double_tracer(
            room, "raytrace:sphere=exact,depth=8,hit=f64", {96, 96}, mirrors);
        EXPECT_GT(f64, 0) << "the shading is still in floats";
        EXPECT_LT(f64, f32);
    }
}

TEST(Precision, DoubleHitPointsChangeOnlyRoundings) {
    const scene::Scene scene = scene::make_cornell();
    for (const std::string knobs : {"", "shadow=map,"}) {
        const session::TechniqueResult f32 = test::render_technique(
                                           scene, "raytrace:" + knobs + "hit=f32", {128, 128}),
                                       f64 = test::render_technique(
                                           scene, "raytrace:" + knobs + "hit=f64", {128, 128});
        EXPECT_FALSE(test::have_equal_pixel_bytes(f32.hdr, f64.hdr));
        std::vector<float> off;
        for (std::size_t i = 0; i < f32.hdr.pixels.size(); ++i)
            off.push_back(glm::length(f32.hdr.pixels[i] - f64.hdr.pixels[i]));
        std::ranges::sort(off);
        EXPECT_LT(off[off.size() * 99 / 100], 1e-4f) << knobs;
    }
}

/// The lamp is brighter than the largest half float. Its image in a mirror must be cut off there,
/// unless captures hold floats.
TEST(Precision, HalfFloatCapturesSaturateAt65504) {
    constexpr float kLampEmission = 1e5f;
    scene::Scene room = test::make_lit_room(1, 1);
    for (scene::Material& material : room.materials)
        if (material.emission != vec3(0)) material.emission = vec3(kLampEmission);
    const session::TechniqueResult truth = test::render_technique(room, "raytrace", {256, 256});
    for (const std::string technique : {"reuse", "parallax", "pyramid"}) {
        const auto brightest = [&](const std::string& colour) {
            float most = 0;
            const session::TechniqueResult part = test::render_technique(
                room, technique + ":face=256,colour=" + colour, {256, 256});
            for (std::size_t i = 0; i < part.hdr.pixels.size(); ++i)
                if (truth.hits[i] != 0) most = std::max(most, part.hdr.pixels[i].x);
            return most;
        };
        EXPECT_EQ(brightest("half"), 65504) << technique;
        if (test::has_float_colour()) {
            EXPECT_EQ(brightest("float"), kLampEmission) << technique;
        }
    }
}

TEST(Precision, SaturatedTexelsAreCounted) {
    scene::Scene room = test::make_lit_room(1, 1);
    const auto counted = [&](const std::string& technique) {
        session::Request asked = test::make_test_request(room, {technique}, {32, 32});
        asked.with_lookup = true;
        return session::run(test::get_test_engine(), asked).parts.front().saturated;
    };
    for (const std::string technique : {"naive:bounces=1,", "reuse:", "layered:", "hybrid:"})
        EXPECT_EQ(counted(technique + "face=64"), 0u) << technique;
    const auto shine = [&](const vec3& emission) {
        for (scene::Material& material : room.materials)
            if (material.emission != vec3(0)) material.emission = emission;
    };
    shine(vec3(1e5f));
    const std::optional<std::size_t> naive = counted("naive:bounces=1,face=64");
    EXPECT_GT(naive.value(), 10u) << "the lamp";
    for (const std::string technique : {"reuse:", "layered:", "hybrid:"})
        EXPECT_EQ(counted(technique + "face=64"), naive) << technique;
    if (test::has_float_colour()) {
        EXPECT_FALSE(counted("reuse:face=64,colour=float").has_value());
    }
    // A texel counts once, however many of its channels are cut off.
    for (int channel = 0; channel < 3; ++channel) {
        vec3 one_colour(1);
        one_colour[channel] = 1e5f;
        shine(one_colour);
        EXPECT_EQ(counted("naive:bounces=1,face=64"), naive) << channel;
    }
}

/// Tests a ball of radius 0.3, seen from about two thousand units away.
TEST(Precision, TextbookSphereTestFailsFarAway) {
    scene::Scene room = test::make_lit_room(1, 1);
    room.objects.erase(room.objects.begin() + 5); // remove the wall behind which the camera moves
    scene::Camera& camera = room.cameras.front();
    const dvec3 back = camera.eye - camera.target;
    camera.eye = camera.target + back * 1000.0;
    camera.vertical_fov_degrees = .06;
    const double stable = error_against_double_tracer(room, "raytrace:sphere=exact,depth=8",
                                                      {64, 64});
    const session::TechniqueResult with = test::render_technique(room, "raytrace:sphere=exact",
                                                                 {64, 64}),
                                   without = test::render_technique(
                                       room, "raytrace:sphere=exact,without=stable_sphere",
                                       {64, 64});
    const double changed = test::rmse_of_pictures(with.hdr, without.hdr,
                                                  measure::mask_mirrors(with.hits));
    std::cout << "[ MEASURED ] rmse without the stable sphere: " << changed << "\n";
    EXPECT_LT(stable, 1e-4);
    EXPECT_GT(changed, 100 * stable);
}

/// The lamp lies exactly in the plane of the ceiling. A shadow ray that runs to the lamp's full
/// distance hits the ceiling.
TEST(Precision, ShadowRaysWithoutAnEndGapHitTheCeilingAtTheLamp) {
    scene::Scene room = test::make_lit_room(1, 1);
    const double ceiling = scene::bounds(room).hi.y;
    for (const scene::Object& object : room.objects)
        if (room.materials[object.material].emission != vec3(0))
            for (dvec3& position : room.meshes[object.mesh].positions) position.y = ceiling;
    // A faint light above the ceiling. Without it, the ceiling's shadow falls on nothing, and
    // shadow rays pass through it.
    scene::PunctualLight above{.name = "above", .intensity = vec3(1e-6f)};
    above.world_from_light[3] = dvec4(0, ceiling + 1, 0, 1);
    room.punctual.push_back(above);
    const session::TechniqueResult with = test::render_technique(room, "raytrace", {96, 96}),
                                   without = test::render_technique(
                                       room, "raytrace:without=shadow_end", {96, 96});
    std::size_t darker = 0, brighter = 0;
    for (std::size_t i = 0; i < with.hdr.pixels.size(); ++i) {
        darker += without.hdr.pixels[i].x < with.hdr.pixels[i].x;
        brighter += without.hdr.pixels[i].x > with.hdr.pixels[i].x;
    }
    std::cout << "[ MEASURED ] " << darker << " pixels in a shadow that is none\n";
    EXPECT_GT(darker, with.hdr.pixels.size() / 100);
    EXPECT_EQ(brighter, 0u);
}

} // namespace
