// Tests of `planar`, which draws flat mirrors with mirrored views, against ray tracing.
#include "compare.hpp"
#include "core/mirror_id.hpp"
#include "scene/material_facts.hpp"
#include "scene/shapes.hpp"
#include "study/compare_checks.hpp"
#include "support/lit.hpp"
#include "support/paths.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <iostream>
#include <memory>

namespace {

using namespace catoptric;

/// Adds a material of a mirror with this reflectance in all channels.
std::size_t add_mirror_material(scene::Scene& scene, float reflectance = 1) {
    return test::add_material(scene,
                              {.name = "mirror", .mirror = true, .reflectance = vec3(reflectance)});
}

/// Returns the built-in scene with one flat mirror at z = 2.98, plus the objects that `more` names.
scene::Scene make_scene_with_flat_mirror(const std::string& more = "") {
    scene::Scene scene = scene::load("flat");
    scene.name += more;
    if (more == " parallel")
        test::add_quad(scene, "behind", add_mirror_material(scene), {-1.3, .5, -2.98},
                       {1.3, .5, -2.98}, {1.3, 2.1, -2.98}, {-1.3, 2.1, -2.98});
    if (more == " orthogonal") {
        test::add_quad(scene, "beside", add_mirror_material(scene), {1.999, .5, 2.9},
                       {1.999, .5, .5}, {1.999, 2.1, .5}, {1.999, 2.1, 2.9});
        test::add_quad(scene, "below", add_mirror_material(scene), {-1.3, .001, 1.9},
                       {1.3, .001, 1.9}, {1.3, .001, 2.9}, {-1.3, .001, 2.9});
    }
    if (more == " touched") {
        const std::size_t red = test::add_material(scene,
                                                   {.name = "red", .albedo = {.7f, .2f, .1f}});
        test::add_ball(scene, "ball", red, {-.3, 1.3, 2.68}, .3, 5);
        scene.objects.back().sphere.reset();
    }
    return scene;
}

/// Returns a mask of the pixels beside an outline of a mirror, of a lamp, or of an object seen in a
/// mirror. Finds outlines by ray tracing the scene with each object painted in its own colour, all
/// walls in the same.
measure::Mask mask_pixels_beside_outlines(scene::Scene scene,
                                          const std::vector<std::uint32_t>& hits, uvec2 size) {
    float next = 1;
    for (scene::Object& object : scene.objects) {
        if (scene::is_mirror(scene, object)) continue;
        const bool is_lamp = scene::is_visibly_emissive(scene.materials[object.material]);
        const bool is_wall = !is_lamp && scene.meshes[object.mesh].triangles.size() == 2;
        object.material = test::add_material(
            scene, {.name = "painted", .emission = vec3(is_wall ? 1 : ++next)});
    }
    const measure::Picture painted =
        test::render_technique(scene, "raytrace:depth=1,shadow=none", size).hdr;
    const int width = painted.width;
    const auto differ = [&](int a, int b) {
        return painted.pixels[a] != painted.pixels[b] ||
               measure::first_mirror(hits[a]) != measure::first_mirror(hits[b]);
    };
    measure::Mask beside(painted.pixels.size(), 0);
    for (int i = 0; i < int(beside.size()); ++i) {
        const int x = i % width;
        const bool right = x + 1 < width && differ(i, i + 1),
                   below = i + width < int(beside.size()) && differ(i, i + width);
        if (right) beside[i] = beside[i + 1] = 255;
        if (below) beside[i] = beside[i + width] = 255;
    }
    return beside;
}

/// Returns the share of the mask's pixels that are off.
double share_of_masked_pixels_off(const measure::Picture& a, const measure::Picture& b,
                                  const measure::Mask& mask) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < mask.size(); ++i)
        off += mask[i] && !(test::max_channel_difference(a.pixels[i], b.pixels[i]) <=
                            float(measure::kMaxInvisibleDifference));
    return double(off) / double(measure::count_pixels(mask));
}

struct PlanarComparison {
    double share_off, mae, rmse, left_out;
};

/// Compares the first-order pixels with ray tracing, except those in the mask `left_out`.
PlanarComparison compare_first_order_pixels(const session::TechniqueResult& planar,
                                            const session::TechniqueResult& truth,
                                            const measure::Mask& left_out) {
    measure::Mask mask = measure::mask_first_order(truth.hits);
    const double whole = double(measure::count_pixels(mask));
    EXPECT_GT(whole, 2000);
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (left_out[i]) mask[i] = 0;
    const std::vector<float> no_flip(truth.hdr.pixels.size(), 0.0f);
    const measure::Difference found = measure::difference(planar.hdr, truth.hdr, mask, no_flip);
    return {share_of_masked_pixels_off(planar.hdr, truth.hdr, mask), found.mae, found.rmse,
            1 - double(measure::count_pixels(mask)) / whole};
}

