// Tests of rough flat mirrors that `planar` shows by blurred mirrored views. Expected values come
// from closed forms, quadrature in double precision and ray tracing.
#include "scene/shapes.hpp"
#include "support/lobe_witness.hpp"
#include "support/rendering.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace {

using namespace catoptric;

constexpr int kRoughViewEdge = 64;
constexpr uvec2 kRoughViewSize{kRoughViewEdge, kRoughViewEdge};

std::size_t add_white_metal(scene::Scene& scene, float roughness) {
    scene.mirror_max_roughness = 1;
    return test::add_material(
        scene, {.name = "metal", .albedo = vec3(1), .metallic = 1, .roughness = roughness});
}

void add_mirror_quad(scene::Scene& scene, const std::string& name, std::size_t material,
                     const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    test::add_quad(scene, name, material, a, b, c, d);
    scene.objects.back().mirror = true;
}

constexpr double kEyeDistance = 4; ///< of the camera from the mirror in the plane z = 0

/// Returns a rough mirror that fills the picture, and a parallel wall at the distance `wall`, which
/// the camera itself does not see. The wall is white where x > 0. Elsewhere it is black, or white
/// as well.
scene::Scene make_mirror_before_edge(float roughness, double wall, bool is_all_white) {
    scene::Scene scene{.name = "edge"};
    const std::size_t white = test::add_material(
                          scene, {.name = "white", .albedo = vec3(0), .emission = vec3(1)}),
                      black = test::add_material(scene, {.name = "black", .albedo = vec3(0)});
    add_mirror_quad(scene, "mirror", add_white_metal(scene, roughness), {-6, -6, 0}, {6, -6, 0},
                    {6, 6, 0}, {-6, 6, 0});
    test::add_quad(scene, "right", white, {0, -90, wall}, {0, 90, wall}, {90, 90, wall},
                   {90, -90, wall});
    scene.objects.back().seen_by_camera = false;
    test::add_quad(scene, "left", is_all_white ? white : black, {-90, -90, wall}, {-90, 90, wall},
                   {0, 90, wall}, {0, -90, wall});
    scene.objects.back().seen_by_camera = false;
    scene.cameras = {
        {.eye = {0, 0, kEyeDistance}, .target = {0, 0, 0}, .vertical_fov_degrees = 40}};
    return scene;
}

/// Returns the share of white in each pixel of the picture's middle row.
std::vector<double> white_share_of_middle_row(const std::string& technique, float roughness,
                                              double wall) {
    const auto render = [&](bool is_all_white) {
        return test::render_technique(make_mirror_before_edge(roughness, wall, is_all_white),
                                      technique, kRoughViewSize)
            .hdr;
    };
    const measure::Picture edge = render(false), white = render(true);
    std::vector<double> shares;
    for (int x = 0; x < kRoughViewEdge; ++x) {
        const std::size_t pixel = kRoughViewEdge / 2 * kRoughViewEdge + x;
        shares.push_back(double(edge.pixels[pixel].x) / double(white.pixels[pixel].x));
    }
    return shares;
}

/// Returns the share of white that a narrow GGX lobe reflects to the pixel. The slope m of the
/// microfacets along x has the distribution alpha^2 / (2 (alpha^2 + m^2)^(3/2)), the integral of D
/// over the other slope. A slope m turns the reflected ray by 2 m, so the ray from the point x of
/// the mirror ends on the wall at x + wall (x / eye + 2 m). It ends on white where this is
/// positive.
double white_share_by_closed_form(const scene::Camera& camera, int pixel, float roughness,
                                  double wall) {
    const dvec3 direction = test::camera_direction_of_pixel(camera, pixel, kRoughViewEdge / 2,
                                                            kRoughViewEdge);
    const double x = -direction.x / direction.z * kEyeDistance,
                 alpha = double(roughness) * double(roughness),
                 slope = x / 2 * (1 / wall + 1 / kEyeDistance);
    return .5 * (1 + slope / std::sqrt(alpha * alpha + slope * slope));
}

double largest_error_of_edge(const std::string& technique, float roughness, double wall) {
    const std::vector<double> shares = white_share_of_middle_row(technique, roughness, wall);
    const scene::Camera camera = make_mirror_before_edge(roughness, wall, false).cameras.front();
    double largest = 0;
    for (int x = 0; x < kRoughViewEdge; ++x)
        largest = std::max(
            largest, std::abs(shares[x] - white_share_by_closed_form(camera, x, roughness, wall)));
    return largest;
}

