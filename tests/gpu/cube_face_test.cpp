// Tests that each face of a capture shows its wall, the right way round and at the right distance.
// A cube map lookup along a world direction must find the surface that lies in that direction.
#include "core/shader_math.hpp"
#include "scene/shapes.hpp"
#include "stress/glyph_room.hpp"
#include "stress/texels.hpp"
#include "support/captures.hpp"

#include <cmath>
#include <random>

namespace {

using namespace catoptric;
using stress::LetterRoom;

constexpr std::uint32_t kCubeFaceTexels = 64;
// Error of projected wall positions, as a share of a wall's width. Rasterisers snap vertices to
// 1/256 of a texel, which is 2^-13 of a face's half width; a wall at a flat angle enlarges this
// error.
constexpr double kSnappingError = 0.001;
// Error of a linear texture lookup, as a share of a wall's width. The error is half the diagonal of
// a texel, enlarged by walls at a flat angle.
constexpr double kTexelLookupError = 0.03;

TEST(CubeFace, EveryTexelShowsWhatLiesInItsDirection) {
    const LetterRoom room;
    const test::CapturedCubes captured = test::capture_mirrors(room.make_scene(), kCubeFaceTexels,
                                                               TexelFormat::r32f);
    std::size_t wrong = 0, judged = 0, inked = 0;
    stress::for_each_texel(kCubeFaceTexels,
                           [&](const dvec3& direction, int face, std::uint32_t x, std::uint32_t y) {
                               const LetterRoom::WallPoint seen = room.seen_point(direction);
                               // Skip texels whose centre lies on an edge of a glyph.
                               if (seen.margin < kSnappingError) return;
                               ++judged, inked += seen.glyph;
                               wrong += captured.colour(0, face, x, y) != room.point_colour(seen);
                           });
    EXPECT_GT(judged, 6 * kCubeFaceTexels * kCubeFaceTexels * 95 / 100);
    EXPECT_GT(inked, 1000u);
    EXPECT_EQ(wrong, 0u);
}

/// Tests the middle of each stroke of a glyph. Projected by the cube map table of the Vulkan
/// specification, this point must lie on a texel with the stroke's colour.
TEST(CubeFace, GlyphsLieWhereTheSpecificationProjectsThem) {
    const LetterRoom room;
    const test::CapturedCubes captured = test::capture_mirrors(room.make_scene(), kCubeFaceTexels,
                                                               TexelFormat::r32f);
    for (int wall = 0; wall < 6; ++wall)
        for (const LetterRoom::Stroke& stroke : LetterRoom::kStrokes) {
            const dvec3 middle = room.wall_point(wall, (stroke.u0 + stroke.u1) / 2,
                                                 (stroke.v0 + stroke.v1) / 2) -
                                 room.centre;
            const int face = f32::cube_face(vec3(middle));
            const vec3 place = f32::cube_coordinates(face, vec3(middle));
            const auto texel = [](float coordinate) {
                return static_cast<std::uint32_t>((coordinate * .5f + .5f) *
                                                  static_cast<float>(kCubeFaceTexels));
            };
            EXPECT_EQ(captured.colour(0, face, texel(place.x / place.z), texel(place.y / place.z)),
                      LetterRoom::letter_colour(wall))
                << "wall " << wall << ", face " << face;
        }
}

/// Tests the device's cube map lookup, which does not use the views with which the engine draws the
/// faces.
TEST(CubeFace, LookupAlongAWorldDirectionFindsTheSurfaceThere) {
    const LetterRoom room;
    auto& [device, pipelines] = test::get_test_device();
    const scene::Scene scene = room.make_scene();
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene, scene.cameras.front(), {16, 16}, 0);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<vec4> directions;
    for (int i = 0; i < 4096; ++i)
        directions.emplace_back(vec3(normal(random), normal(random), normal(random)), 0.0f);
    gpu::Buffer asked(device, "directions", directions.size() * sizeof(vec4),
                      gpu::BufferUsage::plain);
    asked.write(std::span<const vec4>(directions));

    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    render::FrameRequests requests(gpu_scene.next_view());
    const render::FrameInputs inputs{gpu_scene, requests, {16, 16}, ""};
    render::CaptureOptions options;
    options.face = 256, options.distance = TexelFormat::r32f;
    const render::CubeCaptureArray cubes = test::add_black_captures(graph, inputs, options);
    const graph::BufferHandle found = graph.add_buffer({"found", directions.size() * sizeof(vec4)});
    graph.add_pass("look")
        .reads(cubes.colour, graph::ResourceUse::sampled)
        .reads(*cubes.distance, graph::ResourceUse::sampled)
        .writes(found, graph::ResourceUse::storage_write)
        .record([&, cubes, found](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/cube_sample.comp", {}});
            commands.bind("colour_cubes", cubes.colour, graph::TextureFilter::linear);
            commands.bind("distance_cubes", *cubes.distance, graph::TextureFilter::nearest);
            commands.bind("Directions", asked);
            commands.bind("Found", found);
            commands.dispatch(static_cast<std::uint32_t>((directions.size() + 63) / 64), 1);
        });
    graph.output(found);
    test::run_graph(runner, graph);
    const std::vector<vec4> answers = test::read_resource_values<vec4>(runner, found);
    std::size_t judged = 0, wrong = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const LetterRoom::WallPoint seen = room.seen_point(dvec3(directions[i]));
        if (seen.margin < kTexelLookupError) continue;
        ++judged;
        wrong += vec3(answers[i]) != room.point_colour(seen);
        // A lookup of the nearest texel may read a distance up to half a texel's diagonal beside
        // the given direction. Over this length, the distance changes only a little.
        EXPECT_NEAR(answers[i].w, gpu_scene.scene_units().to_scene_length(seen.distance),
                    0.02 * gpu_scene.scene_units().to_scene_length(seen.distance));
    }
    EXPECT_GT(judged, 1000u);
    EXPECT_EQ(wrong, 0u);
}