void print_planar_comparison(const std::string& what, const PlanarComparison& found) {
    std::cout << "[ MEASURED ] " << what << ": share off " << found.share_off << ", MAE "
              << found.mae << ", rmse " << found.rmse << ", left out " << found.left_out << "\n";
}

/// Differences at shadow edges come from the shadow map, so they do not count against `planar`.
TEST(Planar, FlatMirrorsEqualRayTracing) {
    constexpr uvec2 size(512);
    scene::Scene low = make_scene_with_flat_mirror(" from below");
    low.cameras.front() = low.cameras.at(1);
    for (const scene::Scene& scene :
         {make_scene_with_flat_mirror(), low, make_scene_with_flat_mirror(" parallel"),
          make_scene_with_flat_mirror(" orthogonal"), make_scene_with_flat_mirror(" touched")}) {
        const session::TechniqueResult truth = test::render_technique(scene, study::kReference,
                                                                      size),
                                       planar = test::render_technique(scene, "planar", size),
                                       lit = test::render_technique(
                                           scene, "raytrace:depth=16,shadow=none", size);
        const PlanarComparison whole = compare_first_order_pixels(
            planar, truth, measure::Mask(truth.hits.size(), 0));
        print_planar_comparison(scene.name + ", nothing left out", whole);
        EXPECT_LE(whole.share_off, .003) << scene.name;
        EXPECT_LE(whole.mae, .0003) << scene.name;
        EXPECT_LE(whole.rmse, .0025) << scene.name;
        measure::Mask left_out = mask_pixels_beside_outlines(scene, truth.hits, size);
        const PlanarComparison found = compare_first_order_pixels(planar, truth, left_out);
        print_planar_comparison(scene.name, found);
        EXPECT_LE(found.share_off, .001) << scene.name;
        EXPECT_LE(found.mae, .00005) << scene.name;
        EXPECT_LE(found.rmse, .0016) << scene.name;
        EXPECT_LE(found.left_out, .07) << scene.name << ": lines, two pixels wide";
        const measure::Mask shadows = test::mask_shadow_edges(lit.hdr, truth.hdr);
        for (std::size_t i = 0; i < left_out.size(); ++i)
            if (shadows[i]) left_out[i] = 255;
        const PlanarComparison away = compare_first_order_pixels(planar, truth, left_out);
        print_planar_comparison(scene.name + ", away from shadow edges", away);
        EXPECT_EQ(away.share_off, 0) << scene.name;
        EXPECT_LE(away.rmse, test::computes_like_cpp() ? 1e-6 : 1e-5) << scene.name;
        EXPECT_LE(away.left_out, .15) << scene.name;
    }
}

constexpr uvec2 kSmallPlanarPictureSize{96, 96};

/// A wall mirror modelled as a thin closed box must look like a quad at the place of its front. The
/// edges of the box are drawn as well where they are visible.
TEST(Planar, ThinBoxEqualsTheQuadOfItsFront) {
    constexpr uvec2 size(192);
    scene::Scene quad = make_scene_with_flat_mirror();
    const std::size_t index = scene::mirrors(quad).front();
    const Bounds<double> bounds = scene::bounds(quad, quad.objects[index]);
    const auto rmse_of = [&](const scene::Scene& scene) {
        const session::TechniqueResult truth = test::render_technique(scene, study::kReference,
                                                                      size),
                                       planar = test::render_technique(scene, "planar", size);
        EXPECT_EQ(planar.plan.front().technique, "planar");
        EXPECT_THAT(planar.notes, testing::IsEmpty());
        return compare_first_order_pixels(planar, truth, measure::Mask(truth.hits.size(), 0)).rmse;
    };
    for (const scene::Camera& camera : {quad.cameras.at(0), quad.cameras.at(1)}) {
        quad.cameras.front() = camera;
        scene::Scene board = quad;
        const dvec3 low = bounds.lo, high = bounds.hi;
        board.meshes[board.objects[index].mesh] = scene::box("board", {low.x, low.y, low.z},
                                                             {high.x, high.y, high.z + .01});
        board.objects[index].world_from_object = dmat4(1);
        const double of_quad = rmse_of(quad), of_board = rmse_of(board);
        std::cout << "[ MEASURED ] rmse of a quad " << of_quad << ", of a board " << of_board
                  << "\n";
        EXPECT_LE(of_board, 1.2 * of_quad + 1e-4);
    }
}

