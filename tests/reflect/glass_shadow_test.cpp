// Tests of tinted light behind glass (`--glass-shadow tint`), by shadow maps and by shadow rays.
// The expected share of light is the product of Fresnel's equations and the base colour at each
// surface, and of e^-absorption per unit of length inside solid glass.
#include "core/shader_math.hpp"
#include "measure/lines.hpp"
#include "scene/classify.hpp"
#include "scene/hash.hpp"
#include "scene/scene_overrides.hpp"
#include "support/lit.hpp"
#include "support/rendering.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>

namespace {

using namespace catoptric;

const dvec3 kGlassTint(.9, .6, .3), kGlassAbsorption(.2, .7, 1.5);
constexpr double kGlassIor = 1.5;
/// The row `naive` lights the floor by a shadow map, and the row `raytrace` by shadow rays.
const char* const kShadowMapRow = "naive:bounces=0,face=16,shadow_map=512";
const std::array<const char*, 2> kRowsOfBothWorlds{kShadowMapRow, "raytrace"};

scene::Material make_shading_glass(bool solid = true) {
    return {.name = "glass",
            .albedo = vec3(kGlassTint),
            .roughness = 0,
            .dielectric_f0 = vec3(.04f),
            .dielectric_f90 = vec3(1),
            .transmission = 1,
            .ior = float(kGlassIor),
            .solid = solid,
            .absorption = vec3(kGlassAbsorption)};
}

/// Returns a closed box whose facets point outwards.
scene::Mesh make_closed_box(const dvec3& lo, const dvec3& hi) {
    scene::Mesh box{.name = "pane"};
    for (int face = 0; face < 6; ++face) {
        const scene::Mesh side = scene::make_box_wall(face, hi, lo);
        const auto first = static_cast<std::uint32_t>(box.positions.size());
        box.positions.insert(box.positions.end(), side.positions.begin(), side.positions.end());
        box.normals.insert(box.normals.end(), side.normals.begin(), side.normals.end());
        for (const auto& triangle : side.triangles) box.triangles.push_back(triangle + first);
    }
    return box;
}

/// Adds glass that the camera does not see, so that only the shadow of the glass changes the
/// picture.
void add_unseen_glass(scene::Scene& scene, scene::Mesh mesh, bool solid = true) {
    scene::add_mesh(scene, std::move(mesh), test::add_material(scene, make_shading_glass(solid)));
    scene.objects.back().seen_by_camera = false;
    scene::find_mirrors(scene);
}

/// Returns the floor, seen from the side, below a light that shines along `axis`.
scene::Scene make_lit_floor(scene::PunctualLight::Kind kind, const dvec3& from, const dvec3& axis) {
    scene::Scene scene = test::make_floor_scene();
    scene::PunctualLight light{.name = "light", .kind = kind, .intensity = vec3(9)};
    light.world_from_light = test::make_light_transform(from, axis);
    scene.punctual.push_back(light);
    scene.cameras.push_back({.eye = {0, .5, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = .5});
    return scene;
}

/// Returns the factor by which `--glass-shadow tint` darkens the floor, as a mean over the picture.
/// Expects the same factor in all pixels.
dvec3 measure_share_on_floor(scene::Scene scene, const std::string& technique) {
    const measure::Picture lit = test::render_without_ambient(scene, technique, {9, 9}).hdr;
    scene.tints_glass_shadows = true;
    const measure::Picture tinted = test::render_without_ambient(scene, technique, {9, 9}).hdr;
    dvec3 sum(0), least(1e9), most(0);
    for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
        const dvec3 share = dvec3(tinted.pixels[i]) / dvec3(lit.pixels[i]);
        sum += share / double(lit.pixels.size());
        least = glm::min(least, share), most = glm::max(most, share);
    }
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_LT(most[channel] - least[channel], .02 * most[channel]) << technique;
    return sum;
}

double reflected_share_at_cosine(double cosine) {
    double behind;
    return f64::fresnel_dielectric(cosine, kGlassIor, behind);
}

void expect_share(const scene::Scene& scene, const dvec3& wanted, const std::string& what,
                  double tolerance = .002) {
    for (const char* technique : kRowsOfBothWorlds) {
        const dvec3 found = measure_share_on_floor(scene, technique);
        std::cout << "[ MEASURED ] " << what << ", " << technique << ": " << found.x << ' '
                  << found.y << ' ' << found.z << ", wanted " << wanted.x << ' ' << wanted.y << ' '
                  << wanted.z << '\n';
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(found[channel], wanted[channel], tolerance * wanted[channel])
                << what << ", " << technique;
    }
}

class GlassShadow : public testing::Test {
protected:
    void SetUp() override {
        if (!test::has_blended_surfaces())
            GTEST_SKIP() << "this device refuses tinted shadows (limits/limits_test.cpp)";
    }
};

/// The middle of the picture lies under the diagonal of the pane. A shadow ray there meets two
/// triangles of each surface, but each surface must count only once.
TEST_F(GlassShadow, PaneTakesTintFresnelAndAbsorption) {
    const double thickness = .4;
    for (const dvec3& axis : {dvec3(0, -1, 0), dvec3(1, -1, 0), dvec3(.3, -1, .2)}) {
        scene::Scene scene = make_lit_floor(scene::PunctualLight::Kind::directional, {0, 9, 0},
                                            axis);
        const dvec3 above = -axis / -axis.y; // length of the way for each unit of height
        add_unseen_glass(
            scene, make_closed_box(above - dvec3(.5, 0, .5), above + dvec3(.5, thickness, .5)));
        const double cosine = -glm::normalize(axis).y,
                     passing = 1 - reflected_share_at_cosine(cosine);
        expect_share(scene,
                     kGlassTint * kGlassTint * passing * passing *
                         glm::exp(-kGlassAbsorption * thickness / cosine),
                     "sun at cosine " + std::to_string(cosine));
    }
    scene::Scene scene = make_lit_floor(scene::PunctualLight::Kind::point, {0, 2, 0}, {0, -1, 0});
    add_unseen_glass(scene, make_closed_box({-.5, 1, -.5}, {.5, 1 + thickness, .5}));
    const double passing = 1 - reflected_share_at_cosine(1);
    expect_share(scene,
                 kGlassTint * kGlassTint * passing * passing *
                     glm::exp(-kGlassAbsorption * thickness),
                 "point light");
}

/// A thin sheet of glass is one surface without an inside, so it tints the light once and absorbs
/// nothing.
TEST_F(GlassShadow, SheetTakesTintAndFresnelOnce) {
    scene::Scene scene = make_lit_floor(scene::PunctualLight::Kind::point, {0, 2, 0}, {0, -1, 0});
    add_unseen_glass(
        scene, scene::quad("sheet", {-.5, 1, .5}, {.5, 1, .5}, {.5, 1, -.5}, {-.5, 1, -.5}), false);
    const double surface = reflected_share_at_cosine(1); // an open sheet has two of them
    expect_share(scene, kGlassTint * (1 - surface) / (1 + surface), "sheet");
}

/// Glass close to a light is not clipped by the near plane of the shadow map, because the near
/// plane follows from the nearest object.
TEST_F(GlassShadow, PaneNearTheLightCounts) {
    scene::Scene scene = make_lit_floor(scene::PunctualLight::Kind::point, {0, 2, 0}, {0, -1, 0});
    add_unseen_glass(scene, make_closed_box({-.5, 1.89, -.5}, {.5, 1.99, .5}));
    const double passing = 1 - reflected_share_at_cosine(1);
    expect_share(scene,
                 kGlassTint * kGlassTint * passing * passing * glm::exp(-kGlassAbsorption * .1),
                 "pane near the light");
}

/// Light from a point inside a glass ball passes only half of the ball. The light on a board inside
/// the ball does, too.
TEST_F(GlassShadow, LightAndSurfaceInABody) {
    const dvec3 half_way = kGlassTint * (1 - reflected_share_at_cosine(1));
    scene::Scene bulb = make_lit_floor(scene::PunctualLight::Kind::point, {0, 2, 0}, {0, -1, 0});
    add_unseen_glass(bulb, scene::ball("bulb", 5));
    bulb.objects.back().world_from_object = glm::translate(dmat4(1), dvec3(0, 2, 0)) *
                                            glm::scale(dmat4(1), dvec3(.5));
    expect_share(bulb, half_way * glm::exp(-kGlassAbsorption * .5), "light in a ball", .02);

    scene::Scene board = make_lit_floor(scene::PunctualLight::Kind::directional, {0, 9, 0},
                                        {0, -1, 0});
    board.cameras.front().target = {0, .3, 0};
    test::add_quad(board, "board", 0, {-.4, .3, .4}, {.4, .3, .4}, {.4, .3, -.4}, {-.4, .3, -.4});
    add_unseen_glass(board, make_closed_box({-1, .1, -1}, {1, .8, 1}));
    expect_share(board, half_way * glm::exp(-kGlassAbsorption * .5), "surface in a box");
}

/// Shadow rays may hit the exact sphere instead of its mesh.
TEST_F(GlassShadow, BallTakesTheChordThroughIt) {
    for (const double beside : {0., .3}) {
        scene::Scene scene = make_lit_floor(scene::PunctualLight::Kind::directional, {0, 9, 0},
                                            {0, -1, 0});
        test::add_ball(scene, "ball", test::add_material(scene, make_shading_glass()),
                       {beside, 1.2, 0}, .5, 6);
        scene.objects.back().seen_by_camera = false;
        scene::find_mirrors(scene);
        scene.cameras.front().vertical_fov_degrees = .1;
        const double cosine = std::sqrt(.25 - beside * beside) / .5,
                     passing = 1 - reflected_share_at_cosine(cosine);
        const dvec3 wanted = kGlassTint * kGlassTint * passing * passing *
                             glm::exp(-kGlassAbsorption * cosine);
        expect_share(scene, wanted, "ball at " + std::to_string(beside), .02);
        const dvec3 exact = measure_share_on_floor(scene, "raytrace:sphere=exact");
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(exact[channel], wanted[channel], .002 * wanted[channel]) << beside;
    }
}

/// Shadow maps and shadow rays must agree on the light behind two glass bodies, of which one is
/// rotated and one is scaled, beside a wall and a block that cast shadows.
TEST_F(GlassShadow, ShadowMapAgreesWithShadowRays) {
    for (const auto kind :
         {scene::PunctualLight::Kind::directional, scene::PunctualLight::Kind::point}) {
        scene::Scene scene = test::make_yard_scene();
        scene::PunctualLight light{.name = "light", .kind = kind, .intensity = vec3(6)};
        light.world_from_light = test::make_light_transform({-1.5, 3, 1.5}, {1.2, -2.5, -1});
        scene.punctual.push_back(light);
        add_unseen_glass(scene, scene::ball("glass ball", 5));
        scene.objects.back().world_from_object = glm::translate(dmat4(1), dvec3(.2, 1.1, .8)) *
                                                 glm::scale(dmat4(1), dvec3(.5, .3, .4));
        add_unseen_glass(scene, make_closed_box({-.4, -.4, -.1}, {.4, .4, .1}));
        scene.objects.back().world_from_object = glm::rotate(
            glm::translate(dmat4(1), dvec3(-.9, 1.3, .9)), .7, dvec3(1, 2, .5));
        scene.tints_glass_shadows = true;
        const uvec2 size(96, 72);
        const auto render = [&](const std::string& technique) {
            return test::render_without_ambient(scene, technique, size).hdr;
        };
        const measure::Picture raster = render("naive:bounces=0,face=16"),
                               traced = render("raytrace"), lit = render("raytrace:shadow=none");
        // The outlines of the glass's shadow count as shadow edges as well, because light changes
        // there in one step.
        measure::Mask edges = test::mask_shadow_edges(lit, traced);
        scene.tints_glass_shadows = false;
        const measure::Picture untinted = render("raytrace");
        for (const measure::Mask& more :
             {test::mask_shadow_edges(lit, untinted), test::mask_shadow_edges(untinted, traced)})
            for (std::size_t i = 0; i < edges.size(); ++i) edges[i] |= more[i];
        double tinted = 0, largest = 0;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            if (edges[i] != 0) continue;
            tinted += test::max_channel_difference(untinted.pixels[i], traced.pixels[i]) > .02f;
            largest = std::max<double>(
                largest, test::max_channel_difference(raster.pixels[i], traced.pixels[i]));
        }
        const double off = test::share_of_off_pixels(raster, traced, edges);
        std::cout << "[ MEASURED ] " << tinted << " tinted pixels, share off " << off
                  << ", largest difference " << largest << '\n';
        EXPECT_GT(tinted, 50);
        EXPECT_LE(off, .01);
    }
}

