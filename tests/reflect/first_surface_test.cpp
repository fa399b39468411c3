// Tests of what pixels show first (Access::trace_first_surfaces) and of the tiers of their
// reflections: against formulas, against rays on the processor, and between techniques.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/pose.hpp"
#include "session/access.hpp"
#include "session/scene_info.hpp"
#include "support/rendering.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <random>

namespace {

using namespace catoptric;
using session::ReflectionTier;

constexpr int kFirstSurfaceEdge = 96;
constexpr uvec2 kFirstSurfaceSize{kFirstSurfaceEdge, kFirstSurfaceEdge};

session::FirstSurfaces trace_first_surfaces_of(const session::Request& request) {
    session::Session session(test::get_test_engine(), request.scene);
    return session::Access::trace_first_surfaces(session, request);
}

session::FirstSurfaces trace_first_surfaces_of(const scene::Scene& scene) {
    return trace_first_surfaces_of(test::make_test_request(scene, {"raytrace"}, kFirstSurfaceSize));
}

/// What a formula says about the ray of a pixel: the object from 1, the distance and the normal.
struct ExpectedHit {
    std::uint32_t object = 0;
    double distance = std::numeric_limits<double>::infinity();
    dvec3 normal{0};
    double grazing = 1; ///< cosine between ray and normal
};

/// Intersects a ray with the spheres of a scene and with the walls of the box that make_lit_room
/// builds as its first six objects.
ExpectedHit expect_hit_in_room(const scene::Scene& scene, const dvec3& eye, const dvec3& along) {
    ExpectedHit hit;
    const auto take = [&](double t, std::size_t object, const dvec3& normal) {
        if (!(t > 0) || t >= hit.distance) return;
        hit = {static_cast<std::uint32_t>(object) + 1, t, normal, -glm::dot(along, normal)};
    };
    const dvec3 low(-2, -2, -3), high(2, 2, 2);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 normal(0);
        normal[axis] = along[axis] > 0 ? -1 : 1;
        const double wall = along[axis] > 0 ? high[axis] : low[axis];
        const double t = (wall - eye[axis]) / along[axis];
        // The walls are found by their position, so that the test does not repeat their order.
        for (std::size_t i = 0; i < 6; ++i) {
            const Bounds<double> box = scene::bounds(scene, scene.objects[i]);
            if (box.lo[axis] == wall && box.hi[axis] == wall) take(t, i, normal);
        }
    }
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (!scene.objects[i].sphere) continue;
        const auto& [centre, radius] = *scene.objects[i].sphere;
        const dvec3 to_eye = eye - centre;
        const double b = glm::dot(along, to_eye),
                     square = b * b - glm::dot(to_eye, to_eye) + radius * radius;
        if (square <= 0) continue;
        const double t = -b - std::sqrt(square);
        take(t, i, (eye + t * along - centre) / radius);
    }
    return hit;
}

TEST(FirstSurface, EachTierHasItsName) {
    const std::map<ReflectionTier, std::string> names{{ReflectionTier::none, "none"},
                                                      {ReflectionTier::capture, "capture"},
                                                      {ReflectionTier::environment, "environment"},
                                                      {ReflectionTier::unknown, "unknown"},
                                                      {ReflectionTier::traced, "traced"},
                                                      {ReflectionTier::mirrored, "mirrored"}};
    ASSERT_EQ(session::reflection_tiers().size(), names.size());
    for (const auto& [tier, name] : names)
        EXPECT_EQ(session::reflection_tiers().at(static_cast<std::size_t>(tier)).name, name);
}

