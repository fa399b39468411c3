// Tests of clear coats (KHR_materials_clearcoat) in raster and rays, against closed forms and
// quadrature in double precision.
#include "scene/classify.hpp"
#include "scene/surroundings.hpp"
#include "support/lit.hpp"
#include "support/lobe_witness.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr int kCoatPictureEdge = 16;

double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

/// Returns a floor of the material at y = 0, seen at a slant.
scene::Scene make_coated_floor(const scene::Material& material) {
    scene::Scene scene{.name = "floor"};
    test::add_quad(scene, "floor", test::add_material(scene, material), {-50, 0, 50}, {50, 0, 50},
                   {50, 0, -50}, {-50, 0, -50});
    scene.cameras.push_back(
        {.eye = {0, 2, 6}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 40});
    return scene;
}

std::shared_ptr<scene::Environment> make_white_environment() {
    auto white = std::make_shared<scene::Environment>();
    white->size = {64, 32};
    white->texels.assign(64 * 32, vec3(1));
    return white;
}

/// Returns the direction from the floor to the viewer of a pixel, in the floor's frame (z is up).
dvec3 direction_to_viewer(const scene::Scene& scene, int x, int y) {
    const dvec3 ray = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                      kCoatPictureEdge);
    return {-ray.x, ray.z, -ray.y};
}

/// In a white furnace, a sharp coat reflects its Fresnel share of the white light. The diffuse
/// surface below the coat loses the same share of its own light.
TEST(ClearCoat, SharpCoatOverDiffuseHasAClosedForm) {
    scene::Material paint{.name = "paint", .albedo = {.5f, .2f, .1f}, .clearcoat = .7f};
    scene::Scene scene = make_coated_floor(paint);
    scene.environment = make_white_environment();
    for (const char* world : {"raytrace", "raytrace:rays=256", "reuse:face=16"}) {
        const measure::Picture found =
            test::render_without_ambient(scene, world, {kCoatPictureEdge, kCoatPictureEdge}).hdr;
        const double tolerance = (std::string_view(world).find("rays=256") !=
                                  std::string_view::npos)
                                     ? .01
                                     : 1e-3;
        for (const int y : {6, 10, 15}) {
            const double coat = .7 * schlick(.04, direction_to_viewer(scene, 8, y).z);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(found.at(8, y)[channel], coat + (1 - coat) * paint.albedo[channel],
                            tolerance)
                    << world << ", row " << y;
        }
    }
}

/// Tests a rough coat on a rough metal. Rays choose one of the two layers at random, so the mean of
/// a pixel is the sum of the integrals over both lobes.
TEST(ClearCoat, RoughCoatOverMetalIsTheSumOfTwoLobes) {
    constexpr double kStrength = .8, kCoatRoughness = .25, kMetalRoughness = .5;
    const dvec3 f0(.9, .6, .3);
    scene::Scene scene = make_coated_floor({.name = "paint",
                                            .albedo = vec3(f0),
                                            .metallic = 1,
                                            .roughness = float(kMetalRoughness),
                                            .clearcoat = float(kStrength),
                                            .clearcoat_roughness = float(kCoatRoughness)});
    scene.environment = test::make_smooth_environment();
    const measure::Picture found = test::render_without_ambient(
                                       scene, "raytrace:rays=2048",
                                       {kCoatPictureEdge, kCoatPictureEdge})
                                       .hdr;
    for (const auto& [x, y] : {std::pair(8, 15), std::pair(3, 10), std::pair(12, 7)}) {
        const dvec3 o = direction_to_viewer(scene, x, y);
        const auto reflect_lobe = [&](double roughness, double lobe_f0, int channel) {
            return test::integrate_over_half_vectors(roughness, o, [&](const dvec3& i) {
                if (i.z <= 0) return 0.0;
                return schlick(lobe_f0, glm::dot(o, glm::normalize(o + i))) *
                       test::textbook_lobe_reflectance(roughness, o, i) *
                       scene::environment_radiance(*scene.environment, {i.x, i.z, -i.y})[channel];
            });
        };
        const double lost = kStrength * schlick(.04, o.z);
        for (int channel = 0; channel < 3; ++channel) {
            const double wanted = kStrength * reflect_lobe(kCoatRoughness, .04, channel) +
                                  (1 - lost) * reflect_lobe(kMetalRoughness, f0[channel], channel);
            EXPECT_NEAR(found.at(x, y)[channel], wanted, .02 * wanted) << x << ' ' << y;
        }
    }
}

