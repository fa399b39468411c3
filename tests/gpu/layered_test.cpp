// Tests that captures keep their bytes whether six faces are drawn in one pass or one by one.
// Culling objects from faces that cannot see them must not change a byte either.
#include "render/views.hpp"
#include "scene/built_in.hpp"
#include "support/captures.hpp"
#include "support/rendering.hpp"

#include <random>

namespace {

using namespace catoptric;

class Layered : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Techniques, Layered,
                         testing::Values("reuse", "parallax", "naive", "layered"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(Layered, OnePassForSixFacesEqualsSixPasses) {
    session::Request request = test::make_test_request(scene::make_cornell(), {GetParam()},
                                                       {96, 96});
    request.frames = 3;
    const session::TechniqueResult at_once = std::move(
        session::run(test::get_test_engine(true), request).parts.front());
    const session::TechniqueResult one_by_one = std::move(
        session::run(test::get_test_engine(false), request).parts.front());
    EXPECT_TRUE(test::have_equal_pixel_bytes(at_once.hdr, one_by_one.hdr));
    EXPECT_TRUE(test::have_equal_pixel_bytes(at_once.display, one_by_one.display));
    EXPECT_EQ(at_once.scene_passes, one_by_one.scene_passes);
}

/// Draws captures as render::add_captures does, but draws every object into every face.
/// Returns the colours.
std::vector<std::byte> draw_every_object_into_captures(const scene::Scene& scene,
                                                       std::uint32_t face) {
    auto& [device, pipelines] = test::get_test_device();
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene, scene.cameras.front(), {16, 16}, 0);
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const std::uint32_t mirrors = gpu_scene.mirror_count();
    const graph::ImageHandle colour = graph.add_image(
        {"colour", TexelFormat::rgba16f, face, face, 6 * mirrors, true});
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror) {
        const graph::ImageHandle depth = graph.add_image(
            {"depth" + std::to_string(mirror), TexelFormat::d32f, face, face, 6, true});
        graph.add_pass("capture" + std::to_string(mirror))
            .writes(colour.layers(6 * mirror, 6), graph::ResourceUse::colour,
                    graph::ClearValue{0, 0, 0, 1})
            .writes(depth, graph::ResourceUse::depth, graph::ClearValue{0, 0, 0, 0})
            .layers(6)
            .record([&gpu_scene, mirror](graph::PassCommands& commands) {
                gpu_scene.bind(commands);
                for (const bool mirrors_now : {false, true}) {
                    commands.bind_pipeline(gpu::RasterState{
                        "scene.vert", mirrors_now ? "mirror_black.frag" : "diffuse.frag", {}});
                    for (std::size_t i = 0; i < gpu_scene.draw_ranges().size(); ++i) {
                        const render::DrawRange& range = gpu_scene.draw_ranges()[i];
                        if (range.mirror != mirrors_now || i == gpu_scene.mirror_object(mirror))
                            continue;
                        commands.push_constants(
                            shared::DrawParameters{.first_view = gpu_scene.capture_view(mirror)});
                        gpu_scene.bind_vertices(commands, i);
                        commands.draw(range.first_index, range.index_count, 0, 6,
                                      static_cast<std::uint32_t>(i) << shared::kInstanceLayerBits);
                    }
                }
            });
    }
    graph.output(colour);
    test::run_graph(runner, graph);
    return runner.read_back(colour);
}

TEST(Culling, CulledCapturesKeepTheirBytes) {
    for (const scene::Scene& scene :
         {scene::make_cornell(), test::make_lit_room(3, 2), test::make_furnace_scene(2)}) {
        const test::CapturedCubes captured = test::capture_mirrors(scene, 128, TexelFormat::r32f);
        EXPECT_EQ(captured.colour_bytes, draw_every_object_into_captures(scene, 128)) << scene.name;
    }
}

TEST(Culling, BoxWithAVisiblePointIsNeverCulled) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> coordinate(-1, 1), size(0, .3f), share(0, 1);
    std::size_t left_out = 0;
    for (int round = 0; round < 2000; ++round) {
        const vec3 eye(coordinate(random), coordinate(random), coordinate(random));
        const vec3 corner(coordinate(random), coordinate(random), coordinate(random));
        Bounds<float> box;
        box.add(corner);
        box.add(corner + vec3(size(random), size(random), size(random)));
        for (const shared::View& view : render::make_cube_views(eye, .01f)) {
            if (render::may_show(view, box)) continue;
            ++left_out;
            for (int i = 0; i < 20; ++i) {
                const vec3 v = box.lo +
                               (box.hi - box.lo) *
                                   vec3(share(random), share(random), share(random)) -
                               eye;
                const float w = dot(view.forward, v);
                EXPECT_FALSE(w > 0 && std::abs(dot(view.right, v)) <= w &&
                             std::abs(dot(view.down, v)) <= w);
            }
        }
    }
    EXPECT_GT(left_out, 6000u); // culled faces; most boxes are visible in one or two of six faces
}

TEST(Culling, BallWithAVisiblePointIsNeverCulled) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> coordinate(-1, 1), size(.05f, .5f);
    std::normal_distribution<float> normal;
    std::size_t left_out = 0, by_box = 0;
    for (int round = 0; round < 2000; ++round) {
        const vec3 eye(coordinate(random), coordinate(random), coordinate(random));
        const vec3 centre(coordinate(random), coordinate(random), coordinate(random));
        render::DrawRange ball;
        ball.radius = size(random);
        ball.bounds = {centre - ball.radius, centre + ball.radius};
        for (const shared::View& view : render::make_cube_views(eye, .01f)) {
            by_box += !render::may_show(view, ball.bounds);
            if (render::may_show(view, ball)) continue;
            ++left_out;
            for (int i = 0; i < 40; ++i) {
                const vec3 out(normal(random), normal(random), normal(random));
                const vec3 v = centre + ball.radius * normalize(out) - eye;
                const float w = dot(view.forward, v);
                EXPECT_FALSE(w > 0 && std::abs(dot(view.right, v)) <= w &&
                             std::abs(dot(view.down, v)) <= w);
            }
        }
    }
    EXPECT_GT(left_out, by_box + 300);
}

TEST(NearPlanes, NearPlaneIsTheLargestPowerOfTwoThatCutsNothingOff) {
    for (const float gap : {1e-3f, .3f, .5f, .51f, 1.f, 3.9f, 4.f, 100.f}) {
        const float near = render::make_cube_views(vec3(1, 2, 3), gap)[4].near;
        int exponent = 0;
        EXPECT_EQ(std::frexp(near, &exponent), .5f) << gap;
        // The nearest point may lie in a corner of the view, where its depth along the view axis is
        // 1 / sqrt(3) of its distance.
        EXPECT_LE(near, gap / 2) << gap;
        EXPECT_GT(near, gap / 4) << gap;
    }
}

} // namespace