/// Techniques that trace only some pixels must trace the pixels behind glass.
TEST_F(GlassShadow, RowsThatMixRasterAndRaysAgreeWithRays) {
    scene::Scene scene = make_lit_floor(scene::PunctualLight::Kind::point, {0, 2, 0}, {0, -1, 0});
    scene.cameras.front().vertical_fov_degrees = 40;
    add_unseen_glass(scene, make_closed_box({-.5, 1, -.5}, {.3, 1.4, .6}));
    scene.tints_glass_shadows = true;
    const measure::Picture traced = test::render_without_ambient(scene, "raytrace", {48, 48}).hdr;
    for (const char* technique : {"raytrace:first=raster", "hybrid:face=16"}) {
        const measure::Picture mixed = test::render_without_ambient(scene, technique, {48, 48}).hdr;
        std::size_t off = 0;
        for (std::size_t i = 0; i < mixed.pixels.size(); ++i)
            off += test::max_channel_difference(mixed.pixels[i], traced.pixels[i]) > .01f;
        EXPECT_LE(off, std::string(technique) == "hybrid:face=16" ? 60u : 3u) << technique;
    }
}

TEST(GlassShadowOverride, SetsTheSceneAndItsGap) {
    scene::Scene scene = test::make_floor_scene();
    scene.unsupported.push_back(
        {.id = "glass-shadow", .count = 1, .first = "pane", .materials = {}});
    scene::SceneOverrides overrides;
    scene::apply_overrides(scene, overrides);
    EXPECT_FALSE(scene.tints_glass_shadows);
    EXPECT_EQ(scene.unsupported.front().id, "glass-shadow");
    overrides.tints_glass_shadows = true;
    scene::apply_overrides(scene, overrides);
    EXPECT_TRUE(scene.tints_glass_shadows);
    EXPECT_EQ(scene.unsupported.front().id, "glass-shadow-straight");
}