/// Balls are meshes with corners on the sphere, so their surface lies below the sphere by up to the
/// height of a facet, which is small because the meshes are fine. Walls are exact.
TEST(FirstSurface, DrawnPixelsOfARoomHaveTheDistanceNormalAndNumbersOfAFormula) {
    scene::Scene scene = test::make_lit_room(3, 0);
    for (const scene::Object& object : scene.objects)
        if (object.sphere) scene.meshes[object.mesh] = scene::ball("ball", 7);
    const session::FirstSurfaces found = trace_first_surfaces_of(scene);
    const scene::Camera& camera = scene.cameras.front();
    std::mt19937 random(7);
    int balls = 0, walls = 0;
    double ball_error = 0, normal_error = 0;
    for (int k = 0; k < 600; ++k) {
        const int x = static_cast<int>(random() % kFirstSurfaceEdge),
                  y = static_cast<int>(random() % kFirstSurfaceEdge);
        const auto pixel = static_cast<std::size_t>(y * kFirstSurfaceEdge + x);
        const ExpectedHit wanted = expect_hit_in_room(
            scene, camera.eye, test::camera_direction_of_pixel(camera, x, y, kFirstSurfaceEdge));
        const bool is_ball = scene.objects[wanted.object - 1].sphere.has_value();
        // At the outline of a ball the ray may pass its mesh, and elsewhere edges of walls meet.
        if (is_ball ? wanted.grazing < .3 : found.object[pixel] != wanted.object) continue;
        ASSERT_EQ(found.object[pixel], wanted.object) << x << "," << y;
        const dvec3 normal(found.normal[pixel]);
        EXPECT_NEAR(glm::length(normal), 1, 1e-6);
        if (is_ball) {
            ++balls;
            ball_error = std::max(ball_error, std::abs(found.distance[pixel] - wanted.distance));
            normal_error = std::max(normal_error, glm::distance(normal, wanted.normal));
            // Mirror n is ball n, which lies behind the six walls in the list of objects.
            EXPECT_EQ(found.mirror[pixel], wanted.object - 6);
            EXPECT_EQ(found.roughness[pixel], 0) << "a perfect mirror";
        } else {
            ++walls;
            EXPECT_NEAR(found.distance[pixel], wanted.distance, 1e-6 * wanted.distance);
            EXPECT_LT(glm::distance(normal, wanted.normal), 1e-6);
            EXPECT_EQ(found.mirror[pixel], 0u);
            EXPECT_EQ(found.roughness[pixel], 1) << "Lambertian";
        }
    }
    std::cout << "[ MEASURED ] " << balls << " pixels of balls, distance within " << ball_error
              << ", normal within " << normal_error << "; " << walls << " of walls\n";
    EXPECT_GT(balls, 80);
    EXPECT_GT(walls, 300);
    EXPECT_LT(ball_error, .001);
    EXPECT_LT(normal_error, .002);
}

TEST(FirstSurface, DistanceIsInUnitsOfTheSceneAtAnyScale) {
    const scene::Scene scene = test::make_lit_room(2, 1);
    scene::Scene large = scene;
    dmat4 larger(4096);
    larger[3][3] = 1;
    for (scene::Object& object : large.objects) {
        object.world_from_object = larger * object.world_from_object;
        if (object.sphere)
            object.sphere = scene::Sphere{4096.0 * object.sphere->centre,
                                          4096.0 * object.sphere->radius};
    }
    large.cameras.front().eye *= 4096, large.cameras.front().target *= 4096;
    const session::FirstSurfaces found = trace_first_surfaces_of(scene),
                                 scaled = trace_first_surfaces_of(large);
    ASSERT_EQ(found.object, scaled.object);
    for (std::size_t i = 0; i < found.distance.size(); ++i)
        EXPECT_EQ(4096 * found.distance[i], scaled.distance[i]) << i;
    EXPECT_EQ(found.normal, scaled.normal);
}

