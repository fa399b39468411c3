// Tests of light between surfaces by light probes (knob `indirect=captures`), against formulas and
// path tracing. In some test rooms no light may leak through a wall.
#include "render/light_probes.hpp"
#include "scene/classify.hpp"
#include "support/lit.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr int kProbeFrames = 8; // frame k shows k reflections between diffuse surfaces

double mean_green(const measure::Picture& picture) {
    double sum = 0;
    for (const vec3& pixel : picture.pixels) sum += pixel.y;
    return sum / double(picture.pixels.size());
}

double rms_difference(const measure::Picture& a, const measure::Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const dvec3 off = glm::clamp(dvec3(a.pixels[i]), 0.0, 1.0) -
                          glm::clamp(dvec3(b.pixels[i]), 0.0, 1.0);
        sum += glm::dot(off, off);
    }
    return std::sqrt(sum / double(3 * a.pixels.size()));
}

measure::Picture render_by_probes(const scene::Scene& scene, const char* technique, uvec2 size,
                                  int frames = kProbeFrames) {
    return test::render_without_ambient(scene, technique, size, frames).hdr;
}

/// Returns a scene of a white ball in an environment, without a floor.
scene::Scene make_ball_in_environment(std::shared_ptr<scene::Environment> environment) {
    scene::Scene scene{.name = "ball"};
    test::add_ball(scene, "ball",
                   test::add_material(scene, {.name = "plaster", .albedo = vec3(.5f)}), {0, 0, 0},
                   1, 5);
    scene.environment = std::move(environment);
    scene.cameras.push_back({.eye = {0, .5, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 20});
    return scene;
}

/// In a white environment, a convex body must show its albedo at every point.
TEST(LightProbes, ConvexBodyInAWhiteFurnaceReflectsItsAlbedo) {
    auto white = std::make_shared<scene::Environment>();
    white->size = {16, 8};
    white->texels.assign(16 * 8, vec3(1));
    const measure::Picture seen = render_by_probes(make_ball_in_environment(white),
                                                   "reuse:indirect=captures", {24, 24}, 2);
    for (const vec3& pixel : seen.pixels) EXPECT_NEAR(pixel.y, .5, .025);
}

/// No part of a convex body hides the environment from another part. Light probes must therefore
/// give the same light as the spherical harmonics of the environment.
TEST(LightProbes, ConvexBodyIsLitAsByTheWholeEnvironment) {
    const scene::Scene scene = make_ball_in_environment(test::make_smooth_environment());
    const measure::Picture ambient = render_by_probes(scene, "reuse", {24, 24}, 1),
                           probes = render_by_probes(scene, "reuse:indirect=captures", {24, 24}, 2);
    double least = 1e9, most = 0;
    for (const vec3& pixel : ambient.pixels)
        least = std::min<double>(least, pixel.y), most = std::max<double>(most, pixel.y);
    ASSERT_GT(most, 1.3 * least) << "the environment must vary";
    for (std::size_t i = 0; i < ambient.pixels.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(probes.pixels[i][channel], ambient.pixels[i][channel],
                        .06 * ambient.pixels[i][channel])
                << i;
}

/// In a room with black walls, no light goes from surface to surface. Light probes must not add the
/// light of the lamp again, whether the lamp is opaque or blended.
TEST(LightProbes, BlackRoomHasTheDirectLightOfItsLampAlone) {
    for (const bool is_blended : {false, true}) {
        scene::Scene room = test::make_lit_room(0, 1);
        for (scene::Material& material : room.materials)
            if (material.emission == vec3(0)) {
                material.albedo = vec3(0);
            } else if (is_blended) {
                material.blended = true;
                material.alpha = .7f;
            }
        const std::size_t grey = test::add_material(room, {.name = "grey", .albedo = vec3(.5f)});
        test::add_quad(room, "table", grey, {-1, -1.5, 1}, {1, -1.5, 1}, {1, -1.5, -1},
                       {-1, -1.5, -1});
        const measure::Picture direct = render_by_probes(room, "reuse", {32, 24}),
                               probes = render_by_probes(room, "reuse:indirect=captures", {32, 24});
        ASSERT_GT(mean_green(direct), .003);
        EXPECT_LT(rms_difference(direct, probes), 1e-3) << is_blended;
    }
}

/// In a closed room with a mirror, the picture with light probes must be far closer to path tracing
/// than with any constant ambient light. The mean brightness must be closer as well.
TEST(LightProbes, ClosedRoomIsNearerToPathsThanWithAnyAmbientLight) {
    scene::Scene room = test::make_lit_room(1, 1);
    scene::find_mirrors(room);
    const uvec2 size{40, 30};
    const measure::Picture truth =
        test::render_without_ambient(room, "raytrace:indirect=paths,rays=1024,depth=12", size).hdr;
    double best = 1e9;
    session::Request asked = test::make_test_request(room, {"secant"}, size);
    asked.warmup = 3;
    for (const double ambient : {0., .02, .04, .06, .08, .1, .14, .2, .3}) {
        asked.ambient = ambient;
        best = std::min(
            best,
            rms_difference(session::run(test::get_test_engine(), asked).parts.front().hdr, truth));
    }
    const measure::Picture probes = render_by_probes(room, "secant:indirect=captures", size);
    const double found = rms_difference(probes, truth);
    std::cout << "[ MEASURED ] rms to paths: best ambient " << best << ", probes " << found
              << "; mean of paths " << mean_green(truth) << ", of probes " << mean_green(probes)
              << '\n';
    EXPECT_LT(found, .6 * best) << "of the rest, a half is noise of the paths";
    EXPECT_NEAR(mean_green(probes), mean_green(truth), .15 * mean_green(truth));
}

/// A wall of thickness .05 separates a room with a lamp from a dark room.
TEST(LightProbes, NoLightLeaksThroughAWall) {
    scene::Scene scene = test::make_lit_room(0, 1); // the room reaches from x = -2 to x = 2
    const std::size_t white = 0;
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, scene::make_box_wall(face, {2.05, -2, -3}, {6, 2, 2}), white);
    const auto look = [&](double x) {
        scene::Scene seen = scene;
        seen.cameras.front().eye = {x, .2, -2.9}, seen.cameras.front().target = {x, -.2, 0};
        return render_by_probes(seen, "reuse:indirect=captures,probes=96", {32, 24}, 4);
    };
    const measure::Picture lit = look(0), dark = look(4);
    const auto lit_pixels = std::ranges::count_if(
        dark.pixels, [&](const vec3& pixel) { return pixel.y > .01 * mean_green(lit); });
    std::cout << "[ MEASURED ] lit room " << mean_green(lit) << ", dark room " << mean_green(dark)
              << ", " << lit_pixels << " of its pixels above 1 %\n";
    EXPECT_GT(mean_green(lit), .02);
    EXPECT_LE(lit_pixels, 4) << "but for pixels in the crack between two walls";
    EXPECT_LT(mean_green(dark), .005 * mean_green(lit));
}

/// Pixels that `hybrid` traces, because its search answers unknown, are lit by the same light
/// probes.
TEST(LightProbes, TracedPixelsAreLitByProbesToo) {
    scene::Scene room = test::make_lit_room(1, 1);
    scene::find_mirrors(room);
    const uvec2 size{48, 36};
    const measure::Picture searched = render_by_probes(room, "secant:indirect=captures,face=128",
                                                       size),
                           traced = render_by_probes(
                               room, "hybrid:force=unknown,indirect=captures,face=128", size),
                           without = render_by_probes(room, "hybrid:force=unknown", size);
    std::cout << "[ MEASURED ] rms between searched and traced " << rms_difference(searched, traced)
              << ", without probes " << rms_difference(searched, without) << '\n';
    EXPECT_LT(rms_difference(searched, traced), .25 * rms_difference(searched, without));
}

TEST(LightProbes, RequiredWorkDrawsThePictureOfAllWork) {
    scene::Scene room = test::make_lit_room(2, 1);
    scene::find_mirrors(room);
    session::Request asked = test::make_test_request(room, {"secant:indirect=captures,face=32"},
                                                     {48, 36});
    asked.warmup = 4;
    asked.model = session::RenderedWork::everything;
    const measure::Picture all = session::run(test::get_test_engine(), asked).parts.front().hdr;
    asked.model = session::RenderedWork::required;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        all, session::run(test::get_test_engine(), asked).parts.front().hdr));
}