/// The highlight of a point light in the coat must have the expected radiance, rasterised and ray
/// traced, on a mirror and on a surface that is no mirror.
TEST(ClearCoat, CoatHasItsOwnHighlight) {
    scene::Material paint{.name = "paint",
                          .albedo = {.9f, .6f, .3f},
                          .metallic = 1,
                          .roughness = .5f,
                          .clearcoat = 1,
                          .clearcoat_roughness = .2f};
    scene::Scene scene = make_coated_floor(paint);
    scene::PunctualLight light{.name = "point", .intensity = vec3(30)};
    light.world_from_light[3] = dvec4(1, 3, -2, 1);
    scene.punctual.push_back(light);
    for (const bool is_mirror : {false, true})
        for (const char* world : {"raytrace", "raytrace:rays=512", "reuse:face=16"}) {
            scene.objects[0].mirror = is_mirror;
            const measure::Picture found = test::render_without_ambient(
                                               scene, world, {kCoatPictureEdge, kCoatPictureEdge})
                                               .hdr;
            for (const auto& [x, y] : {std::pair(9, 5), std::pair(14, 8), std::pair(8, 15)}) {
                const scene::Camera& camera = scene.cameras.front();
                const dvec3 ray = test::camera_direction_of_pixel(camera, x, y, kCoatPictureEdge);
                const dvec3 to_light = dvec3(1, 3, -2) - (camera.eye - camera.eye.y / ray.y * ray);
                const dvec3 l = glm::normalize(to_light), i(l.x, -l.z, l.y),
                            o = direction_to_viewer(scene, x, y);
                const double away = glm::dot(o, glm::normalize(o + i));
                const double lit = 30 / glm::dot(to_light, to_light);
                for (int channel = 0; channel < 3; ++channel) {
                    const double base = schlick(paint.albedo[channel], away) *
                                        test::textbook_lobe_reflectance(.5, o, i),
                                 coat = schlick(.04, away) *
                                        test::textbook_lobe_reflectance(.2, o, i);
                    const double wanted = lit * (coat + (1 - schlick(.04, o.z)) * base);
                    const double tolerance = (std::string_view(world).find("512") !=
                                              std::string_view::npos)
                                                 ? .1
                                                 : .01;
                    EXPECT_NEAR(found.at(x, y)[channel], wanted, tolerance * wanted + 1e-3)
                        << world << ", mirror " << is_mirror << ", " << x << ' ' << y;
                }
            }
        }
}

/// In a scene with only an environment, a coated ball must look the same rasterised and ray traced.
TEST(ClearCoat, RasterEqualsRays) {
    for (const float metallic : {0.f, 1.f})
        for (const float coat_roughness : {0.f, .3f}) {
            scene::Scene scene{.name = "ball"};
            test::add_ball(scene, "ball",
                           test::add_material(scene, {.name = "paint",
                                                      .albedo = {.7f, .1f, .1f},
                                                      .metallic = metallic,
                                                      .roughness = .7f,
                                                      .clearcoat = 1,
                                                      .clearcoat_roughness = coat_roughness,
                                                      .dielectric_f0 = vec3(.04f),
                                                      .dielectric_f90 = vec3(1)}),
                           {0, 0, 0}, 1, 5);
            scene.environment = test::make_smooth_environment();
            scene::PunctualLight sun{.name = "sun",
                                     .kind = scene::PunctualLight::Kind::directional,
                                     .intensity = vec3(2)};
            sun.world_from_light = test::make_light_transform({0, 3, 3}, {-.3, -1, -.8});
            scene.punctual.push_back(sun);
            scene.cameras.push_back(
                {.eye = {0, .5, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 34});
            const auto draw = [&](const char* technique) {
                return test::render_without_ambient(scene, technique, {96, 96}).hdr;
            };
            const measure::Picture raster = draw("reuse:face=16"), rays = draw("raytrace");
            const double off = test::share_of_off_pixels(raster, rays,
                                                         measure::Mask(raster.pixels.size(), 0));
            scene.materials[0].clearcoat = 0;
            const double without = test::share_of_off_pixels(
                draw("raytrace"), rays, measure::Mask(raster.pixels.size(), 0));
            std::cout << "[ MEASURED ] metallic " << metallic << ", coat " << coat_roughness
                      << ": off " << off << ", without the coat " << without << '\n';
            EXPECT_LE(off, .001);
            EXPECT_GT(without, .2) << "the coat must be visible";
        }
}

/// Tests a rough metal ball with a sharp coat, whose capture is looked up both blurred and sharp.
/// The coat must add the same light to a technique's picture as to the reference.
TEST(ClearCoat, CapturesShowBothLayers) {
    const auto draw = [](float clearcoat, const char* technique, int warmup) {
        scene::Scene scene = test::make_lit_room(1, 1);
        scene.materials[scene.objects.back().material] = {.name = "mirror",
                                                          .albedo = {.9f, .7f, .5f},
                                                          .metallic = 1,
                                                          .roughness = .4f,
                                                          .clearcoat = clearcoat};
        scene::find_mirrors(scene);
        session::Request asked = test::make_test_request(scene, {technique}, {64, 48});
        asked.warmup = warmup;
        return session::run(test::get_test_engine(), asked).parts.front().hdr;
    };
    const auto add_by_coat = [&](const char* technique, int warmup) {
        measure::Picture added = draw(1, technique, warmup);
        const measure::Picture bare = draw(0, technique, warmup);
        for (std::size_t i = 0; i < bare.pixels.size(); ++i) added.pixels[i] -= bare.pixels[i];
        return added;
    };
    const measure::Picture truth = add_by_coat("raytrace:rays=256", 0);
    const auto rms_beside = [&](const measure::Picture* found) {
        double sum = 0;
        for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
            const dvec3 off = dvec3(found ? found->pixels[i] : vec3(0)) - dvec3(truth.pixels[i]);
            sum += glm::dot(off, off);
        }
        return std::sqrt(sum / double(3 * truth.pixels.size()));
    };
    for (const char* technique : {"secant:rough=prefilter,face=128", "secant:rough=rays,rays=64",
                                  "hybrid:rough=prefilter,face=128"}) {
        const measure::Picture added = add_by_coat(technique, 4);
        std::cout << "[ MEASURED ] " << technique << ": the coat adds light of rms "
                  << rms_beside(nullptr) << ", error " << rms_beside(&added) << '\n';
        EXPECT_LT(rms_beside(&added), .4 * rms_beside(nullptr)) << technique;
    }
}