/// A note must name each mirror that `planar` cannot draw and the technique that draws it instead.
TEST(Planar, NoteNamesMirrorsDrawnByAnotherTechnique) {
    const scene::Scene hall = test::make_mirror_hall();
    const session::TechniqueResult part = test::render_technique(hall, "planar",
                                                                 kSmallPlanarPictureSize, 2);
    ASSERT_EQ(part.notes.size(), 1u);
    EXPECT_THAT(part.notes[0], testing::MatchesRegex("mirror 1 '.*': not flat, drawn by reuse"));
}

/// Two mirrors of reflectance .8 face each other in a box that emits radiance 1. A ray that meets k
/// mirrors brings .8^k, up to the requested number of bounces.
TEST(Planar, MirrorsInMirrorsHaveTheRequestedDepth) {
    scene::Scene scene{.name = "corridor"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), hot);
    const std::size_t mirror = add_mirror_material(scene, .8f);
    test::add_quad(scene, "left", mirror, {-2, -2, -2}, {-2, -2, 4}, {-2, 2, 4}, {-2, 2, -2});
    test::add_quad(scene, "right", mirror, {2, -2, -2}, {2, 2, -2}, {2, 2, 4}, {2, -2, 4});
    scene.cameras = {{.eye = {0, 0, -1.9}, .target = {1.9, .1, -1.2}, .vertical_fov_degrees = 60}};
    for (const int bounces : {0, 1, 2, 5}) {
        const std::string number = std::to_string(bounces);
        const session::TechniqueResult planar = test::render_technique(
                                           scene, "planar:shadow=none,bounces=" + number,
                                           kSmallPlanarPictureSize),
                                       truth = test::render_technique(
                                           scene, "raytrace:shadow=none,depth=" + number,
                                           kSmallPlanarPictureSize);
        EXPECT_LE(share_of_masked_pixels_off(planar.hdr, truth.hdr, measure::mask_all(truth.hits)),
                  .01)
            << bounces;
        int deepest = -1;
        for (const vec3& pixel : planar.hdr.pixels) {
            if (pixel.x == 0) continue;
            const int k = int(std::lround(std::log(double{pixel.x}) / std::log(.8)));
            EXPECT_NEAR(pixel.x, std::pow(.8, k), 1e-5);
            deepest = std::max(deepest, k);
        }
        EXPECT_EQ(deepest, bounces);
        EXPECT_EQ(planar.scene_passes, 1 + bounces) << "a view for each";
    }
}

/// Counts the scene passes R: two, plus one for each mirrored view. A mirror out of sight needs no
/// view, and neither does a mirror that cannot be seen in another mirror.
TEST(Planar, OnlyVisibleMirrorsGetViews) {
    EXPECT_EQ(
        test::render_technique(make_scene_with_flat_mirror(), "planar", kSmallPlanarPictureSize)
            .scene_passes,
        3);
    EXPECT_EQ(test::render_technique(make_scene_with_flat_mirror(" parallel"), "planar:bounces=1",
                                     kSmallPlanarPictureSize)
                  .scene_passes,
              3);
    EXPECT_EQ(test::render_technique(make_scene_with_flat_mirror(" parallel"), "planar",
                                     kSmallPlanarPictureSize)
                  .scene_passes,
              4);
    EXPECT_EQ(test::render_technique(make_scene_with_flat_mirror(" parallel"), "planar:bounces=4",
                                     kSmallPlanarPictureSize)
                  .scene_passes,
              6);
    scene::Scene away = make_scene_with_flat_mirror();
    std::swap(away.cameras.front().eye, away.cameras.front().target);
    EXPECT_EQ(test::render_technique(away, "planar", kSmallPlanarPictureSize).scene_passes, 2);
}

TEST(Planar, CutOutPartOfAMirrorShowsWhatIsBehind) {
    scene::Scene scene = make_scene_with_flat_mirror();
    const scene::Object& object = *std::ranges::find(scene.objects, "mirror", &scene::Object::name);
    auto halves = std::make_shared<scene::Image>();
    halves->name = "halves", halves->size = {2, 1}, halves->texels = {0x00ffffffu, 0xffffffffu};
    scene.meshes[object.mesh].uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    scene::Material& material = scene.materials[object.material];
    material.alpha_cutoff = .5f;
    material.albedo_texture = scene::Texture{.image = halves, .nearest = true};
    const measure::Picture
        planar = test::render_technique(scene, "planar", kSmallPlanarPictureSize).hdr,
        truth = test::render_technique(scene, "raytrace", kSmallPlanarPictureSize).hdr;
    const measure::Mask all(truth.pixels.size(), 255);
    EXPECT_LE(share_of_masked_pixels_off(planar, truth, all), .03);
}