/// A camera that looks along z sees a wall at z = 2. An orthographic camera has the same distance
/// everywhere, and a perspective camera the length of the ray.
TEST(FirstSurface, DistanceStartsAtThePlaneOfAnOrthographicCamera) {
    const scene::Scene scene = test::make_lit_room(0, 0);
    session::Request request = test::make_test_request(scene, {"raytrace"}, {32, 16});
    request.camera = {.eye = {.25, .5, -1}, .target = {.25, .5, 0}, .orthographic_height = 1};
    const session::FirstSurfaces flat = trace_first_surfaces_of(request);
    for (const float distance : flat.distance) EXPECT_NEAR(distance, 3, 1e-6);
    for (const vec3& normal : flat.normal) EXPECT_EQ(normal, vec3(0, 0, -1));
    request.camera.orthographic_height = 0, request.camera.vertical_fov_degrees = 30;
    const session::FirstSurfaces deep = trace_first_surfaces_of(request);
    const double y = std::tan(glm::radians(15.0)) * (1 - 1. / 16),
                 x = 2 * y / (1 - 1. / 16) * (1 - 1. / 32);
    EXPECT_NEAR(deep.distance.front(), 3 * std::sqrt(1 + x * x + y * y), 1e-6);
    EXPECT_EQ(deep.object, flat.object);
}

TEST(FirstSurface, RayThatMeetsNothingHasInfiniteDistanceAndNoNumber) {
    scene::Scene scene = test::make_lit_room(1, 1);
    session::Request request = test::make_test_request(scene, {"raytrace"}, {8, 8});
    request.camera = {.eye = {0, 0, 20}, .target = {0, 0, 30}};
    const session::FirstSurfaces found = trace_first_surfaces_of(request);
    for (std::size_t i = 0; i < 64; ++i) {
        EXPECT_EQ(found.distance[i], std::numeric_limits<float>::infinity());
        EXPECT_EQ(found.normal[i], vec3(0));
        EXPECT_EQ(found.object[i] + found.mirror[i], 0u);
        EXPECT_EQ(found.roughness[i], 0);
    }
}

/// The processor finds the objects by another search, without the device.
TEST(FirstSurface, ObjectsOfBuiltInScenesAreThoseThatTheProcessorFinds) {
    for (const char* name : {"cornell-mirrors", "flat", "room", "gallery"}) {
        session::Request request = test::make_test_request(scene::load(name), {"raytrace"},
                                                           {80, 60});
        request.time = .4;
        const session::FirstSurfaces found = trace_first_surfaces_of(request);
        const std::vector<int> wanted = session::find_visible_objects(request, request.size);
        std::size_t different = 0, mirrors = 0;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            different += static_cast<int>(found.object[i]) != wanted[i] + 1;
            mirrors += found.mirror[i] > 0;
            if (found.mirror[i] == 0) continue;
            EXPECT_EQ(scene::mirrors(request.scene).at(found.mirror[i] - 1), found.object[i] - 1);
        }
        EXPECT_LE(different, 2u) << name << ": of 4800 pixels, ties at edges";
        EXPECT_GT(mirrors, 50u) << name;
    }
}

TEST(FirstSurface, RoughnessIsThatOfTheMaterialWithItsTexture) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const auto add_panel = [&](const scene::Material& material, double x) {
        scene::Mesh panel = scene::quad(material.name, {x, -1, 1}, {x + .8, -1, 1}, {x + .8, 1, 1},
                                        {x, 1, 1});
        panel.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
        test::add_mesh(scene, panel, test::add_material(scene, material));
        return static_cast<std::uint32_t>(scene.objects.size());
    };
    const std::uint32_t plain = add_panel(
        {.name = "plain", .albedo = vec3(.5f), .metallic = 1, .roughness = .35f}, -1.6);
    // The upper half of the texture is fully rough in green, the lower half 51/255.
    auto image = std::make_shared<scene::Image>(
        scene::Image{"rough", {1, 2}, {0xff00ff00u, 0xff003300u}});
    scene::Material varied{.name = "varied", .albedo = vec3(.5f), .metallic = 1, .roughness = .5f};
    varied.roughness_texture = scene::Texture{.image = image,
                                              .wrap_u = scene::Texture::Wrap::clamp,
                                              .wrap_v = scene::Texture::Wrap::clamp,
                                              .nearest = true};
    const std::uint32_t textured = add_panel(varied, -.4);
    const session::FirstSurfaces found = trace_first_surfaces_of(scene);
    int seen_plain = 0, upper = 0, lower = 0;
    for (std::size_t i = 0; i < found.object.size(); ++i) {
        if (found.object[i] == plain) {
            ++seen_plain;
            EXPECT_FLOAT_EQ(found.roughness[i], .35f);
        }
        if (found.object[i] != textured) continue;
        const bool is_upper = found.roughness[i] == .5f;
        (is_upper ? upper : lower) += 1;
        EXPECT_FLOAT_EQ(found.roughness[i], is_upper ? .5f : .1f);
    }
    EXPECT_GT(seen_plain, 100);
    EXPECT_GT(upper, 100);
    EXPECT_GT(lower, 100);
}

