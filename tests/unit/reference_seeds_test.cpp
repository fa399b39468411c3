// Tests of the seeds of a noisy reference, and of when a comparison has a noisy reference.
#include "study/reference_seeds.hpp"

#include "compare.hpp"
#include "import/load.hpp"
#include "scene/rough_reflectors.hpp"
#include "session/technique_choice.hpp"
#include "study/reference_cache.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

TEST(ReferenceSeeds, DifferFromEachOtherAndFromTheRows) {
    const std::vector<std::string> rows{
        "raytrace:rays=4,seed=1",   "reuse", "raytrace:rays=4",
        "*=raytrace:rays=2,seed=3", "auto",  "raytrace:rays=8,seed=17"};
    const std::set<int> taken = study::row_seeds(rows);
    EXPECT_EQ(taken, (std::set<int>{0, 1, 3, 17}));
    study::ReferenceSeeds seeds(rows);
    std::set<int> given;
    for (int i = 0; i < 100; ++i) {
        const int seed = seeds.next();
        EXPECT_FALSE(taken.contains(seed)) << seed;
        EXPECT_TRUE(given.insert(seed).second) << seed;
    }
}

TEST(ReferenceSeeds, SeedIsSetWithoutOtherChanges) {
    EXPECT_EQ(study::set_lobe_seed("raytrace:depth=16,rays=64", 7),
              "raytrace:depth=16,rays=64,seed=7");
    const session::ParsedTechnique before = session::parse_technique(
                                       "raytrace:rays=4,seed=3,samples=2"),
                                   after = session::parse_technique(
                                       study::set_lobe_seed("raytrace:rays=4,seed=3,samples=2", 9));
    ASSERT_EQ(before.settings.size(), after.settings.size());
    for (std::size_t i = 0; i < before.settings.size(); ++i)
        EXPECT_EQ(after.settings[i].text,
                  before.settings[i].name == "seed" ? "9" : before.settings[i].text);
    EXPECT_TRUE(study::draws_lobe_rays("raytrace:rays=1"));
    EXPECT_TRUE(study::draws_lobe_rays("raytrace:indirect=paths"));
    EXPECT_FALSE(study::draws_lobe_rays("raytrace:depth=16"));
    EXPECT_FALSE(study::draws_lobe_rays("reuse"));
}

/// Returns a scene of one triangle of a metal with this roughness. The metal is a mirror if its
/// roughness is at most `limit`.
scene::Scene make_metal_triangle_scene(float roughness, float limit) {
    scene::Scene scene{.name = "metal"};
    scene.mirror_max_roughness = limit;
    scene.materials.push_back(
        {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = roughness});
    scene::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(mesh);
    scene.objects.push_back({.name = "triangle"});
    scene.objects.back().mirror = roughness <= limit;
    return scene;
}

TEST(RoughReflectors, ReflectByALobeAboveTheSharpLimit) {
    for (const auto& [roughness, is_rough] :
         {std::pair(.0f, false), {.04f, false}, {.05f, true}, {.3f, true}, {1.f, true}}) {
        const scene::Scene scene = make_metal_triangle_scene(roughness, .3f);
        EXPECT_EQ(scene::has_rough_reflector(scene), is_rough) << roughness;
        EXPECT_EQ(study::choose_reference("", scene),
                  is_rough ? study::kRoughReference : study::kReference);
        EXPECT_EQ(study::choose_reference("raytrace:depth=2", scene), "raytrace:depth=2");
    }
    scene::Scene perfect = make_metal_triangle_scene(.3f, .3f);
    perfect.materials[0].mirror = true;
    EXPECT_FALSE(scene::has_rough_reflector(perfect));
    scene::Scene unlit = make_metal_triangle_scene(.3f, .3f);
    unlit.materials[0].unlit = true;
    EXPECT_FALSE(scene::has_rough_reflector(unlit));
    scene::Scene lambertian = make_metal_triangle_scene(.3f, .3f);
    lambertian.materials[0].metallic = 0;
    EXPECT_FALSE(scene::has_rough_reflector(lambertian));
    lambertian.materials[0].dielectric_f90 = vec3(1);
    EXPECT_TRUE(scene::has_rough_reflector(lambertian)) << "a dielectric";
}

TEST(EnvironmentShadows, MakeNoiseInTracedReferencesWithAnEnvironment) {
    scene::Scene scene = make_metal_triangle_scene(0, .3f);
    scene.environment_shadows = 4;
    EXPECT_FALSE(study::is_noisy(study::kReference, scene)) << "no environment";
    scene.environment = std::make_shared<scene::Environment>();
    EXPECT_TRUE(study::is_noisy(study::kReference, scene));
    EXPECT_FALSE(study::is_noisy("raytrace:shadow=none", scene));
    EXPECT_FALSE(study::is_noisy("reuse", scene));
    scene.environment_shadows = 0;
    EXPECT_FALSE(study::is_noisy(study::kReference, scene));
}