/// Tests a mirror seen from the front, from behind and by an orthographic camera. Objects behind
/// the mirror's plane must not appear in the mirror.
TEST(Planar, BothSidesReflectAndHideWhatIsBehindThePlane) {
    scene::Scene scene = test::make_yard_scene();
    scene.punctual.push_back(
        {.kind = scene::PunctualLight::Kind::directional,
         .intensity = vec3(2),
         .world_from_light = test::make_light_transform({0, 0, 0}, {-.4, -1, -.6})});
    test::add_quad(scene, "screen", add_mirror_material(scene), {-1.5, 0, -.4}, {1.8, 0, .6},
                   {1.8, 1.4, .6}, {-1.5, 1.4, -.4});
    const scene::Camera before{
        .eye = {.4, 1.2, 4}, .target = {0, .5, 0}, .vertical_fov_degrees = 45},
        behind{.eye = {.2, 1.3, -4}, .target = {0, .5, 0}, .vertical_fov_degrees = 45};
    scene::Camera parallel = before;
    parallel.orthographic_height = 3;
    for (const scene::Camera& camera : {before, behind, parallel}) {
        scene.cameras = {camera};
        const uvec2 size(160, 128);
        const session::TechniqueResult truth = test::render_without_ambient(scene, "raytrace",
                                                                            size),
                                       lit = test::render_without_ambient(
                                           scene, "raytrace:shadow=none", size),
                                       planar = test::render_without_ambient(scene, "planar", size);
        measure::Mask mask = measure::mask_mirrors(truth.hits);
        const measure::Mask shadows = test::mask_shadow_edges(lit.hdr, truth.hdr),
                            outlines = mask_pixels_beside_outlines(scene, truth.hits, size);
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (shadows[i] || outlines[i]) mask[i] = 0;
        EXPECT_GT(measure::count_pixels(mask), 1500u);
        EXPECT_LE(share_of_masked_pixels_off(planar.hdr, truth.hdr, mask), .003)
            << "eye at z " << camera.eye.z;
    }
}

/// Mirrors that are not flat must be drawn by the technique that the knob `rest` names, with the
/// same result as in a plan.
TEST(Planar, CurvedMirrorsAreDrawnByTheTechniqueOfRest) {
    const scene::Scene hall = test::make_mirror_hall();
    const session::TechniqueResult planar = test::render_technique(hall, "planar:rest=secant",
                                                                   kSmallPlanarPictureSize, 3),
                                   plan = test::render_technique(hall, "1=secant *=planar",
                                                                 kSmallPlanarPictureSize, 3);
    EXPECT_TRUE(test::have_equal_pixel_bytes(planar.hdr, plan.hdr));
    ASSERT_EQ(planar.plan.size(), 3u);
    EXPECT_EQ(planar.plan[0].technique, "secant");
    EXPECT_THAT(
        planar.plan[0].why,
        testing::MatchesRegex("planar draws flat mirrors, and this is not flat: rest=secant"));
    EXPECT_EQ(planar.plan[1].technique, "planar") << "a block, whose faces are flat";
    EXPECT_EQ(planar.plan[2].technique, "planar");
    EXPECT_EQ(planar.plan[2].why, "one technique was asked for");
    const session::TechniqueResult dark = test::render_technique(hall, "planar:shadow=none",
                                                                 kSmallPlanarPictureSize, 3),
                                   all_dark = test::render_technique(
                                       hall, "1=reuse:shadow=none *=planar:shadow=none",
                                       kSmallPlanarPictureSize, 3);
    EXPECT_TRUE(test::have_equal_pixel_bytes(dark.hdr, all_dark.hdr)) << "shadows are the row's";
}

