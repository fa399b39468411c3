// Tests of blended surfaces (Material::blended), against formulas and against ray tracing.
#include "scene/build.hpp"
#include "scene/pattern.hpp"
#include "support/lit.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"
#include "support/scenes.hpp"
#include "support/special_values.hpp"

#include <iostream>

namespace {

using namespace catoptric;

scene::Material make_transparent_sheet_material(const char* name, vec3 emission, float alpha) {
    return {.name = name,
            .albedo = vec3(0),
            .emission = emission,
            .two_sided = true,
            .alpha = alpha,
            .alpha_cutoff = .5f,
            .blended = true};
}

/// Returns a scene of two emitting, half-transparent sheets ("veils") in front of an emitting wall.
/// The nearest sheet is listed first, so drawing objects in the order of the list would be wrong.
scene::Scene make_two_transparent_sheets() {
    scene::Scene scene{.name = "veils"};
    const auto add = [&](const char* name, scene::Material material, double z) {
        test::add_quad(scene, name, test::add_material(scene, std::move(material)), {-9, -9, z},
                       {9, -9, z}, {9, 9, z}, {-9, 9, z});
    };
    add("near", make_transparent_sheet_material("red", {.8f, 0, 0}, .25f), 1);
    add("far", make_transparent_sheet_material("green", {0, .8f, 0}, .75f), 0);
    add("wall", {.name = "wall", .emission = {.1f, .2f, .8f}}, -3);
    scene.cameras.push_back({.eye = {0, 0, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
    return scene;
}

/// Returns what that scene's camera sees. A device that cannot blend shows the nearest sheet whose
/// alpha is not below the cutoff.
vec3 colour_of_two_sheets(float cutoff = .5f) {
    const vec3 red(.8f, 0, 0), green(0, .8f, 0), wall(.1f, .2f, .8f);
    if (test::has_blended_surfaces()) return .25f * red + .75f * (.75f * green + .25f * wall);
    return cutoff > .25f ? green : red;
}

TEST(Blending, VeilsCoverWhatIsBehindThemInOrder) {
    const vec3 wanted = colour_of_two_sheets();
    for (const char* technique : {"naive:bounces=0", "secant", "hybrid:force=unknown", "raytrace",
                                  "raytrace:first=raster", "raytrace:rays=64,indirect=paths"}) {
        const vec3 seen = test::render_without_ambient(make_two_transparent_sheets(), technique,
                                                       {1, 1})
                              .hdr.at(0, 0);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(seen[channel], wanted[channel], 1e-5) << technique << " " << channel;
    }
}

/// Returns a room with half-transparent sheets ("veils") at random places, with alpha from 1/512 to
/// 1.
scene::Scene make_room_with_transparent_sheets(std::uint64_t seed, bool has_mirrors) {
    scene::Scene scene = test::make_lit_room(has_mirrors ? 2 : 0, 1);
    test::RandomNumbers numbers(seed);
    const auto draw = [&](double low, double high) {
        return low + (high - low) * double(numbers.random_unit_fraction());
    };
    for (int k = 0; k < 4; ++k) {
        scene::Material veil{.name = "veil " + std::to_string(k),
                             .albedo = {float(draw(.1, .9)), float(draw(.1, .9)), .5f},
                             .two_sided = true,
                             .unlit = k % 2 == 0,
                             .alpha = float(draw(.1, .95)),
                             .alpha_cutoff = .5f,
                             .blended = true};
        if (k == 0) {
            veil.alpha = 1;
            veil.albedo_texture = scene::make_checker_texture({250, 90, 60}, {60, 90, 250}, 8);
        }
        const std::size_t material = test::add_material(scene, veil);
        const dvec3 low(draw(-1.4, .2), draw(-1.4, .2), draw(-1, .5));
        test::add_quad(scene, veil.name, material, low, low + dvec3(1.2, 0, draw(-.1, .1)),
                       low + dvec3(1.2, 1.2, draw(-.1, .1)), low + dvec3(0, 1.2, 0));
        scene.objects.back().name = veil.name;
    }
    return scene;
}

TEST(Blending, RasterShowsWhatRaysShow) {
    const uvec2 size{64, 48};
    int off = 0, all = 0, other = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        scene::Scene scene = make_room_with_transparent_sheets(seed, false);
        scene::Scene without = scene;
        for (scene::Material& material : without.materials)
            if (material.blended) material.blended = false; // cut out where alpha is below .5
        const measure::Picture raster = test::render_technique(scene, "naive:bounces=0", size).hdr,
                               cut = test::render_technique(without, "naive:bounces=0", size).hdr,
                               traced = test::render_technique(scene, "raytrace", size).hdr,
                               listed =
                                   test::render_technique(scene, "raytrace:first=raster", size).hdr;
        for (std::size_t i = 0; i < raster.pixels.size(); ++i) {
            ++all;
            off += test::max_channel_difference(raster.pixels[i], traced.pixels[i]) > .02f ||
                   test::max_channel_difference(listed.pixels[i], traced.pixels[i]) > .02f;
            other += test::max_channel_difference(cut.pixels[i], raster.pixels[i]) > .02f;
        }
    }
    std::cout << "[ MEASURED ] " << off << " of " << all << " pixels off, " << other
              << " other than cut at half\n";
    EXPECT_LE(off, all / 50); // pixels at outlines and shadow edges
    if (test::has_blended_surfaces())
        EXPECT_GT(other, all / 30);
    else
        EXPECT_EQ(other, 0);
}

/// A capture shows a half-transparent sheet (a "veil") together with the surface behind it.
TEST(Blending, CapturesShowVeils) {
    const uvec2 size{64, 48};
    const scene::Scene scene = make_room_with_transparent_sheets(5, true);
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace", size);
    const measure::Picture found = test::render_technique(scene, "pyramid", size, 6).hdr;
    int off = 0, mirrors = 0;
    for (std::size_t i = 0; i < traced.hits.size(); ++i) {
        if (!measure::first_mirror(traced.hits[i])) continue;
        ++mirrors;
        off += test::max_channel_difference(found.pixels[i], traced.hdr.pixels[i]) > .1f;
    }
    std::cout << "[ MEASURED ] " << off << " of " << mirrors << " pixels of mirrors off\n";
    EXPECT_GT(mirrors, test::has_blended_surfaces() ? 100 : 50); // opaque veils hide more of them
    EXPECT_LE(off, mirrors / 5);
}

/// A half-transparent sheet (a "veil") must cover the sky, although the sky is drawn after all
/// opaque surfaces.
TEST(Blending, VeilsCoverTheSky) {
    scene::Scene scene = make_two_transparent_sheets();
    scene.objects.pop_back(); // removes the wall
    auto sky = std::make_shared<scene::Environment>();
    sky->size = {16, 8};
    sky->texels.assign(16 * 8, vec3(.1f, .2f, .8f));
    scene.environment = sky;
    for (const float cutoff : {.5f, 0.f}) {
        for (scene::Material& material : scene.materials)
            if (material.blended) material.alpha_cutoff = cutoff;
        const vec3 wanted = colour_of_two_sheets(cutoff);
        for (const char* technique : {"naive:bounces=0", "raytrace", "raytrace:first=raster"}) {
            const vec3 seen = test::render_without_ambient(scene, technique, {1, 1}).hdr.at(0, 0);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(seen[channel], wanted[channel], 1e-4)
                    << technique << " " << channel << ", cutoff " << cutoff;
        }
    }
}

/// Rays of `first=raster` start at the triangle that the rasteriser drew. This must not be a
/// triangle of a half-transparent sheet (a "veil").
TEST(Blending, TracedMirrorsBehindVeilsAreRight) {
    const uvec2 size{64, 48};
    scene::Scene scene = test::make_lit_room(2, 1);
    scene::Material veil = make_transparent_sheet_material("veil", {0, 0, 0}, .4f);
    veil.emission = vec3(0), veil.albedo = {.9f, .5f, .1f}, veil.unlit = true;
    veil.dielectric_f0 = vec3(.04f), veil.dielectric_f90 = vec3(1), veil.roughness = .8f;
    test::add_quad(scene, "veil", test::add_material(scene, veil), {-1.5, -1.8, -1.2},
                   {1.5, -1.8, -1.2}, {1.5, .6, -1.2}, {-1.5, .6, -1.2});
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace:depth=4", size);
    std::size_t mirrors = 0;
    for (const std::uint32_t hit : traced.hits) mirrors += bool(measure::first_mirror(hit));
    EXPECT_GT(mirrors, 300u) << "the mask shows mirrors behind the veil";
    for (const char* technique :
         {"hybrid:force=unknown", "1=raytrace:depth=4,first=raster *=hybrid:force=unknown"}) {
        const measure::Picture found = test::render_technique(scene, technique, size, 4).hdr;
        int off = 0;
        for (std::size_t i = 0; i < found.pixels.size(); ++i)
            off += test::max_channel_difference(found.pixels[i], traced.hdr.pixels[i]) > .05f;
        EXPECT_LE(off, int(found.pixels.size()) / 50) << technique;
    }
}

/// For an orthographic camera, the order of half-transparent sheets ("veils") does not depend on
/// the camera's position.
TEST(Blending, VeilsAreSortedInParallelViews) {
    scene::Scene scene = make_two_transparent_sheets();
    const vec3 wanted = colour_of_two_sheets();
    scene.cameras.front().orthographic_height = .1;
    for (const dvec3& eye : {dvec3(0, 0, 4), dvec3(5, -3, 4)}) {
        scene.cameras.front().eye = eye;
        scene.cameras.front().target = eye - dvec3(0, 0, 4);
        for (const char* technique : {"naive:bounces=0", "raytrace"}) {
            const vec3 seen = test::render_without_ambient(scene, technique, {1, 1}).hdr.at(0, 0);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(seen[channel], wanted[channel], 1e-5) << technique << " " << channel;
        }
    }
}

/// A mirrored view is clipped at the mirror's plane. The mirror must show a half-transparent sheet
/// (a "veil") in front of it, and no sheet behind it.
TEST(Blending, FlatMirrorsShowVeilsBeforeThem) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "flat", .mirror = true});
    test::add_quad(scene, "flat", mirror, {-1.6, -1.6, 1}, {-1.6, 1.6, 1}, {1.6, 1.6, 1},
                   {1.6, -1.6, 1});
    for (const double z : {-.5, 1.5}) {
        scene::Material veil = make_transparent_sheet_material(z < 1 ? "before" : "behind", vec3(0),
                                                               .5f);
        veil.albedo = {.9f, .4f, .1f}, veil.unlit = true;
        test::add_quad(scene, veil.name, test::add_material(scene, veil), {-.3, -1.5, z},
                       {1.5, -1.5, z}, {1.5, .9, z}, {-.3, .9, z});
    }
    const uvec2 size{64, 64};
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace", size);
    scene::Scene without = scene;
    for (scene::Material& material : without.materials) material.alpha = material.blended ? 0 : 1;
    const measure::Mask mask = measure::mask_mirrors(traced.hits);
    const auto error = [&](const scene::Scene& of) {
        return test::rmse_of_pictures(test::render_technique(of, "planar", size, 2).hdr, traced.hdr,
                                      mask);
    };
    const double found = error(scene), invisible = error(without);
    std::cout << "[ MEASURED ] veils in a flat mirror: rmse " << found << ", without veils "
              << invisible << '\n';
    EXPECT_GT(measure::count_pixels(mask), 500u);
    // Opaque veils of alpha .5 hide the part of the mirror that would show them.
    EXPECT_LT(found, test::has_blended_surfaces() ? .1 * invisible : 1e-5);
}

/// Where a blended surface has an alpha of 1, it hides all objects behind it, in whatever order
/// objects are drawn.
TEST(Blending, AlphaOfOneIsOpaque) {
    scene::Scene scene = make_two_transparent_sheets();
    scene.materials[0].alpha = 1;
    for (const char* technique : {"naive:bounces=0", "raytrace"}) {
        const vec3 seen = test::render_without_ambient(scene, technique, {1, 1}).hdr.at(0, 0);
        EXPECT_NEAR(seen.x, .8, 1e-5) << technique;
        EXPECT_NEAR(seen.y, 0, 1e-5) << technique;
    }
}

} // namespace