class Distances : public testing::TestWithParam<TexelFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, Distances,
                         testing::Values(TexelFormat::r32f, TexelFormat::r16f,
                                         TexelFormat::r8_unorm),
                         [](const auto& instance) {
                             return std::string(format_name(instance.param));
                         });

TEST_P(Distances, CapturedDistancesEqualTheDistancesOfTheWalls) {
    const LetterRoom room;
    constexpr double kUnormRangeInWorldUnits =
        5; // range of unorm8 in world units; some walls are farther away
    const bool unorm = GetParam() == TexelFormat::r8_unorm;
    const test::CapturedCubes captured = test::capture_mirrors(room.make_scene(), kCubeFaceTexels,
                                                               GetParam(), kUnormRangeInWorldUnits);
    const double unit = unorm ? captured.space.to_scene_length(kUnormRangeInWorldUnits) : 1.0;
    double worst = 0;
    stress::for_each_texel(kCubeFaceTexels, [&](const dvec3& direction, int face, std::uint32_t x,
                                                std::uint32_t y) {
        const double wanted = captured.space.to_scene_length(room.seen_point(direction).distance) /
                              unit;
        const double found = captured.distance(0, face, x, y, GetParam());
        worst = std::max(worst, unorm ? std::abs(found - std::min(wanted, 1.0))
                                      : std::abs(found - wanted) / wanted);
    });
    // Distances in unorm8 may be wrong by one step. Half a step of binary16 is 2^-11, and the rest
    // of the bound is for interpolation in the rasteriser.
    // A device may also round to binary16 towards zero, by a whole step.
    EXPECT_LE(worst, unorm ? 1.0 / 255 : test::computes_like_cpp() ? 0x1p-10 : 0x1.2p-10);
}

TEST_P(Distances, EmptyDirectionsHaveInfiniteOrLargestDistance) {
    scene::Scene scene{.name = "one wall"};
    const std::size_t hot = test::add_material(scene, {.name = "hot", .emission = vec3(1)});
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    // The only wall lies towards +X of the ball.
    test::add_mesh(scene, test::make_box_wall(0, {-2, -9, -9}, {2, 9, 9}), hot);
    test::add_ball(scene, "ball", mirror, {0, 0, 0}, 1);
    scene.cameras.push_back({.eye = {0, 0, -5}, .target = {0, 0, 0}});
    const test::CapturedCubes captured = test::capture_mirrors(scene, kCubeFaceTexels, GetParam(),
                                                               100);
    const float nothing = GetParam() == TexelFormat::r8_unorm
                              ? 1.0f
                              : std::numeric_limits<float>::infinity();
    std::size_t wrong = 0;
    for (std::uint32_t y = 0; y < kCubeFaceTexels; ++y)
        for (std::uint32_t x = 0; x < kCubeFaceTexels; ++x) {
            wrong += captured.distance(0, 1, x, y, GetParam()) != nothing;
            wrong += captured.colour(0, 1, x, y) != vec3(0);
            wrong += !(captured.distance(0, 0, x, y, GetParam()) < nothing);
        }
    EXPECT_EQ(wrong, 0u);
}

TEST(CubeFace, CaptureLeavesOutItsOwnMirrorAndShowsOtherMirrors) {
    const test::CapturedCubes captured = test::capture_mirrors(test::make_furnace_scene(2),
                                                               kCubeFaceTexels, TexelFormat::r32f);
    std::size_t black[2] = {0, 0}, hot[2] = {0, 0};
    for (std::uint32_t mirror = 0; mirror < 2; ++mirror)
        stress::for_each_texel(kCubeFaceTexels,
                               [&](const dvec3&, int face, std::uint32_t x, std::uint32_t y) {
                                   const vec3 colour = captured.colour(mirror, face, x, y);
                                   black[mirror] += colour == vec3(0);
                                   hot[mirror] += colour == test::kFurnaceWallRadiance;
                               });
    // The mirror's capture shows another ball from outside. The sine of half the angle that this
    // ball covers is its radius divided by its distance, which gives the ball's share of all
    // directions.
    const double gap = glm::length(dvec3(-1.2, -0.3, 1) - dvec3(1.3, 0.4, 1.5)),
                 texels = 6.0 * kCubeFaceTexels * kCubeFaceTexels;
    const double radii[2] = {1.2, 1};
    for (int mirror = 0; mirror < 2; ++mirror) {
        EXPECT_EQ(black[mirror] + hot[mirror], 6 * kCubeFaceTexels * kCubeFaceTexels);
        const double cosine = std::sqrt(1 - std::pow(radii[mirror] / gap, 2));
        EXPECT_NEAR(static_cast<double>(black[mirror]) / texels, (1 - cosine) / 2, 0.03);
    }
}

} // namespace
