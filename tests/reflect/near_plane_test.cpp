// Tests of near planes. The surfaces nearest to a camera, a capture's centre or a lamp must be
// drawn, even in the corners of a view or face.
#include "scene/shapes.hpp"
#include "stress/texels.hpp"
#include "support/captures.hpp"
#include "support/paths.hpp"

namespace {

using namespace catoptric;

constexpr vec3 kGlowColour{.25f, .5f, .125f}; // emitted colour, exact in binary16
constexpr uvec2 kNearPlanePictureSize{64, 16};

/// A square board at `distance` from a point, perpendicular to the direction from that point.
struct GlowingBoard {
    dvec3 board_centre, along, up;
    double half;

    GlowingBoard(const dvec3& from, const dvec3& direction, double distance, double half_width)
        : board_centre(from + distance * direction),
          along(glm::normalize(glm::cross(direction, dvec3(.1, 1, .2)))),
          up(glm::cross(along, direction)), half(half_width) {}
    void add_board_quad_to_scene(scene::Scene& scene, std::size_t material) const {
        const dvec3 a = half * (along + up), b = half * (along - up);
        test::add_quad(scene, "board", material, board_centre - a, board_centre + b,
                       board_centre + a, board_centre - b);
    }
    /// Returns how far inside the board's outline a ray passes, as a share of the half width.
    /// Negative: outside.
    double margin_inside_outline(const dvec3& eye, const dvec3& direction) const {
        const dvec3 normal = glm::cross(along, up), way = board_centre - eye;
        const double t = dot(way, normal) / dot(direction, normal);
        if (!(t > 0)) return -1;
        const dvec3 met = direction * t - way;
        return 1 - std::max(std::abs(dot(met, along)), std::abs(dot(met, up))) / half;
    }
};

/// Returns the unit directions to the eight corners of an axis-aligned cube.
std::vector<dvec3> list_cube_corner_directions() {
    std::vector<dvec3> directions;
    for (int i = 0; i < 8; ++i)
        directions.push_back(glm::normalize(dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    return directions;
}

std::size_t add_glowing_material(scene::Scene& scene) {
    return test::add_material(scene, {.name = "glow", .emission = kGlowColour});
}

/// Returns a bright box around a mirror of two parallel plates. The centre between the plates,
/// where the capture is drawn from, is free.
scene::Scene make_mirror_plates_scene() {
    scene::Scene scene{.name = "plates"};
    test::add_bright_box(scene, {-4, -4, -4}, {4, 4, 4});
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    scene::Mesh mesh = scene::quad("plates", {-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2});
    const scene::Mesh other = scene::quad("", {-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2});
    for (const uvec3& triangle : other.triangles)
        mesh.triangles.push_back(triangle + static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    test::add_mesh(scene, mesh, mirror);
    scene.cameras.push_back({.eye = {3, 0, 0}, .target = {0, 0, 0}});
    return scene;
}

/// Counts the wrong texels in the capture of mirror 1, whose centre is the origin. Boards must show
/// `colour`, and everything else the radiance 1 of the box.
std::size_t count_wrong_texels(const scene::Scene& scene, const std::vector<GlowingBoard>& boards,
                               const vec3& colour) {
    constexpr std::uint32_t kCaptureFaceTexels = 32;
    const test::CapturedCubes captured = test::capture_mirrors(scene, kCaptureFaceTexels,
                                                               TexelFormat::r32f);
    std::size_t wrong = 0, shown = 0;
    stress::for_each_texel(kCaptureFaceTexels, [&](const dvec3& direction, int face,
                                                   std::uint32_t x, std::uint32_t y) {
        double inside = -1;
        for (const GlowingBoard& board : boards)
            inside = std::max(inside, board.margin_inside_outline(dvec3(0), direction));
        // Ignore outlines, because rasterisers snap vertices.
        if (std::abs(inside) < .02) return;
        shown += inside > 0;
        wrong += captured.colour(0, face, x, y) != (inside > 0 ? colour : vec3(1));
    });
    EXPECT_GT(shown, 20u);
    return wrong;
}

TEST(NearPlane, CapturesShowBoardsInTheCornersOfFaces) {
    for (const double distance : {.02, .3}) {
        scene::Scene scene = make_mirror_plates_scene();
        std::vector<GlowingBoard> boards;
        for (const dvec3& direction : list_cube_corner_directions())
            boards.emplace_back(dvec3(0), direction, distance, .15 * distance);
        for (const GlowingBoard& board : boards)
            board.add_board_quad_to_scene(scene, add_glowing_material(scene));
        EXPECT_EQ(count_wrong_texels(scene, boards, kGlowColour), 0u) << distance;
    }
}

// The board's corners are far from the capture's centre, but its middle is near. The near plane
// must follow from the distance to the triangle.
TEST(NearPlane, NearPlaneFollowsTheNearestPointOfATriangle) {
    for (const dvec3& direction : {dvec3(1, 0, 0), list_cube_corner_directions()[3]}) {
        scene::Scene scene = make_mirror_plates_scene();
        const GlowingBoard board(dvec3(0), direction, .05, 1.2);
        board.add_board_quad_to_scene(scene, add_glowing_material(scene));
        EXPECT_EQ(count_wrong_texels(scene, {board}, kGlowColour), 0u);
    }
}

TEST(NearPlane, CapturesShowNearMirrorsInTheCornersOfFaces) {
    scene::Scene scene = make_mirror_plates_scene();
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    std::vector<GlowingBoard> boards;
    for (const dvec3& direction : list_cube_corner_directions())
        boards.emplace_back(dvec3(0), direction, .05, .01).add_board_quad_to_scene(scene, mirror);
    EXPECT_EQ(count_wrong_texels(scene, boards, vec3(0)), 0u); // captures show mirrors black
}

TEST(NearPlane, ViewShowsBoardsInItsCorners) {
    for (const double fov : {40.0, 110.0}) {
        scene::Scene scene{.name = "corners"};
        test::add_bright_box(scene, {-4, -4, -4}, {4, 4, 4});
        const scene::Camera camera{
            .eye = {.5, .2, -.3}, .target = {.5, .2, 1}, .vertical_fov_degrees = fov};
        scene.cameras.push_back(camera);
        const double tangent = std::tan(glm::radians(fov) / 2);
        for (const double x : {-1., 1.})
            for (const double y : {-1., 1.})
                GlowingBoard(camera.eye,
                             glm::normalize(dvec3(3.8 * x * tangent, .95 * y * tangent, 1)), .03,
                             .004)
                    .add_board_quad_to_scene(scene, add_glowing_material(scene));
        const session::TechniqueResult truth = test::render_technique(scene, "raytrace:shadow=none",
                                                                      kNearPlanePictureSize),
                                       drawn = test::render_technique(
                                           scene, "naive:shadow=none,face=1,bounces=1",
                                           kNearPlanePictureSize);
        std::size_t shown = 0, off = 0;
        for (std::size_t i = 0; i < truth.hdr.pixels.size(); ++i) {
            shown += truth.hdr.pixels[i] == kGlowColour;
            off += test::do_pixel_channels_differ(drawn.hdr.pixels[i], truth.hdr.pixels[i]);
        }
        EXPECT_GT(shown, 20u) << fov;
        EXPECT_LE(off, shown / 20) << fov; // outlines may cut pixels at their centre
    }
}

// Four small boards are close to a lamp, in the directions of the corners of its shadow map's
// faces. Their shadows must appear on the floor.
TEST(NearPlane, ShadowMapsHoldBoardsInTheCornersOfFaces) {
    scene::Scene scene{.name = "lamp"};
    const std::size_t white = test::add_material(scene, {.name = "white", .albedo = vec3(.7f)}),
                      lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(9)}),
                      black = test::add_material(scene, {.name = "black"});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-2, -2, -2}, {2, 2, 2}), white);
    test::add_quad(scene, "lamp", lamp, {-.3, 1.9, -.3}, {.3, 1.9, -.3}, {.3, 1.9, .3},
                   {-.3, 1.9, .3});
    for (const dvec3& direction : list_cube_corner_directions())
        if (direction.y < 0)
            GlowingBoard({0, 1.9, 0}, direction, .05, .02).add_board_quad_to_scene(scene, black);
    scene.cameras.push_back(
        {.eye = {0, 1.5, 0}, .target = {0, -2, 0}, .up = {0, 0, 1}, .vertical_fov_degrees = 130});
    constexpr uvec2 kSquarePictureSize{48, 48};
    const session::TechniqueResult lit = test::render_technique(scene, "raytrace:shadow=none",
                                                                kSquarePictureSize),
                                   truth = test::render_technique(scene, "raytrace:shadow=ray",
                                                                  kSquarePictureSize),
                                   drawn = test::render_technique(
                                       scene, "naive:face=1,bounces=1,shadow_map=512",
                                       kSquarePictureSize);
    std::size_t dark = 0, off = 0;
    for (std::size_t i = 0; i < truth.hdr.pixels.size(); ++i) {
        dark += test::do_pixel_channels_differ(lit.hdr.pixels[i], truth.hdr.pixels[i]);
        off += test::do_pixel_channels_differ(drawn.hdr.pixels[i], truth.hdr.pixels[i]);
    }
    std::cout << "[ MEASURED ] in shadow " << dark << " pixels, off " << off << "\n";
    EXPECT_GT(dark, 50u);
    EXPECT_LE(off, dark / 4); // pixels at the outlines of shadows
}

} // namespace