/// The blurred edge must have the width and the shape of the closed form, at each distance and
/// roughness. Without the distance, or with another width of the lobe, it does not.
TEST(RoughViews, EdgeIsBlurredByDistanceAndRoughness) {
    for (const float roughness : {.15f, .3f})
        for (const double wall : {.5, 2., 16.}) {
            const double found = largest_error_of_edge("planar:taps=64", roughness, wall),
                         by_default = largest_error_of_edge("planar", roughness, wall),
                         one_level = largest_error_of_edge("planar:rough=mips", roughness, wall),
                         everywhere = largest_error_of_edge("planar:taps=64,law=none", roughness,
                                                            wall);
            std::cout << "[ MEASURED ] roughness " << roughness << ", wall " << wall
                      << ": largest error of an edge " << found << ", with 16 samples "
                      << by_default << ", one level " << one_level << ", law=none " << everywhere
                      << "\n";
            EXPECT_LE(found, .05) << roughness << ", " << wall;
            EXPECT_LE(by_default, .12) << roughness << ", " << wall;
            EXPECT_LE(one_level, .3) << roughness << ", " << wall;
            if (wall < 4) {
                EXPECT_GE(everywhere, .12) << roughness << ", " << wall;
            }
        }
}

/// Adds the mirror of a furnace and the camera that sees the mirror whole, with its rim.
scene::Scene make_furnace_with_rough_quad(float roughness) {
    scene::Scene scene{.name = "furnace"};
    const std::size_t hot = test::add_material(
        scene, {.name = "hot", .albedo = vec3(0), .emission = vec3(1)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), hot);
    add_mirror_quad(scene, "mirror", add_white_metal(scene, roughness), {-.7, -.5, -1},
                    {.8, -.5, 0}, {.8, .6, 0}, {-.7, .6, -1});
    scene.cameras = {{.eye = {.4, .3, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 40}};
    return scene;
}

/// Every pixel of the mirror, up to its rim, must show the albedo of the lobe, also where the lobe
/// leaves the picture and the drawn part of the view.
TEST(RoughViews, WhiteStaysWhiteUpToTheRim) {
    const dvec3 normal = glm::normalize(dvec3(-1, 0, 1.5));
    for (const float roughness : {.1f, .3f, .6f})
        for (const char* technique : {"planar", "planar:rough=mips", "planar:law=none"}) {
            const scene::Scene scene = make_furnace_with_rough_quad(roughness);
            const measure::Mask mask = measure::mask_mirrors(
                test::render_technique(scene, "raytrace", kRoughViewSize).hits);
            const measure::Picture picture =
                test::render_technique(scene, technique, kRoughViewSize).hdr;
            ASSERT_GT(measure::count_pixels(mask), 300u);
            std::vector<int> shown;
            for (int i = 0; i < int(mask.size()); ++i)
                if (mask[i]) shown.push_back(i);
            const auto [least, most] = std::ranges::minmax_element(
                shown, {}, [&](int i) { return picture.pixels[i].x; });
            for (const int i : {shown.front(), *least, *most}) {
                const double cosine = -glm::dot(
                    normal,
                    test::camera_direction_of_pixel(scene.cameras.front(), i % kRoughViewEdge,
                                                    i / kRoughViewEdge, kRoughViewEdge));
                const dvec3 o(std::sqrt(1 - cosine * cosine), 0, cosine);
                const double wanted = test::integrate_over_half_vectors(
                    roughness, o, [&](const dvec3& light) {
                        return test::textbook_lobe_reflectance(roughness, o, light);
                    });
                EXPECT_NEAR(picture.pixels[i].x, wanted, .004)
                    << technique << ", " << roughness << ", pixel " << i;
            }
        }
}

/// Returns a hall of glowing walls with glowing bodies and two mirrors. A body touches the first
/// mirror, and each mirror shows the other.
scene::Scene make_glowing_hall(float first_roughness, float second_roughness) {
    scene::Scene scene{.name = "hall"};
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}),
                       test::add_material(
                           scene, {.name = "wall",
                                   .albedo = vec3(0),
                                   .emission = vec3(face & 1 ? .75f : .25f, face & 2 ? .75f : .25f,
                                                    face & 4 ? .75f : .25f)}));
    const std::size_t red = test::add_material(
                          scene, {.name = "red", .albedo = vec3(0), .emission = {1.2f, .2f, .1f}}),
                      green = test::add_material(
                          scene, {.name = "green", .albedo = vec3(0), .emission = {.1f, 1.f, .3f}});
    test::add_mesh(scene, scene::box("post", {-.6, -1, -2.6}, {-.3, .4, -2.3}), red);
    test::add_mesh(scene, scene::box("block", {.3, -.6, -1}, {.9, 0, -.4}), green);
    add_mirror_quad(scene, "first", add_white_metal(scene, first_roughness), {-2, -1, -2.6},
                    {1, -1, -2.6}, {1, 1.2, -2.6}, {-2, 1.2, -2.6});
    add_mirror_quad(scene, "second", add_white_metal(scene, second_roughness), {1.6, -1, 1},
                    {1.6, -1, -2.4}, {1.6, 1.2, -2.4}, {1.6, 1.2, 1});
    scene.cameras = {{.eye = {-.9, .3, 2}, .target = {.3, 0, -2.6}, .vertical_fov_degrees = 55}};
    return scene;
}