/// Tests a coated metal whose roughness texture makes every second texel too rough for a mirror. In
/// these texels the metal reflects only the environment, but the coat is looked up in the capture.
TEST(ClearCoat, TexturedMirrorShowsItsCoatWhereTheMetalIsTooRough) {
    scene::Material paint{
        .name = "paint", .albedo = {.9f, .7f, .5f}, .metallic = 1, .roughness = 1, .clearcoat = 1};
    auto image = std::make_shared<scene::Image>();
    image->size = {2, 1};
    image->texels = {0xff000000u, 0xffffff00u}; // green is roughness (0 and 1), blue is metallic
    image->texels[0] |= 0x00ff0000u;
    paint.roughness_texture = scene::Texture{.image = image, .nearest = true};
    scene::Scene scene{.name = "floor"};
    test::add_quad(scene, "floor", test::add_material(scene, paint), {-2, 0, 2}, {2, 0, 2},
                   {2, 0, -2}, {-2, 0, -2});
    scene.meshes[0].uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back(
        {.eye = {0, 2, 3}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 40});
    scene::find_mirrors(scene);
    ASSERT_TRUE(scene.objects[0].mirror);
    const measure::Picture rays = test::render_without_ambient(scene, "raytrace", {48, 48}).hdr;
    for (const char* technique :
         {"secant:face=128", "secant:rough=prefilter,face=128", "secant:rough=rays,face=128"}) {
        const measure::Picture raster =
            test::render_without_ambient(scene, technique, {48, 48}, 2).hdr;
        EXPECT_LE(test::share_of_off_pixels(raster, rays, measure::Mask(raster.pixels.size(), 0)),
                  .005)
            << technique;
    }
}

/// A rough coat looks up blurred levels of the mirror's capture, also if a ray continues at a
/// second mirror. With the model `required`, these levels must be ready from the first frame on,
/// also for rough metal.
TEST(ClearCoat, RequiredWorkDrawsThePictureOfAllWork) {
    scene::Scene room = test::make_lit_room(2, 1);
    scene::Material& metal = room.materials[room.objects.back().material];
    for (const float coat : {0.f, 1.f}) {
        metal = {.name = "coated",
                 .albedo = {.9f, .7f, .5f},
                 .metallic = 1,
                 .roughness = coat > 0 ? 0 : .3f,
                 .clearcoat = coat,
                 .clearcoat_roughness = .3f};
        scene::find_mirrors(room);
        ASSERT_EQ(scene::mirrors(room).size(), 2u);
        for (const char* technique : {"secant:face=32", "hybrid:face=32,rough=mips"})
            for (const int warmup : {1, 2, 4}) {
                session::Request asked = test::make_test_request(room, {technique}, {48, 36});
                asked.warmup = warmup;
                asked.model = session::RenderedWork::everything;
                const measure::Picture all =
                    session::run(test::get_test_engine(), asked).parts.front().hdr;
                asked.model = session::RenderedWork::required;
                EXPECT_TRUE(test::have_equal_pixel_bytes(
                    all, session::run(test::get_test_engine(), asked).parts.front().hdr))
                    << technique << ", coat " << coat << ", frame " << warmup + 1;
            }
    }
}

} // namespace