/// Curved mirrors seen in a flat mirror are drawn by their own technique, from the mirrored view.
/// The test judges the pixels of the flat panel that show another mirror: the ball, or the block.
TEST(Planar, CurvedMirrorInAFlatMirrorIsDrawnByItsTechnique) {
    constexpr uvec2 size{160, 160};
    const scene::Scene hall = test::make_mirror_hall();
    const session::TechniqueResult truth = test::render_technique(hall, study::kReference, size);
    measure::Mask ball = measure::mask_mirror_in_mirror(truth.hits);
    const measure::Mask panel = measure::mask_one_mirror(truth.hits, MirrorId(3));
    for (std::size_t i = 0; i < ball.size(); ++i)
        if (!panel[i]) ball[i] = 0;
    EXPECT_GT(measure::count_pixels(ball), 300u);
    const double black = test::rmse_of_pictures(
        test::render_technique(hall, "planar:bounces=0", size).hdr, truth.hdr, ball);
    for (const std::string rest : {"secant", "hybrid", "raytrace"}) {
        session::Request asked = test::make_test_request(hall, {"planar:bounces=4,rest=" + rest},
                                                         size);
        asked.with_lookup = false;
        const double off = test::rmse_of_pictures(test::render_last_frame(asked, 5).front().hdr,
                                                  truth.hdr, ball);
        std::cout << "[ MEASURED ] a ball in a flat mirror by " << rest << ": rmse " << off
                  << ", black " << black << "\n";
        EXPECT_LT(off, .2 * black) << rest;
    }
}

/// The scene is a tiny block just above a large mirror, which gets an object space of its own.
TEST(Planar, TinyObjectAboveALargeMirrorIsPrecise) {
    scene::Scene scene{.name = "grain"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(.25f)}),
                      red = test::add_material(scene, {.name = "red", .emission = {.9f, .1f, .1f}});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), hot);
    test::add_quad(scene, "mirror", add_mirror_material(scene), {-2, -2, 0}, {2, -2, 0}, {2, 2, 0},
                   {-2, 2, 0});
    test::add_mesh(scene, scene::box("grain", dvec3(-1e-4), dvec3(1e-4)), red);
    scene.objects.back().world_from_object[3] = dvec4(1.5, .3, 3e-4, 1);
    scene.cameras = {
        {.eye = {1.5, .9, .8}, .target = {1.5, .3, 1e-4}, .vertical_fov_degrees = .08}};
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace:shadow=none",
                                                                  kSmallPlanarPictureSize),
                                   planar = test::render_technique(scene, "planar:shadow=none",
                                                                   kSmallPlanarPictureSize);
    const measure::Mask mask = measure::mask_mirrors(truth.hits);
    const auto is_red = [](const vec3& pixel) { return pixel.x > .5f; };
    EXPECT_GT(std::ranges::count_if(truth.hdr.pixels, is_red), 400) << "the grain and its image";
    EXPECT_GT(measure::count_pixels(mask), 2000u);
    EXPECT_LE(share_of_masked_pixels_off(planar.hdr, truth.hdr, mask), .002);
}

/// Without a list of techniques, a comparison includes `planar` if some mirror is flat.
TEST(Planar, ComparisonIncludesPlanarIfAMirrorIsFlat) {
    const auto rows_of = [](const char* name) {
        const scene::Scene scene = scene::load(name);
        return study::default_techniques(
            test::make_test_request(scene, {}, kSmallPlanarPictureSize));
    };
    for (const char* name : {"flat", "room", "gallery"})
        EXPECT_THAT(rows_of(name), testing::Contains("planar")) << name;
    for (const char* name : {"cornell-mirrors", "courtyard"})
        EXPECT_THAT(rows_of(name), testing::Not(testing::Contains("planar"))) << name;
}

/// Mirrored views change between frames in flight while the scene stays the same.
TEST(Planar, FrameUsesTheViewsItWasSubmittedWith) {
    const scene::Scene scene = make_scene_with_flat_mirror(" orthogonal");
    session::Session session(test::get_test_engine(), scene, 3);
    session::FrameSpec frame_spec{.techniques = {"planar:bounces=4"},
                                  .camera = scene.cameras.front(),
                                  .size = kSmallPlanarPictureSize,
                                  .timing = session::PassTimingMode::pipelined};
    const measure::Picture wanted = session.frame(frame_spec).hdr();
    for (int i = 0; i < 3; ++i) {
        session::FrameSpec other = frame_spec; // a frame with other mirrored views
        other.techniques = {"mirror=reuse:face=16 *=planar:bounces=1"};
        session.frame(other);
        EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(frame_spec).hdr(), wanted)) << i;
        session::FrameSpec beside = frame_spec;
        beside.camera = scene.cameras.at(1);
        session.frame(beside);
        EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(frame_spec).hdr(), wanted)) << i;
    }
}

} // namespace
