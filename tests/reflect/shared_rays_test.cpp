// Tests of the part that the paths of a camera ray share (shaders/lib/path_start.glsl): how many
// rays are traced, and that pictures do not change. Points in double precision are traced by whole
// paths, with the same random numbers.
#include "scene/build.hpp"
#include "scene/classify.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

constexpr uvec2 kSharedPictureSize{40, 24};
constexpr std::uint64_t kSharedPixelCount = 40 * 24;

/// Returns a floor of rough metal and a sharp mirror that stands on it, below an environment and
/// without lamps. A camera sees both or, with `sees_floor` false, the floor only in the mirror.
scene::Scene make_floor_and_mirror(bool sees_floor) {
    scene::Scene scene{.name = "floor"};
    scene.mirror_max_roughness = 1;
    const auto metal = [&](const char* name, float roughness) {
        return test::add_material(
            scene,
            {.name = name, .albedo = vec3(.9f, .6f, .3f), .metallic = 1, .roughness = roughness});
    };
    test::add_quad(scene, "floor", metal("rough", .3f), {-3, 0, 3}, {3, 0, 3}, {3, 0, -3},
                   {-3, 0, -3});
    test::add_quad(scene, "mirror", metal("sharp", 0), {-3, 0, -2}, {3, 0, -2}, {3, 3, -2},
                   {-3, 3, -2});
    scene::find_mirrors(scene);
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back({.eye = sees_floor ? dvec3(0, 2, 6) : dvec3(0, 1, 2),
                             .target = {0, .8, -2},
                             .up = {0, 1, 0},
                             .vertical_fov_degrees = sees_floor ? 50. : 20.});
    return scene;
}

session::TechniqueResult trace_shared(const scene::Scene& scene, const std::string& technique) {
    return test::render_technique(scene, technique, kSharedPictureSize);
}

/// Returns the number of reflected rays that all paths share, of pictures without shadow rays.
/// Expects that each number of paths adds as many rays as the paths have.
std::uint64_t count_shared_mirror_rays(const scene::Scene& scene, const std::string& depth) {
    const auto count = [&](const char* rays) {
        const session::TechniqueResult traced = trace_shared(scene, "raytrace:depth=" + depth +
                                                                        ",rays=" + rays);
        EXPECT_EQ(traced.rays->primary, kSharedPixelCount) << rays;
        EXPECT_EQ(traced.rays->shadow, 0u) << rays;
        return traced.rays->mirror;
    };
    const std::uint64_t one = count("1"), four = count("4"), path = (four - one) / 3;
    EXPECT_GT(path, kSharedPixelCount / 16);
    EXPECT_EQ(count("16"), one + 15 * path);
    return one - path;
}

TEST(SharedRays, OneCameraRayServesAllRaysOfALobe) {
    // The pixels of the mirror take one reflected ray, however many those of the floor take.
    EXPECT_GT(count_shared_mirror_rays(make_floor_and_mirror(true), "1"), kSharedPixelCount / 16);
}

TEST(SharedRays, SharpMirrorBeforeARoughSurfaceReflectsOneRay) {
    EXPECT_EQ(count_shared_mirror_rays(make_floor_and_mirror(false), "2"), kSharedPixelCount);
}

TEST(SharedRays, SceneWithoutRoughSurfacesIsTracedOnce) {
    for (const char* name : {"cornell-mirrors", "glass"}) {
        const scene::Scene scene = scene::load(name);
        const session::TechniqueResult sharp = trace_shared(scene, "raytrace"),
                                       many = trace_shared(scene, "raytrace:rays=16");
        EXPECT_EQ(many.rays->primary, sharp.rays->primary) << name;
        EXPECT_EQ(many.rays->mirror, sharp.rays->mirror) << name;
        EXPECT_EQ(many.rays->shadow, sharp.rays->shadow) << name;
        EXPECT_TRUE(test::have_equal_pixel_bytes(many.hdr, sharp.hdr)) << name;
    }
}

/// A rough object that no camera ray reaches costs no rays. Pixels that show no rough surface keep
/// their bytes.
TEST(SharedRays, PixelsWithoutRoughSurfacesTakeOneRay) {
    scene::Scene scene = scene::load("cornell-mirrors");
    const session::TechniqueResult sharp = trace_shared(scene, "raytrace:depth=4");
    const std::size_t rough = test::add_material(
        scene, {.name = "rough", .albedo = vec3(.9f), .metallic = 1, .roughness = .4f});
    test::add_ball(scene, "hidden", rough, {0, 1e4, 0}, .1);
    const session::TechniqueResult many = trace_shared(scene, "raytrace:depth=4,rays=16");
    EXPECT_EQ(many.rays->primary, sharp.rays->primary);
    EXPECT_EQ(many.rays->mirror, sharp.rays->mirror);
    EXPECT_EQ(many.rays->shadow, sharp.rays->shadow);
}

TEST(SharedRays, EachSampleOfAPixelHasACameraRay) {
    EXPECT_EQ(trace_shared(make_floor_and_mirror(true), "raytrace:depth=1,rays=3,samples=4")
                  .rays->primary,
              4 * kSharedPixelCount);
}

/// Expects that paths that share their start make the picture that whole paths make.
void expect_picture_of_whole_paths(const scene::Scene& scene, const std::string& knobs) {
    const std::string technique = "raytrace:lamps=met," + knobs;
    const session::TechniqueResult shared = trace_shared(scene, technique),
                                   whole = trace_shared(scene, technique + ",hit=f64");
    EXPECT_LT(shared.rays->primary, whole.rays->primary) << knobs;
    // Edges may move by the rounding of single precision.
    std::size_t apart = 0;
    for (std::size_t i = 0; i < shared.hdr.pixels.size(); ++i)
        apart += glm::length(shared.hdr.pixels[i] - whole.hdr.pixels[i]) >
                 1e-3f * (1 + glm::length(whole.hdr.pixels[i]));
    EXPECT_LE(apart, kSharedPixelCount / 100) << scene.name << ", " << knobs;
}

TEST(SharedRays, PictureIsThatOfWholePaths) {
    expect_picture_of_whole_paths(make_floor_and_mirror(true), "rays=5");
    expect_picture_of_whole_paths(make_floor_and_mirror(true), "rays=3,samples=4");
    expect_picture_of_whole_paths(scene::load("cornell-rough"), "rays=4");
}

/// Glass and blended surfaces before rough surfaces split rays: more than one branch may end at a
/// rough surface, or only one.
TEST(SharedRays, PictureBehindSheetsIsThatOfWholePaths) {
    for (const bool sees_floor : {true, false})
        for (const bool is_glass : {true, false}) {
            scene::Scene scene = make_floor_and_mirror(sees_floor);
            scene::Material sheet{.name = is_glass ? "glass" : "veil",
                                  .albedo = vec3(.8f),
                                  .two_sided = true,
                                  .roughness = is_glass ? 0.f : 1.f};
            if (is_glass)
                sheet.transmission = 1, sheet.dielectric_f0 = vec3(.04f),
                sheet.dielectric_f90 = vec3(1);
            else
                sheet.blended = true, sheet.alpha = .4f;
            test::add_quad(scene, "sheet", test::add_material(scene, sheet), {-1, 0, 1}, {.5, 0, 1},
                           {.5, 2, 1.5}, {-1, 2, 1.5});
            expect_picture_of_whole_paths(scene, "rays=4,depth=6");
        }
}

} // namespace
