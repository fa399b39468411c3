// Tests of ray tracing that starts at the triangles drawn by the rasteriser (raytrace:first=raster,
// and hybrid). The picture must equal the ray-traced picture, although only few camera rays and
// shadow rays are traced.
#include "reflect/technique.hpp"
#include "scene/build.hpp"
#include "support/drawn_hall.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kFirstRasterPictureSize{128, 128};
constexpr std::size_t kFirstRasterPixelCount = std::size_t{kFirstRasterPictureSize.x} *
                                               kFirstRasterPictureSize.y;

/// Returns how many pixels differ by more than .02, with values clamped to [0, 1].
std::size_t count_pixels_off(const measure::Picture& a, const measure::Picture& b) {
    const auto shown = [](const vec3& pixel) { return glm::clamp(pixel, vec3(0), vec3(1)); };
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        count += f32::largest_vector_component(abs(shown(a.pixels[i]) - shown(b.pixels[i]))) > .02f;
    return count;
}

/// Expects that the picture equals the ray-traced one, and that camera rays are traced in at most 2
/// % of the pixels.
void expect_same_as_traced(const scene::Scene& scene, const std::string& what,
                           std::size_t most_off) {
    const session::TechniqueResult wanted = test::render_technique(scene, "raytrace:depth=4",
                                                                   kFirstRasterPictureSize),
                                   found = test::render_technique(scene,
                                                                  "raytrace:depth=4,first=raster",
                                                                  kFirstRasterPictureSize);
    ASSERT_TRUE(found.rays && wanted.rays) << what;
    const std::size_t off = count_pixels_off(found.hdr, wanted.hdr);
    std::cout << "[ MEASURED ] " << what << ": " << off << " pixels off, rays "
              << found.rays->primary << " " << found.rays->mirror << " " << found.rays->shadow
              << " instead of " << wanted.rays->primary << " " << wanted.rays->mirror << " "
              << wanted.rays->shadow << '\n';
    EXPECT_EQ(test::count_nonfinite(found.hdr), 0u) << what;
    EXPECT_LE(off, most_off) << what;
    EXPECT_EQ(wanted.rays->primary, kFirstRasterPixelCount) << what;
    EXPECT_LE(found.rays->primary, kFirstRasterPixelCount / 50) << what;
    EXPECT_LE(found.rays->shadow, wanted.rays->shadow / 10 + 50) << what;
    EXPECT_NEAR(double(found.rays->mirror), double(wanted.rays->mirror), 20) << what;
}

TEST(FirstRaster, PictureOfBuiltInScenesIsTheTracedOne) {
    for (const char* name : {"cornell-mirrors", "flat", "gallery", "courtyard", "room"})
        expect_same_as_traced(scene::load(name), name, 8);
}

TEST(FirstRaster, PictureOfDrawnHallsIsTheTracedOne) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u})
        expect_same_as_traced(test::make_random_hall(seed, 5), "hall " + std::to_string(seed), 8);
}

/// Returns a room without mirrors. It has masked, two-sided and smooth surfaces, a sun, and sixty
/// copies of a mesh in object space.
scene::Scene make_room_without_mirrors() {
    scene::Scene scene = test::make_lit_room(0, 1);
    scene::Material masked{.name = "net", .albedo = vec3(.8f), .two_sided = true};
    auto image = std::make_shared<scene::Image>(
        scene::Image{"net", {2, 2}, {0xffffffffu, 0x00ffffffu, 0x00ffffffu, 0xffffffffu}});
    masked.alpha_cutoff = .5f;
    masked.albedo_texture = scene::Texture{.image = image, .nearest = true};
    scene::Mesh net = scene::quad("net", {-1.5, -1, .5}, {-.2, -1, .2}, {-.2, .6, .2},
                                  {-1.5, .6, .5});
    net.uv[0] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    test::add_mesh(scene, net, test::add_material(scene, masked));
    test::add_quad(scene, "varnish",
                   test::add_material(scene, {.name = "varnish",
                                              .albedo = {.2f, .3f, .1f},
                                              .roughness = 0,
                                              .dielectric_f0 = vec3(.04f),
                                              .dielectric_f90 = vec3(1)}),
                   {-1.5, -1.9, -1.5}, {1.5, -1.9, -1.5}, {1.5, -1.9, 1}, {-1.5, -1.9, 1});
    scene.meshes.push_back(scene::ball("copy", 3));
    for (int i = 0; i < 60; ++i) {
        scene::Object copy{.name = "copy", .mesh = scene.meshes.size() - 1, .material = 1};
        copy.world_from_object = dmat4(.12);
        copy.world_from_object[3] = {.1 + .3 * (i % 6), -1.6 + .3 * (i / 6), .4, 1};
        scene.objects.push_back(copy);
    }
    return scene;
}