/// The option `--glass-shadow` must not change scenes without glass. With the value `none` it
/// changes neither pictures nor scene hashes.
TEST_F(GlassShadow, ChangesNothingElse) {
    scene::Scene scene = test::make_lit_room(1, 1), glassy = scene;
    scene::add_mesh(glassy, make_closed_box({-.5, 0, -.5}, {.5, .2, .5}),
                    test::add_material(glassy, make_shading_glass()));
    scene::find_mirrors(glassy);
    const std::string hash = scene::hash_scene(scene);
    for (const char* technique : {"secant:face=32", "raytrace"}) {
        scene.tints_glass_shadows = false;
        const measure::Picture before = test::render_technique(scene, technique, {32, 32}, 2).hdr;
        scene.tints_glass_shadows = true;
        EXPECT_EQ(test::render_technique(scene, technique, {32, 32}, 2).hdr.pixels, before.pixels)
            << technique;
        glassy.tints_glass_shadows = true;
        const measure::Picture tinted = test::render_technique(glassy, technique, {32, 32}, 2).hdr;
        glassy.tints_glass_shadows = false;
        EXPECT_NE(test::render_technique(glassy, technique, {32, 32}, 2).hdr.pixels, tinted.pixels)
            << technique;
    }
    EXPECT_NE(scene::hash_scene(scene), hash);
    scene.tints_glass_shadows = false;
    EXPECT_EQ(scene::hash_scene(scene), hash);
}

} // namespace
