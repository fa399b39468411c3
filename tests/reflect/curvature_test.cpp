// Tests of `face=auto` on curved mirrors. The resolution of a capture must follow from the
// curvature that the camera sees. This holds for both sides of a surface and for any direction of
// its normals.
#include "scene/shapes.hpp"
#include "support/rendering.hpp"

#include <cmath>
#include <functional>
#include <numbers>

namespace {

using namespace catoptric;

constexpr std::uint32_t kPictureHeightPixels = 8;
// Vertical field of view in degrees; small, so that all pixels have about the same angle.
constexpr double kFieldOfViewDegrees = 5;
constexpr double kCurvedMirrorRadius = 2;

/// Returns a small patch of a surface around the origin, with `height` along z over x and y. All of
/// the patch has about the same distance from the camera. `turned`: normals and triangles face -z.
scene::Mesh make_surface_patch(const std::function<double(double, double)>& height, bool turned) {
    constexpr int kStepsAcrossPatch = 4;
    constexpr double kHalfPatchWidth = .02, kSmall = 1e-4;
    scene::Mesh mesh{.name = "patch"};
    for (int i = 0; i <= kStepsAcrossPatch; ++i)
        for (int k = 0; k <= kStepsAcrossPatch; ++k) {
            const double x = kHalfPatchWidth * (2. * i / kStepsAcrossPatch - 1),
                         y = kHalfPatchWidth * (2. * k / kStepsAcrossPatch - 1);
            mesh.positions.emplace_back(x, y, height(x, y));
            const dvec3 normal(-(height(x + kSmall, y) - height(x - kSmall, y)) / (2 * kSmall),
                               -(height(x, y + kSmall) - height(x, y - kSmall)) / (2 * kSmall), 1);
            mesh.normals.push_back(vec3(glm::normalize(turned ? -normal : normal)));
        }
    for (std::uint32_t i = 0; i < kStepsAcrossPatch; ++i)
        for (std::uint32_t k = 0; k < kStepsAcrossPatch; ++k) {
            const std::uint32_t a = i * (kStepsAcrossPatch + 1) + k, b = a + kStepsAcrossPatch + 1;
            mesh.triangles.push_back(turned ? uvec3(a, b + 1, b) : uvec3(a, b, b + 1));
            mesh.triangles.push_back(turned ? uvec3(a, a + 1, b + 1) : uvec3(a, b + 1, a + 1));
        }
    return mesh;
}

/// Returns the edge in texels that `face=auto` gives the mirror for a camera at z = `eye`.
double needed_face_edge_of_mesh(const scene::Mesh& mesh, double eye,
                                const dmat4& world_from_object = dmat4(1)) {
    scene::Scene scene{.name = "patch"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, dvec3(-20), dvec3(20)), hot);
    test::add_mesh(scene, mesh, test::add_material(scene, {.name = "mirror", .mirror = true}));
    scene.objects.back().world_from_object = world_from_object;
    scene.cameras.push_back(
        {.eye = {0, 0, eye}, .target = {0, 0, 0}, .vertical_fov_degrees = kFieldOfViewDegrees});
    session::Request request = test::make_test_request(
        scene, {"reuse:face=auto,shadow=none"}, {kPictureHeightPixels, kPictureHeightPixels});
    return session::run(test::get_test_engine(), request).parts.front().auto_face->needs.front();
}

/// Returns the edge in texels by the mirror equation. Two neighbouring pixels look in directions
/// that differ by their own angle times 1 + 2 distance * curvature, where a bulge has positive
/// curvature. The edge is never finer than that of a plane.
double edge_by_mirror_equation(double distance, double curvature) {
    const double pixel = 2 * std::tan(glm::radians(kFieldOfViewDegrees) / 2) / kPictureHeightPixels;
    return std::numbers::pi / 2 / pixel / std::max(1., std::abs(1 + 2 * distance * curvature));
}