/// In a room with an environment, light probes inside the room must light it, although other probes
/// lie around the room.
TEST(LightProbes, RoomBelowASkyHasLightBetweenSurfaces) {
    scene::Scene room = test::make_lit_room(0, 1);
    auto black = std::make_shared<scene::Environment>();
    black->size = {2, 1};
    black->texels.assign(2, vec3(0));
    const measure::Picture indoors = render_by_probes(room, "reuse:indirect=captures", {24, 18});
    room.environment = black;
    const measure::Picture under_sky = render_by_probes(room, "reuse:indirect=captures", {24, 18});
    EXPECT_NEAR(mean_green(under_sky), mean_green(indoors), .1 * mean_green(indoors));
}

/// Light probes replace ambient light, also in the reflections of rough metal.
TEST(LightProbes, AmbientLightIsNotAdded) {
    scene::Scene room = test::make_lit_room(1, 1);
    room.materials[room.objects.back().material] = {
        .name = "rough", .albedo = {.9f, .7f, .5f}, .metallic = 1, .roughness = .9f};
    session::Request asked = test::make_test_request(room, {"reuse:indirect=captures"}, {24, 18});
    asked.warmup = 3;
    std::vector<measure::Picture> pictures;
    for (const double ambient : {0., .5}) {
        asked.ambient = ambient;
        pictures.push_back(session::run(test::get_test_engine(), asked).parts.front().hdr);
    }
    EXPECT_TRUE(test::have_equal_pixel_bytes(pictures[0], pictures[1]));
}

