// Tests of lamps against closed forms, and of light on facets whose vertex normals differ from
// their plane. Both are tested in rasterisation and in ray tracing.
#include "support/lit.hpp"
#include "support/special_values.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

namespace {

using namespace catoptric;

const std::string kLampWorlds[] = {"raytrace", "naive:bounces=0"};

/// Returns a scene of a floor at y = 0. The camera shows its middle in one pixel, from beside the
/// lamp that tests add above.
scene::Scene make_floor_below_lamp(double albedo) {
    scene::Scene scene{.name = "floor"};
    const std::size_t grey = test::add_material(scene,
                                                {.name = "grey", .albedo = vec3(float(albedo))});
    test::add_quad(scene, "floor", grey, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
    scene.cameras.push_back({.name = "at its middle",
                             .eye = {1, 1, 0},
                             .target = {0, 0, 0},
                             .vertical_fov_degrees = .1});
    return scene;
}

double render_floor_pixel(const scene::Scene& scene, const std::string& technique) {
    return test::render_without_ambient(scene, technique, {1, 1}).hdr.at(0, 0).x;
}

TEST(Lamp, SphereLampEqualsItsClosedForm) {
    scene::Scene scene = make_floor_below_lamp(.5);
    const std::size_t lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(30)});
    scene::Mesh ball = scene::ball("lamp", 5);
    for (dvec3& position : ball.positions) position = .1 * position + dvec3(0, 2, 0);
    test::add_mesh(scene, ball, lamp);
    for (const bool two_sided : {false, true}) {
        scene.materials[lamp].two_sided = two_sided;
        for (const std::string& technique : kLampWorlds)
            EXPECT_NEAR(render_floor_pixel(scene, technique), .0375, .0002)
                << technique << two_sided;
    }
}

TEST(Lamp, TwoSidedBoardShinesByTheCosineOnBothSides) {
    for (const double turn : {0.0, .5, 1.2, 2.6, test::kPi}) {
        scene::Scene scene = make_floor_below_lamp(.5);
        const std::size_t lamp = test::add_material(
            scene, {.name = "lamp", .emission = vec3(30), .two_sided = true});
        const dvec3 along = .1 * dvec3(std::cos(turn), std::sin(turn), 0), across(0, 0, .1);
        const dvec3 at(0, 2, 0);
        test::add_quad(scene, "lamp", lamp, at - along - across, at + along - across,
                       at + along + across, at - along + across);
        const double wanted = .5 / test::kPi * 30 * .04 * std::abs(std::cos(turn)) / 4;
        for (const std::string& technique : kLampWorlds)
            EXPECT_NEAR(render_floor_pixel(scene, technique), wanted, 1e-5)
                << technique << " " << turn;
    }
}

/// Returns the form factor of the rectangle [0,x] x [0,z] at this height, seen from a surface at
/// the origin that faces it; negative for one negative side.
double rectangle_form_factor(double x, double z, double height) {
    x /= height, z /= height;
    const double a = std::sqrt(1 + x * x), b = std::sqrt(1 + z * z);
    return (x / a * std::atan(z / a) + z / b * std::atan(x / b)) / (2 * test::kPi);
}