/// Blurred views must be much nearer to ray tracing than sharp views, at each roughness, for
/// mirrors and for mirrors in mirrors.
TEST(RoughViews, BlurIsNearToRayTracing) {
    for (const auto& [first, second] :
         {std::pair{.1f, .1f}, {.3f, .3f}, {.6f, .6f}, {.02f, .3f}, {.3f, .02f}}) {
        const scene::Scene scene = make_glowing_hall(first, second);
        const session::TechniqueResult truth = test::render_technique(
            scene, "raytrace:rays=256,depth=3", kRoughViewSize);
        const measure::Mask all = measure::mask_mirrors(truth.hits),
                            inner = measure::mask_mirror_in_mirror(truth.hits);
        EXPECT_GT(measure::count_pixels(all), 1000u);
        EXPECT_GT(measure::count_pixels(inner), 200u);
        const measure::Picture
            sharp = test::render_technique(scene, "planar:rough=none", kRoughViewSize).hdr,
            blurred = test::render_technique(scene, "planar", kRoughViewSize).hdr;
        const auto errors_of = [&](const measure::Picture& picture) {
            return dvec2(test::rmse_of_pictures(picture, truth.hdr, all),
                         test::rmse_of_pictures(picture, truth.hdr, inner));
        };
        const dvec2 without = errors_of(sharp), with = errors_of(blurred);
        std::cout << "[ MEASURED ] roughness " << first << " and " << second << ": rmse " << with.x
                  << ", of mirrors in mirrors " << with.y << "; sharp " << without.x << ", "
                  << without.y << "\n";
        // The lobe of the roughness .1 is hardly wider than a pixel.
        const bool is_narrow = std::max(first, second) < .2f;
        EXPECT_LE(with.x, (is_narrow ? .7 : .5) * without.x) << first << ", " << second;
        EXPECT_LE(with.y, (is_narrow ? .8 : .5) * without.y) << first << ", " << second;
    }
}

/// A perfect mirror beside no rough mirror must cost and show the same whatever the knobs for rough
/// mirrors say. With `rough=rest`, a rough mirror is drawn by the technique of `rest`.
TEST(RoughViews, PerfectMirrorsDoNotDependOnTheKnobsOfRoughMirrors) {
    const scene::Scene flat = scene::load("flat");
    const session::TechniqueResult plain = test::render_technique(flat, "planar:rough=none",
                                                                  kRoughViewSize);
    for (const char* technique : {"planar", "planar:rough=mips", "planar:law=none,taps=64"}) {
        const session::TechniqueResult found = test::render_technique(flat, technique,
                                                                      kRoughViewSize);
        EXPECT_TRUE(test::have_equal_pixel_bytes(found.hdr, plain.hdr)) << technique;
        EXPECT_EQ(found.memory_bytes, plain.memory_bytes) << technique;
    }
    scene::Scene rough = flat;
    test::make_mirrors_rough(rough, .3f);
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        test::render_technique(rough, "planar:rough=rest,rest=secant", kRoughViewSize, 2).hdr,
        test::render_technique(rough, "secant", kRoughViewSize, 2).hdr));
    EXPECT_EQ(test::render_technique(rough, "planar", kRoughViewSize).scene_passes,
              plain.scene_passes);
}

} // namespace