/// The green channel of the texture multiplies the roughness. The whole range of the texture must
/// count.
TEST(RoughReflectors, TextureCountsByItsWholeRange) {
    scene::Scene scene = make_metal_triangle_scene(1, .3f);
    auto image = std::make_shared<scene::Image>();
    image->size = {2, 1};
    image->texels = {0xFF000800u, 0xFF004000u}; // 64 / 255 = .25
    scene.materials[0].roughness_texture = scene::Texture{.image = image};
    EXPECT_TRUE(scene::has_rough_reflector(scene));
    image->texels = {0xFF000800u, 0xFF000100u}; // 8 / 255 = .03
    EXPECT_FALSE(scene::has_rough_reflector(scene));
}

TEST(PixelTruth, ConvergedReferencesAreThoseOfAllRows) {
    EXPECT_EQ(study::choose_reference("", make_metal_triangle_scene(0, .3f),
                                      study::ReferencePixelKind::converged),
              study::kConvergedReference);
    EXPECT_EQ(study::choose_reference("", make_metal_triangle_scene(.3f, .3f),
                                      study::ReferencePixelKind::converged),
              study::kConvergedRoughReference);
    EXPECT_EQ(study::set_samples("raytrace:depth=16", "4"), "raytrace:depth=16,samples=4");
    for (const char* reference : {study::kConvergedReference, study::kConvergedRoughReference})
        EXPECT_EQ(study::set_samples(reference, "4"), reference);
}

TEST(PixelTruth, PathsAreTheReferenceOfEachScene) {
    for (const float roughness : {0.f, .3f})
        EXPECT_EQ(study::choose_reference("", make_metal_triangle_scene(0, roughness),
                                          study::ReferencePixelKind::paths),
                  study::kPathReference);
    EXPECT_TRUE(study::traces_paths(study::kPathReference));
    EXPECT_FALSE(study::traces_paths(study::kRoughReference));
    EXPECT_TRUE(study::draws_lobe_rays(study::kPathReference));
}

TEST(RoughReflectors, BuiltInScenesOfPerfectMirrorsKeepTheirReference) {
    for (const char* name : {"cornell-mirrors", "gallery", "room", "courtyard"})
        EXPECT_EQ(study::choose_reference("", scene::load(name)), study::kReference) << name;
}

TEST(ReferenceRays, FirstFramesHaveAtMost262144) {
    const std::string rough = study::kRoughReference;
    EXPECT_EQ(study::choose_coarse_rays(rough, {64, 64}), 64) << "a small picture needs no fewer";
    EXPECT_EQ(study::choose_coarse_technique(rough, {64, 64}), rough);
    EXPECT_EQ(study::choose_coarse_rays(rough, {65, 64}), 32);
    EXPECT_EQ(study::choose_coarse_rays(rough, {256, 256}), 4);
    EXPECT_EQ(study::choose_coarse_rays(rough, {1920, 1080}), 1);
    EXPECT_EQ(study::choose_coarse_rays("raytrace:rays=100", {64, 64}), 64);
    EXPECT_EQ(study::choose_coarse_rays("raytrace:samples=4,rays=16", {128, 128}), 4);
    EXPECT_EQ(study::choose_coarse_rays("raytrace:depth=16", {1920, 1080}), 0);
    EXPECT_EQ(study::choose_coarse_technique(study::kPathReference, {256, 256}),
              "raytrace:depth=16,rays=4,indirect=paths");
}

TEST(ReferenceRays, LaterFramesFitIntoTheTime) {
    // A frame of 4 rays takes 2 s, and two frames of 64 rays take 64 s.
    EXPECT_EQ(study::choose_refined_rays(64, 4, 2, 64), 64);
    EXPECT_EQ(study::choose_refined_rays(64, 4, 2, 63), 32);
    EXPECT_EQ(study::choose_refined_rays(64, 4, 2, 33), 32);
    EXPECT_EQ(study::choose_refined_rays(64, 4, 2, 31), 16);
    EXPECT_EQ(study::choose_refined_rays(64, 4, 2, 0), 1);
    EXPECT_EQ(study::choose_refined_rays(100, 4, 1e-9, 60), 100);
    EXPECT_EQ(study::choose_refined_rays(64, 4, 0, 60), 64) << "a clock without progress";
}

} // namespace