/// A board with a straight edge hides a part of a square lamp. The part of the lamp that a point of
/// the floor sees is a rectangle, whose form factor is known.
TEST(Lamp, SoftShadowOfASquareLampIsItsVisibleFormFactor) {
    constexpr int kLampPictureEdge = 32;
    constexpr double kLampHeight = 2, kBoardHeight = 1, kHalfBoardWidth = .5, kLampEmission = 8;
    scene::Scene scene{.name = "penumbra"};
    const std::size_t white = test::add_material(scene, {.name = "white", .albedo = vec3(1)}),
                      lamp = test::add_material(scene,
                                                {.name = "lamp", .emission = vec3(kLampEmission)});
    test::add_quad(scene, "floor", white, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    test::add_quad(scene, "board", white, {0, kBoardHeight, -9}, {9, kBoardHeight, -9},
                   {9, kBoardHeight, 9}, {0, kBoardHeight, 9});
    test::add_quad(scene, "lamp", lamp, {-kHalfBoardWidth, kLampHeight, -kHalfBoardWidth},
                   {kHalfBoardWidth, kLampHeight, -kHalfBoardWidth},
                   {kHalfBoardWidth, kLampHeight, kHalfBoardWidth},
                   {-kHalfBoardWidth, kLampHeight, kHalfBoardWidth});
    scene.cameras.push_back({.name = "below the board",
                             .eye = {0, .9, 0},
                             .target = {0, 0, 0},
                             .up = {0, 0, -1},
                             .vertical_fov_degrees = 60});
    const auto rmse = [&](const std::string& technique, int samples) {
        scene.light_samples = samples;
        const measure::Picture found = test::render_without_ambient(
                                           scene, technique, {kLampPictureEdge, kLampPictureEdge})
                                           .hdr;
        double squares = 0;
        for (int y = 0; y < kLampPictureEdge; ++y)
            for (int x = 0; x < kLampPictureEdge; ++x) {
                const dvec3 along = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                                    kLampPictureEdge);
                const dvec3 at = scene.cameras.front().eye + along * (.9 / -along.y);
                // The edge of the board is half-way between the floor and the lamp.
                const double right = std::clamp(-at.x, -kHalfBoardWidth, kHalfBoardWidth);
                double visible = 0;
                for (const double z : {-kHalfBoardWidth, kHalfBoardWidth})
                    visible += (z > 0 ? 1 : -1) *
                               (rectangle_form_factor(right - at.x, z - at.z, kLampHeight) -
                                rectangle_form_factor(-kHalfBoardWidth - at.x, z - at.z,
                                                      kLampHeight));
                const double error = found.at(x, y).x - kLampEmission * visible;
                squares += error * error;
            }
        return std::sqrt(squares / (kLampPictureEdge * kLampPictureEdge));
    };
    for (const std::string& technique : kLampWorlds) {
        const double one = rmse(technique, 1), few = rmse(technique, 16),
                     many = rmse(technique, 64);
        std::cout << "[ MEASURED ] " << technique << ": rmse " << one << " with 1 point, " << few
                  << " with 16, " << many << " with 64; brightest about "
                  << kLampEmission * 4 *
                         rectangle_form_factor(kHalfBoardWidth, kHalfBoardWidth, kLampHeight)
                  << '\n';
        EXPECT_GT(one, .1) << technique;
        EXPECT_LT(few, one / 4) << technique;
        EXPECT_LT(many, .012) << technique;
    }
    // Path tracing samples points on the area of the lamp, other points in each pixel.
    const double paths = rmse("raytrace:indirect=paths,depth=1,rays=1024", 1);
    std::cout << "[ MEASURED ] 1024 paths: rmse " << paths << '\n';
    EXPECT_LT(paths, .003);
}

/// Returns the relative brightness of a board that faces up. Its vertex normals lean by `lean`
/// radians towards +x. A point light is in that direction, `sine` above the board's plane.
double brightness_with_leaning_normals(double lean, double sine, const std::string& technique) {
    scene::Scene scene = make_floor_below_lamp(.5);
    for (vec3& normal : scene.meshes[0].normals) normal = vec3(std::sin(lean), std::cos(lean), 0);
    scene::PunctualLight light{.intensity = vec3(9)};
    light.world_from_light[3] = dvec4(3 * std::sqrt(1 - sine * sine), 3 * sine, 0, 1);
    scene.punctual.push_back(light);
    // Divide by the brightness under a light straight above.
    return render_floor_pixel(scene, technique) / (.5 / test::kPi * 9 / 9);
}