/// Cut-out parts of a surface do not count, a blended surface counts where its alpha is above 0, an
/// object hidden from the camera does not count, and a two-sided surface turns its normal.
TEST(FirstSurface, MaterialsDecideWhatIsMetFirst) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const auto add_panel = [&](const scene::Material& material, double x) {
        // The panel's normal points away from the camera.
        scene::Mesh panel = scene::quad(material.name, {x, -1, 1}, {x + .8, -1, 1}, {x + .8, 1, 1},
                                        {x, 1, 1});
        panel.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
        test::add_mesh(scene, panel, test::add_material(scene, material));
        return static_cast<std::uint32_t>(scene.objects.size());
    };
    auto image = std::make_shared<scene::Image>(
        scene::Image{"half", {2, 1}, {0xffffffffu, 0x00ffffffu}});
    const scene::Texture half{.image = image, .nearest = true};
    scene::Material cut{.name = "cut", .albedo = vec3(.5f), .two_sided = true};
    cut.alpha_cutoff = .5f, cut.albedo_texture = half;
    scene::Material pane{.name = "pane", .albedo = vec3(.5f), .two_sided = true};
    pane.blended = true, pane.alpha = .25f, pane.albedo_texture = half;
    const std::uint32_t net = add_panel(cut, -1.9), glass = add_panel(pane, -.9),
                        one_sided = add_panel({.name = "one", .albedo = vec3(.5f)}, .1),
                        hidden = add_panel({.name = "hidden", .albedo = vec3(.5f)}, 1.1);
    scene.objects.back().seen_by_camera = false;
    const session::FirstSurfaces found = trace_first_surfaces_of(scene);
    const scene::Camera& camera = scene.cameras.front();
    std::array<int, 3> counts{};
    std::array<int, 2> right_halves{};
    for (int y = 0; y < kFirstSurfaceEdge; ++y)
        for (int x = 0; x < kFirstSurfaceEdge; ++x) {
            const auto i = static_cast<std::size_t>(y * kFirstSurfaceEdge + x);
            const dvec3 along = test::camera_direction_of_pixel(camera, x, y, kFirstSurfaceEdge);
            const dvec3 met = camera.eye + (1 - camera.eye.z) / along.z * along;
            EXPECT_NE(found.object[i], hidden);
            if (found.object[i] == net || found.object[i] == glass) {
                const double left = found.object[i] == net ? -1.9 : -.9;
                const bool is_right = met.x > left + .4 + 1e-6; // with alpha 0
                right_halves[found.object[i] == net ? 0 : 1] += is_right;
                EXPECT_EQ(found.normal[i], vec3(0, 0, -1)) << "turned to the camera";
                ++counts[found.object[i] == net ? 0 : 1];
            }
            if (found.object[i] != one_sided) continue;
            EXPECT_EQ(found.normal[i], vec3(0, 0, 1)) << "as the lighting sees it";
            ++counts[2];
        }
    for (const int count : counts) EXPECT_GT(count, 100);
    EXPECT_EQ(right_halves[0], 0);
    // A device that cannot blend shows a pane without a cutoff whole.
    EXPECT_EQ(right_halves[1] > 0, !test::has_blended_surfaces());
}