/// Light must pass a pane of glass to the light probes behind the pane, and back.
TEST(LightProbes, GlassDoesNotHideSurfacesFromProbes) {
    scene::Scene room = test::make_lit_room(0, 1);
    const measure::Picture open = render_by_probes(room, "secant:indirect=captures,face=32",
                                                   {24, 18});
    const std::size_t glass = test::add_material(room, {.name = "glass",
                                                        .albedo = vec3(1),
                                                        .roughness = 0,
                                                        .dielectric_f0 = vec3(.04f),
                                                        .dielectric_f90 = vec3(1),
                                                        .transmission = 1});
    for (int face = 0; face < 6; ++face) // a box around everything that the camera sees
        test::add_mesh(room, scene::make_box_wall(face, {-1.9, -1.9, -2.8}, {1.9, 1.9, 1.9}),
                       glass);
    scene::find_mirrors(room);
    const measure::Picture cased = render_by_probes(
        room, "secant:indirect=captures,refract=thin,face=32", {24, 18});
    EXPECT_GT(mean_green(cased), .6 * mean_green(open));
}

/// In a plan with path tracing, paths compute the light between surfaces themselves, so light
/// probes must not add it again.
TEST(LightProbes, PathsInAPlanDoNotCountProbesToo) {
    scene::Scene room = test::make_lit_room(1, 1);
    scene::find_mirrors(room);
    scene::Scene two = room;
    test::add_ball(two, "other", two.objects.back().material, {9, 0, 0}, .1, 2);
    scene::find_mirrors(two);
    const measure::Picture mixed = render_by_probes(
        two, "1=raytrace:indirect=paths,rays=64 *=secant:indirect=captures", {32, 24}, 4);
    const measure::Picture by_paths =
        test::render_without_ambient(room, "raytrace:indirect=paths,rays=64", {32, 24}).hdr;
    EXPECT_NEAR(mean_green(mixed), mean_green(by_paths), .12 * mean_green(by_paths));
}

TEST(LightProbeGrid, CoversTheBoundsWithEqualStepsOffTheWalls) {
    const Bounds<float> room{{-2, 0, -1}, {6, 2, 3}}; // 8 x 2 x 4
    const shared::LightProbeGrid grid = render::make_probe_grid(room, 64, false);
    EXPECT_EQ(grid.counts, uvec3(8, 2, 4));
    EXPECT_EQ(grid.step, vec3(1));
    EXPECT_EQ(grid.first, vec3(-1.5f, .5f, -.5f)) << "in the middle of a cell";
    const shared::LightProbeGrid open = render::make_probe_grid(room, 64, true);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(open.counts[axis], 3u);
        EXPECT_LT(open.first[axis], room.lo[axis]) << "a layer outside the bounds";
        EXPECT_GT(open.first[axis] + open.step[axis], room.lo[axis]) << "and one inside";
    }
    EXPECT_LE(open.counts.x * open.counts.y * open.counts.z, 64u);
    for (const std::size_t most : {8u, 9u, 42u, 63u, 341u, 4096u}) {
        const shared::LightProbeGrid some = render::make_probe_grid(room, most, false);
        EXPECT_LE(some.counts.x * some.counts.y * some.counts.z, most);
        EXPECT_GE(some.counts.x * some.counts.y * some.counts.z, most / 3) << most;
    }
    const shared::LightProbeGrid flat = render::make_probe_grid({{0, 0, 0}, {4, 0, 4}}, 32, false);
    EXPECT_EQ(flat.counts, uvec3(4, 2, 4));
    EXPECT_GT(flat.step.y, 0) << "probes on both sides of a flat scene";
    EXPECT_EQ(render::make_probe_grid({}, 64, false).counts, uvec3(4));
}

} // namespace