double bowl_height(double x, double y) {
    return kCurvedMirrorRadius -
           std::sqrt(kCurvedMirrorRadius * kCurvedMirrorRadius - x * x - y * y);
}

TEST(Curvature, InsideAndOutsideOfABallHaveOppositeCurvature) {
    for (const bool turned : {false, true})
        for (const double distance : {.3 * kCurvedMirrorRadius, 1.5 * kCurvedMirrorRadius,
                                      3 * kCurvedMirrorRadius, 8 * kCurvedMirrorRadius}) {
            // The patch is hollow seen from +z and a bulge seen from -z, wherever its normals
            // point.
            const scene::Mesh mesh = make_surface_patch(bowl_height, turned);
            const double hollow = edge_by_mirror_equation(distance, -1 / kCurvedMirrorRadius),
                         bulge = edge_by_mirror_equation(distance, 1 / kCurvedMirrorRadius);
            EXPECT_NEAR(needed_face_edge_of_mesh(mesh, distance), hollow, .02 * hollow)
                << distance << turned;
            EXPECT_NEAR(needed_face_edge_of_mesh(mesh, -distance), bulge, .02 * bulge)
                << distance << turned;
        }
}

TEST(Curvature, HollowNeedsMoreThanABulgeAndNoMoreThanAPlane) {
    const scene::Mesh hollow = make_surface_patch(bowl_height, false),
                      flat = make_surface_patch([](double, double) { return 0.; }, false);
    for (const double distance :
         {.3 * kCurvedMirrorRadius, 1.5 * kCurvedMirrorRadius, 3 * kCurvedMirrorRadius}) {
        EXPECT_GT(needed_face_edge_of_mesh(hollow, distance),
                  1.05 * needed_face_edge_of_mesh(hollow, -distance));
        EXPECT_LE(needed_face_edge_of_mesh(hollow, distance),
                  1.001 * needed_face_edge_of_mesh(flat, distance));
        EXPECT_NEAR(needed_face_edge_of_mesh(flat, distance), edge_by_mirror_equation(distance, 0),
                    .01 * edge_by_mirror_equation(distance, 0));
    }
}

// A saddle is hollow in one direction and a bulge in the other. The direction that needs more
// texels must decide.
TEST(Curvature, SaddleNeedsAsMuchAsItsHollowDirection) {
    const auto saddle = [](double x, double y) {
        return (x * x - y * y) / (2 * kCurvedMirrorRadius);
    };
    const double hollow = edge_by_mirror_equation(3 * kCurvedMirrorRadius,
                                                  -1 / kCurvedMirrorRadius);
    for (const bool turned : {false, true})
        for (const double eye : {-3 * kCurvedMirrorRadius, 3 * kCurvedMirrorRadius})
            EXPECT_NEAR(needed_face_edge_of_mesh(make_surface_patch(saddle, turned), eye), hollow,
                        .02 * hollow);
}

TEST(Curvature, ScaledObjectsUseTheirCurvatureInWorldSpace) {
    for (const dvec3 scale : {dvec3(-1, 1, 1), dvec3(1, 1, -1), dvec3(2, 2, 2)}) {
        const bool upside_down = scale.z < 0;
        const double distance = 6, curvature = 1 / (kCurvedMirrorRadius * std::abs(scale.x));
        const dmat4 place(
            glm::dmat3(dvec3(scale.x, 0, 0), dvec3(0, scale.y, 0), dvec3(0, 0, scale.z)));
        for (const bool from_above : {false, true}) {
            const double expected = edge_by_mirror_equation(
                distance, from_above == upside_down ? curvature : -curvature);
            EXPECT_NEAR(needed_face_edge_of_mesh(make_surface_patch(bowl_height, false),
                                                 from_above ? distance : -distance, place),
                        expected, .02 * expected)
                << scale.x << ", " << scale.z << (from_above ? " from above" : " from below");
        }
    }
}

} // namespace