/// A frame between two frames of a moving scene changes no byte of the second.
TEST(FirstSurface, TracingLeavesTheHistoryAsItIs) {
    const scene::Scene scene = scene::make_cornell();
    session::FrameSpec spec = test::make_test_request(scene, {"reuse:face=32"}, {48, 48});
    spec.model = session::RenderedWork::required;
    session::Session plain(test::get_test_engine(), scene), traced(test::get_test_engine(), scene);
    for (int frame = 0; frame < 5; ++frame) {
        spec.time = frame / 60.;
        const measure::Picture wanted = plain.frame(spec).hdr(), found = traced.frame(spec).hdr();
        EXPECT_TRUE(test::have_equal_pixel_bytes(wanted, found)) << frame;
        session::Access::trace_first_surfaces(traced, spec);
    }
}

/// With a limit of captures, a mirror may show an older capture. Tiers and layers of the frames of
/// a moving scene change neither the frames nor the order in which captures are drawn again, and a
/// pixel that shows an older capture still has the tier of a capture.
TEST(FirstSurface, LayersLeaveTheOrderOfLimitedCapturesAsItIs) {
    const scene::Scene scene = scene::make_cornell();
    session::FrameSpec spec = test::make_test_request(scene, {"reuse:face=32"}, {48, 48});
    spec.model = session::RenderedWork::required, spec.most_captures = 1;
    session::FrameSpec layered = spec;
    layered.with_lookup = true;
    session::Session plain(test::get_test_engine(), scene), traced(test::get_test_engine(), scene);
    std::uint32_t waited = 0;
    for (int frame = 0; frame < 9; ++frame) {
        spec.time = layered.time = frame / 60.;
        const session::Frame wanted = plain.frame(spec), found = traced.frame(layered);
        EXPECT_TRUE(test::have_equal_pixel_bytes(wanted.hdr(), found.hdr())) << frame;
        ASSERT_TRUE(wanted.capture_budget() && found.capture_budget());
        EXPECT_EQ(found.capture_budget()->drawn, wanted.capture_budget()->drawn) << frame;
        EXPECT_EQ(found.capture_budget()->longest, wanted.capture_budget()->longest) << frame;
        waited = std::max(waited, found.capture_budget()->waiting);
        const session::ReflectionTiers tiers = session::Access::read_tiers(found);
        const session::FirstSurfaces surfaces = session::Access::trace_first_surfaces(traced,
                                                                                      layered);
        std::size_t mirrored = 0, captured = 0;
        for (std::size_t i = 0; i < surfaces.mirror.size(); ++i) {
            mirrored += surfaces.mirror[i] > 0;
            captured += tiers.tier_at(i, surfaces.mirror[i]) == ReflectionTier::capture;
        }
        EXPECT_GT(mirrored, 80u);
        EXPECT_GE(captured + 6, mirrored) << frame << ": but for pixels at outlines";
    }
    EXPECT_GT(waited, 0u) << "captures had to wait";
}

struct TierPictures {
    session::TechniqueResult result;
    std::vector<ReflectionTier> tiers;
    session::FirstSurfaces surfaces;
};

/// Renders the settled picture of a scene, with the tier of each pixel.
TierPictures render_tiers(const scene::Scene& scene, const std::string& technique) {
    session::FrameSpec spec = test::make_test_request(scene, {technique}, kFirstSurfaceSize);
    spec.with_lookup = true;
    session::Session session(test::get_test_engine(), scene);
    for (int k = 0; k < 3; ++k) session.frame(spec);
    const session::Frame frame = session.frame(spec);
    TierPictures pictures{frame.read(), {}, {}};
    const session::ReflectionTiers tiers = session::Access::read_tiers(frame);
    pictures.surfaces = session::Access::trace_first_surfaces(session, spec);
    for (std::size_t i = 0; i < pictures.surfaces.mirror.size(); ++i)
        pictures.tiers.push_back(tiers.tier_at(i, pictures.surfaces.mirror[i]));
    return pictures;
}

std::size_t count_tier(const TierPictures& pictures, ReflectionTier tier) {
    return static_cast<std::size_t>(std::ranges::count(pictures.tiers, tier));
}
std::size_t count_mirror_pixels(const TierPictures& pictures) {
    return pictures.tiers.size() -
           static_cast<std::size_t>(std::ranges::count(pictures.surfaces.mirror, 0u));
}