TEST(FirstRaster, SurfacesThatReflectWithoutBeingMirrorsAreTraced) {
    const scene::Scene scene = make_room_without_mirrors();
    expect_same_as_traced(scene, "without mirrors", 8);
    EXPECT_GT(test::render_technique(scene, "raytrace:first=raster", kFirstRasterPictureSize)
                  .rays->mirror,
              500u)
        << "the varnish shows no reflection";
}

TEST(FirstRaster, OrthographicPictureIsTheTracedOne) {
    scene::Scene scene = test::make_mirror_hall();
    scene.cameras = {{.eye = {.2, .3, -2.8}, .target = {0, -.2, 0}, .orthographic_height = 3}};
    expect_same_as_traced(scene, "orthographic", 8);
}

/// After an object has moved, its triangles have other positions in the hierarchy.
TEST(FirstRaster, PictureFollowsMovedObjects) {
    for (scene::Scene scene : {test::make_mirror_hall(), make_room_without_mirrors()}) {
        session::Session session(test::get_test_engine(), scene);
        session::FrameSpec spec = test::make_test_request(scene, {"raytrace:first=raster"},
                                                          kFirstRasterPictureSize);
        (void)session.frame(spec).read_all();
        for (const std::size_t object : {scene.objects.size() - 1, scene.objects.size() - 2}) {
            dmat4 place = scene.objects[object].world_from_object;
            place[3] += dvec4(.1, .2, -.3, 0);
            session.change(scene::move(object, place));
            scene::apply_edit(scene, scene::move(object, place));
        }
        const std::vector<session::TechniqueResult> moved = session.frame(spec).read_all();
        EXPECT_LE(count_pixels_off(
                      moved.front().hdr,
                      test::render_technique(scene, "raytrace", kFirstRasterPictureSize).hdr),
                  8u);
        EXPECT_LE(moved.front().rays->primary, kFirstRasterPixelCount / 50);
    }
}

TEST(FirstRaster, ShadowsOfTheMapAreThoseOfTheTracerWithTheMap) {
    const scene::Scene scene = test::make_mirror_hall();
    const session::TechniqueResult part = test::render_technique(
        scene, "raytrace:first=raster,shadow=map", kFirstRasterPictureSize);
    EXPECT_LE(
        count_pixels_off(
            part.hdr,
            test::render_technique(scene, "raytrace:shadow=map", kFirstRasterPictureSize).hdr),
        8u);
    EXPECT_EQ(part.rays->shadow, 0u);
    const session::TechniqueResult lit = test::render_technique(
        scene, "raytrace:first=raster,shadow=none", kFirstRasterPictureSize);
    EXPECT_LE(
        count_pixels_off(
            lit.hdr,
            test::render_technique(scene, "raytrace:shadow=none", kFirstRasterPictureSize).hdr),
        8u);
    EXPECT_EQ(lit.rays->shadow, 0u);
}

/// The traced pixels of `hybrid` and of a plan start at drawn triangles, too.
TEST(FirstRaster, TracedPixelsOfOtherTechniquesStartAtTheirTriangle) {
    const scene::Scene scene = test::make_mirror_hall();
    const measure::Picture wanted =
        test::render_technique(scene, "raytrace:depth=16", kFirstRasterPictureSize).hdr;
    const session::TechniqueResult all = test::render_technique(scene, "hybrid:force=unknown",
                                                                kFirstRasterPictureSize);
    EXPECT_GT(all.rays->mirror, 1000u);
    EXPECT_LE(all.rays->primary, kFirstRasterPixelCount / 100);
    EXPECT_LE(count_pixels_off(all.hdr, wanted), kFirstRasterPixelCount / 100)
        << "edges of shadow maps";
}

TEST(FirstRaster, SettingsThatNeedOtherCameraRaysAreRefused) {
    const auto parse = [](const char* text) {
        return [text] { (void)reflect::parse_choice(text); };
    };
    test::expect_error(parse("raytrace:samples=4,first=raster"), Failure::usage,
                       {"first=raster", "wanted samples=1, found samples=4"});
    test::expect_error(parse("raytrace:first=raster,sphere=exact"), Failure::usage,
                       {"wanted sphere=mesh, found sphere=exact"});
    EXPECT_NO_THROW(parse("raytrace:samples=4,sphere=exact,first=ray")());
}

} // namespace
