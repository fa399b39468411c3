// Tests of the second layer of captures. It must hold the surfaces behind the first layer, however
// close, and never the first layer's surfaces.
#include "scene/shapes.hpp"
#include "stress/texels.hpp"
#include "support/captures.hpp"

#include <cmath>

namespace {

using namespace catoptric;

constexpr std::uint32_t kPeelFaceTexels = 48;
// Emitted colours of walls and boards, exact in binary16.
constexpr vec3 kWallColour{.5f, .25f, .75f}, kPeelBoardColour{.25f, 1, .125f};
// Corners of the box of walls, relative to the capture's centre.
constexpr dvec3 kPeelBoxLowCorner{-2, -3, -4}, kPeelBoxHighCorner{3, 4, 2};

class DepthPeelingTest : public testing::TestWithParam<TexelFormat> {
protected:
    bool is_unorm_format() const { return GetParam() == TexelFormat::r8_unorm; }
    bool is_no_surface(float distance) const {
        return is_unorm_format() ? distance >= 1 : std::isinf(distance);
    }
};
INSTANTIATE_TEST_SUITE_P(Formats, DepthPeelingTest,
                         testing::Values(TexelFormat::r32f, TexelFormat::r16f,
                                         TexelFormat::r8_unorm),
                         [](const auto& instance) {
                             return std::string(format_name(instance.param));
                         });

/// Returns a mirror ball at the origin in a box. With `gap` above 0, a board hides the middle of
/// each wall from the ball. The boards are nearer to the ball by this share of the distance.
scene::Scene make_double_wall_scene(double gap) {
    scene::Scene scene{.name = "double walls"};
    const std::size_t wall = test::add_material(scene, {.name = "wall", .emission = kWallColour}),
                      board = test::add_material(scene,
                                                 {.name = "board", .emission = kPeelBoardColour});
    for (int face = 0; face < 6; ++face) {
        test::add_mesh(scene, test::make_box_wall(face, kPeelBoxLowCorner, kPeelBoxHighCorner),
                       wall);
        if (gap <= 0) continue;
        scene::Mesh mesh = test::make_box_wall(face, kPeelBoxLowCorner, kPeelBoxHighCorner);
        const dvec3 middle = (mesh.positions[0] + mesh.positions[2]) / 2.;
        for (dvec3& position : mesh.positions)
            position = (1 - gap) * (middle + .6 * (position - middle));
        test::add_mesh(scene, mesh, board);
    }
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   dvec3(0), .5, 4);
    scene.cameras.push_back({.eye = {0, 0, -3}, .target = {0, 0, 0}});
    return scene;
}

TEST_P(DepthPeelingTest, SecondLayerBehindAWallIsEmpty) {
    const auto [first, second] = test::capture_both_depth_layers(make_double_wall_scene(0),
                                                                 kPeelFaceTexels, GetParam());
    std::size_t again = 0;
    stress::for_each_texel(
        kPeelFaceTexels, [&](const dvec3&, int face, std::uint32_t x, std::uint32_t y) {
            EXPECT_EQ(first.colour(0, face, x, y), kWallColour);
            again += !is_no_surface(second.distance(0, face, x, y, GetParam())) ||
                     second.colour(0, face, x, y) != vec3(0);
        });
    EXPECT_EQ(again, 0u);
}

// The smaller gap is the smallest that the stored distances can resolve.
TEST_P(DepthPeelingTest, SecondLayerShowsTheWallBehindACloseBoard) {
    for (const double gap : {GetParam() == TexelFormat::r8_unorm ? .05 : .004, .1}) {
        const scene::Scene scene = make_double_wall_scene(gap);
        const auto [first, second] = test::capture_both_depth_layers(scene, kPeelFaceTexels,
                                                                     GetParam());
        // A capture's centre is that of the mesh's bounds, which is not exactly the ball's centre.
        const dvec3 centre = scene::bounds(scene, scene.objects.back()).centre();
        std::size_t boards = 0, wrong = 0;
        double worst = 0;
        stress::for_each_texel(kPeelFaceTexels, [&](const dvec3& direction, int face,
                                                    std::uint32_t x, std::uint32_t y) {
            const float one = first.distance(0, face, x, y, GetParam()),
                        two = second.distance(0, face, x, y, GetParam());
            if (first.colour(0, face, x, y) == kWallColour) {
                wrong += !is_no_surface(two);
                return;
            }
            ++boards;
            wrong += second.colour(0, face, x, y) != kWallColour || !(two > one);
            double wall = INFINITY;
            for (int axis = 0; axis < 3; ++axis)
                if (direction[axis] != 0)
                    wall = std::min(wall, ((direction[axis] < 0 ? kPeelBoxLowCorner
                                                                : kPeelBoxHighCorner)[axis] -
                                           centre[axis]) /
                                              direction[axis]);
            wall *= glm::length(direction);
            const double unit = is_unorm_format() ? 10 : 1 / second.space.scale;
            worst = std::max(worst, std::abs(two * unit / wall - 1));
        });
        EXPECT_GT(boards, 1000u);
        EXPECT_EQ(wrong, 0u) << "gap " << gap;
        EXPECT_LE(worst, is_unorm_format() ? .012 : .001) << "gap " << gap;
    }
}

// Surfaces that face away from the capture's centre, such as the far side of a ball, belong to no
// layer.
TEST_P(DepthPeelingTest, FarSideOfABallIsInNoLayer) {
    scene::Scene scene = make_double_wall_scene(0);
    const std::size_t glow = test::add_material(scene,
                                                {.name = "glow", .emission = kPeelBoardColour});
    for (const dvec3& centre : {dvec3(1.2, .3, -.4), dvec3(-1.1, .2, .3), dvec3(.2, -1.5, -2)})
        test::add_ball(scene, "occluder", glow, centre, .45, 4);
    const auto [first, second] = test::capture_both_depth_layers(scene, kPeelFaceTexels,
                                                                 GetParam());
    std::size_t balls = 0, wrong = 0;
    stress::for_each_texel(kPeelFaceTexels,
                           [&](const dvec3&, int face, std::uint32_t x, std::uint32_t y) {
                               if (first.colour(0, face, x, y) != kPeelBoardColour) return;
                               ++balls;
                               wrong += second.colour(0, face, x, y) != kWallColour;
                           });
    EXPECT_GT(balls, 200u);
    // At outlines some facets face away from the centre, while their smooth normals do not.
    EXPECT_LE(wrong, balls / 50);
}

} // namespace