TEST(ReflectionTiers, RaysTraceEveryMirrorPixel) {
    for (const char* technique : {"raytrace", "raytrace:first=raster", "*=raytrace"}) {
        const TierPictures found = render_tiers(scene::make_cornell(), technique);
        EXPECT_GT(count_mirror_pixels(found), 300u);
        EXPECT_EQ(count_tier(found, ReflectionTier::traced), count_mirror_pixels(found))
            << technique;
    }
}

/// The rasteriser rounds outlines to parts of a pixel, so a few pixels of the outlines may differ.
TEST(ReflectionTiers, SearchesEndOnASurfaceOutsideTheSceneOrUnknown) {
    const TierPictures direct = render_tiers(scene::make_cornell(), "reuse:face=64");
    EXPECT_GE(count_tier(direct, ReflectionTier::capture) + 4, count_mirror_pixels(direct));
    const TierPictures searched = render_tiers(scene::make_cornell(), "secant:face=64");
    std::size_t unknown = 0, miss = 0;
    for (std::size_t i = 0; i < searched.tiers.size(); ++i) {
        const float word = searched.result.lookup[i].w;
        if (searched.surfaces.mirror[i] == 0 || !(word > 0)) continue;
        const int state = (static_cast<int>(word) - 1) % 4;
        unknown += state == 1, miss += state == 2;
    }
    EXPECT_EQ(count_tier(searched, ReflectionTier::unknown), unknown);
    EXPECT_EQ(count_tier(searched, ReflectionTier::environment), miss);
    EXPECT_GT(unknown, 10u);
    EXPECT_GT(miss, 10u) << "the box is open to the front";
    EXPECT_EQ(count_tier(searched, ReflectionTier::traced), 0u);
}

TEST(ReflectionTiers, HybridTracesTheShareThatItReports) {
    const TierPictures found = render_tiers(scene::make_cornell(), "hybrid:face=64");
    ASSERT_TRUE(found.result.traced_fraction);
    const double share = static_cast<double>(count_tier(found, ReflectionTier::traced)) /
                         static_cast<double>(count_mirror_pixels(found));
    EXPECT_NEAR(share, *found.result.traced_fraction, .01);
    EXPECT_GT(share, .01);
    EXPECT_EQ(count_tier(found, ReflectionTier::unknown), 0u);
}

TEST(ReflectionTiers, EachMirrorOfAPlanHasTheTierOfItsTechnique) {
    // Mirror 1 is the ball, 2 the block, 3 the panel.
    const TierPictures found = render_tiers(test::make_mirror_hall(),
                                            "1=raytrace 2=parallax:face=64 3=planar");
    std::array<int, 4> pixels{};
    int outline = 0;
    for (std::size_t i = 0; i < found.tiers.size(); ++i) {
        const std::uint32_t mirror = found.surfaces.mirror[i];
        const ReflectionTier wanted = std::array{ReflectionTier::none, ReflectionTier::traced,
                                                 ReflectionTier::capture,
                                                 ReflectionTier::mirrored}[mirror];
        ++pixels[mirror];
        outline += found.tiers[i] != wanted;
    }
    for (const int count : pixels) EXPECT_GT(count, 100);
    EXPECT_LE(outline, 6) << "pixels at outlines that the rasteriser rounds to another surface";
}

/// Frames with look-ups show the same picture as frames without.
TEST(ReflectionTiers, LookUpsChangeNoPixel) {
    const scene::Scene scene = test::make_mirror_hall();
    for (const char* technique : {"secant:face=64", "hybrid:face=64", "raytrace:first=raster",
                                  "planar", "1=raytrace *=reuse:face=64"}) {
        session::FrameSpec spec = test::make_test_request(scene, {technique}, {64, 64});
        session::Session session(test::get_test_engine(), scene);
        const measure::Picture plain = session.frame(spec).hdr();
        session.forget();
        spec.with_lookup = true;
        EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), plain)) << technique;
    }
}

} // namespace