TEST(Facets, LightBelowTheFacetGivesNothing) {
    for (const std::string technique :
         {"raytrace", "raytrace:shadow=none", "naive:bounces=0", "naive:bounces=0,shadow=none"})
        for (const double lean : {.2, .5, 1.2})
            for (const double below : {.001, .02, .1, .4})
                EXPECT_EQ(brightness_with_leaning_normals(lean, -below, technique), 0)
                    << technique << " " << lean;
}

TEST(Facets, LightFadesTowardsThePlaneOfTheFacet) {
    const double fade = std::sin(glm::radians(6.0));
    for (const std::string technique : {"raytrace", "naive:bounces=0"})
        for (const double part : {.1, .5, .9, 1.1, 4.0}) {
            const double sine = part * fade, cosine = std::sqrt(1 - sine * sine);
            const double whole = std::sin(.5) * cosine + std::cos(.5) * sine;
            const double t = std::min(part, 1.0);
            EXPECT_NEAR(brightness_with_leaning_normals(.5, sine, technique),
                        whole * t * t * (3 - 2 * t), 2e-4)
                << technique << " " << part;
        }
}

TEST(Facets, FacetsDoNotMatterForNormalsWithinSixDegrees) {
    const double lean = glm::radians(5.0);
    for (const std::string technique : {"raytrace:shadow=none", "naive:bounces=0,shadow=none"})
        for (const double sine : {-.05, -.01, .01, .3})
            EXPECT_NEAR(brightness_with_leaning_normals(lean, sine, technique),
                        std::sin(lean) * std::sqrt(1 - sine * sine) + std::cos(lean) * sine, 2e-4)
                << technique << " " << sine;
}

/// Returns a scene of a white ball of 4^(levels + 1) triangles, lit from the side.
scene::Scene make_lit_ball_scene(int levels) {
    scene::Scene scene{.name = "ball"};
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "white", .albedo = vec3(1)}),
                   {0, 0, 0}, 1, levels);
    scene::PunctualLight light{.intensity = vec3(static_cast<float>(36 * test::kPi))};
    light.world_from_light[3] = dvec4(-6, 0, 0, 1);
    scene.punctual.push_back(light);
    scene.cameras.push_back(
        {.name = "front", .eye = {0, .6, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 32});
    return scene;
}

constexpr uvec2 kLitBallPictureSize{300, 300};

/// Returns the largest difference of two pictures, except at the ball's outline, where a mesh
/// differs from the sphere.
double largest_difference_inside_ball(const measure::Picture& a, const measure::Picture& b) {
    double most = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const double right = x + .5 - a.width / 2., down = y + .5 - a.height / 2.;
            if (right * right + down * down < 110 * 110)
                most = std::max(most, std::abs(double(a.at(x, y).x) - double(b.at(x, y).x)));
        }
    return most;
}

TEST(Facets, FacetsAreInvisibleOnABallOf4096Triangles) {
    const scene::Scene scene = make_lit_ball_scene(5);
    const measure::Picture exact =
        test::render_without_ambient(scene, "raytrace:sphere=exact", kLitBallPictureSize).hdr;
    for (const std::string& technique : kLampWorlds) {
        const double most = largest_difference_inside_ball(
            test::render_without_ambient(scene, technique, kLitBallPictureSize).hdr, exact);
        std::cout << "[ MEASURED ] " << technique << ": off by at most " << most << " of 1.44\n";
        EXPECT_LE(most, .02) << technique;
    }
}

/// Two exact spheres must be lit alike, whether their meshes have few triangles or many. Light
/// fades at the facets of a coarse mesh, but not on its exact sphere.
TEST(Facets, FacetsDoNotAffectAnExactSphere) {
    const auto picture = [](int levels) {
        return test::render_without_ambient(make_lit_ball_scene(levels), "raytrace:sphere=exact",
                                            kLitBallPictureSize)
            .hdr;
    };
    EXPECT_LE(largest_difference_inside_ball(picture(3), picture(5)), 1e-5);
}

} // namespace
