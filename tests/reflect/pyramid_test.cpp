// Tests of the pyramid, a tree of bounds of the captured distances. The bounds of each cell must
// contain every bilinear lookup in the cell, and the search with them must be exact.
#include "core/half.hpp"
#include "core/shader_math.hpp"
#include "measure/lookup.hpp"
#include "scene/built_in.hpp"
#include "stress/glyph_room.hpp"
#include "support/captures.hpp"
#include "support/searches.hpp"
#include "support/techniques.hpp"

#include <random>
#include <sstream>

namespace {

using namespace catoptric;

graph::ImageHandle find_image_by_name(const graph::Graph& graph, const std::string& name) {
    const auto& images = graph.images();
    const auto found = std::ranges::find(images, name, &graph::ImageDesc::name);
    if (found == images.end()) throw std::runtime_error("no image " + name);
    return {static_cast<std::uint32_t>(found - images.begin()), 0, found->layers};
}

/// The pyramid over a technique's captures, and the results of lookups in a list of directions.
struct PyramidReadBack {
    std::uint32_t face = 0;
    std::vector<std::uint32_t> cells;
    std::vector<vec4> linear, nearest; ///< colour, and distance in w

    /// Returns the number of levels. This test computes sizes and places itself, from the
    /// description in shaders/reflect/pyramid.glsl.
    std::uint32_t count_levels() const {
        std::uint32_t level = 1;
        while ((1u << level) < face) ++level;
        return level;
    }
    /// Returns the smallest and largest distance of a cell.
    vec2 distance_bounds_of_cell(std::uint32_t level, std::uint32_t layer, std::uint32_t x,
                                 std::uint32_t y) const {
        const std::uint32_t width = 1u << count_levels(), height = (face + 1) / 2;
        std::uint32_t column = 0;
        for (std::uint32_t k = 1; k < level; ++k) column += width >> k;
        const std::uint32_t both = cells[(std::size_t{layer} * height + y) * width + column + x];
        return {half_to_float(static_cast<std::uint16_t>(both)),
                half_to_float(static_cast<std::uint16_t>(both >> 16))};
    }
    std::uint32_t count_cells_across_level(std::uint32_t level) const {
        return (face + (1u << level) - 1) >> level;
    }
};

PyramidReadBack build_and_read_pyramid(const scene::Scene& scene, const std::string& technique,
                                       const std::vector<vec4>& directions) {
    auto& [device, pipelines] = test::get_test_device();
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene, scene.cameras.front(), {16, 16}, .05);
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    render::FrameRequests requests(gpu_scene.next_view());
    const render::FrameInputs inputs{gpu_scene, requests, {16, 16}, ""};
    const reflect::TechniqueChoice choice = reflect::parse_choice(technique);
    test::add_technique(graph, inputs, technique);
    const graph::ImageHandle pyramid = find_image_by_name(graph, "pyramid"),
                             colour = find_image_by_name(graph, "capture/cubes.colour");
    const graph::ImageHandle distance = find_image_by_name(graph, "capture/cubes.distance");
    gpu::Buffer asked(device, "directions", directions.size() * sizeof(vec4),
                      gpu::BufferUsage::plain);
    asked.write(std::span<const vec4>(directions));
    std::array<graph::BufferHandle, 2> found;
    for (int i = 0; i < 2; ++i) {
        found[i] = graph.add_buffer(
            {"found" + std::to_string(i), directions.size() * sizeof(vec4)});
        graph.add_pass("look" + std::to_string(i))
            .reads(colour, graph::ResourceUse::sampled)
            .reads(distance, graph::ResourceUse::sampled)
            .writes(found[i], graph::ResourceUse::storage_write)
            .record([=, &asked, count = directions.size()](graph::PassCommands& commands) {
                commands.bind_pipeline(gpu::ComputeState{"tests/cube_sample.comp", {}});
                commands.bind("colour_cubes", colour, graph::TextureFilter::linear);
                commands.bind("distance_cubes", distance,
                              i == 0 ? graph::TextureFilter::linear
                                     : graph::TextureFilter::nearest);
                commands.bind("Directions", asked);
                commands.bind("Found", found[i]);
                commands.dispatch(static_cast<std::uint32_t>((count + 63) / 64), 1);
            });
        graph.output(found[i]);
    }
    graph.output(pyramid);
    test::run_graph(runner, graph);
    return {*choice.shared.capture.face, test::read_resource_values<std::uint32_t>(runner, pyramid),
            test::read_resource_values<vec4>(runner, found[0]),
            test::read_resource_values<vec4>(runner, found[1])};
}

/// Returns random directions, many of them along edges and at corners of cube faces. The component
/// w holds the number of the mirror.
std::vector<vec4> make_random_directions(std::uint32_t mirrors) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<vec4> made;
    for (int i = 0; i < 60000; ++i) {
        vec3 direction(normal(random), normal(random), normal(random));
        if (i % 3 == 1)
            direction = f32::cube_direction(
                i % 6, vec3(i % 2 ? 1.0f : -1.0f, uniform(random), 1.0f) + 1e-3f * direction);
        if (i % 9 == 2)
            direction = f32::cube_direction(
                i % 6,
                vec3(i % 2 ? 1.0f : -1.0f, i % 4 < 2 ? 1.0f : -1.0f, 1.0f) + 1e-2f * direction);
        made.emplace_back(direction, static_cast<float>(static_cast<std::uint32_t>(i) % mirrors));
    }
    return made;
}

class Bounds : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Pyramid, Bounds,
                         testing::Values("face=1", "face=2", "face=3", "face=5", "face=37",
                                         "face=64", "face=100", "face=64,distance=r16f",
                                         "face=64,distance=unorm8,range=1000"),
                         [](const auto& settings) {
                             std::string name;
                             for (const char c : settings.param)
                                 if (std::isalnum(c)) name += c;
                             return name;
                         });

TEST_P(Bounds, BoundsContainEveryLookup) {
    const std::vector<vec4> asked = make_random_directions(4);
    const PyramidReadBack read = build_and_read_pyramid(scene::make_cornell(),
                                                        "pyramid:" + GetParam(), asked);
    std::size_t outside = 0, judged = 0, nothing = 0;
    std::ostringstream first;
    first.precision(9);
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const vec3 direction(asked[i]);
        const int face = f32::cube_face(direction);
        const vec3 place = f32::cube_coordinates(face, direction);
        // If all four texels of a lookup are infinite, the lookup takes the nearest texel.
        const float found = std::isfinite(read.linear[i].w) ? read.linear[i].w : read.nearest[i].w;
        const vec2 at = glm::clamp((vec2(place) / place.z * .5f + .5f) *
                                       static_cast<float>(read.face),
                                   vec2(0), vec2(static_cast<float>(read.face) - .5f));
        for (std::uint32_t level = 1; level <= read.count_levels(); ++level) {
            const vec2 bounds = read.distance_bounds_of_cell(
                level,
                6 * static_cast<std::uint32_t>(asked[i].w) + static_cast<std::uint32_t>(face),
                static_cast<std::uint32_t>(at.x) >> level,
                static_cast<std::uint32_t>(at.y) >> level);
            ++judged;
            nothing += std::isinf(found);
            const float roundings = std::isinf(found) ? 0 : 4 * found * 0x1p-24f;
            const bool is_outside = !(bounds.x <= found + roundings &&
                                      found - roundings <= bounds.y);
            outside += is_outside;
            if (is_outside && outside == 1)
                first << direction.x << ' ' << direction.y << ' ' << direction.z << ", level "
                      << level << ": " << found << " is not in " << bounds.x << " to " << bounds.y;
        }
    }
    EXPECT_GE(judged, asked.size());
    const bool has_nothing = GetParam().find("unorm8") == std::string::npos;
    EXPECT_EQ(nothing > 0, has_nothing) << "the room is open to the front";
    EXPECT_EQ(outside, 0u) << first.str();
}

TEST_P(Bounds, BoundsOfACellCoverThoseOfItsChildren) {
    const PyramidReadBack read = build_and_read_pyramid(
        scene::make_cornell(), "pyramid:" + GetParam(), make_random_directions(4));
    std::size_t wrong = 0;
    for (std::uint32_t layer = 0; layer < 24; ++layer)
        for (std::uint32_t level = 2; level <= read.count_levels(); ++level)
            for (std::uint32_t y = 0; y < read.count_cells_across_level(level); ++y)
                for (std::uint32_t x = 0; x < read.count_cells_across_level(level); ++x) {
                    vec2 wanted(std::numeric_limits<float>::infinity(), 0);
                    for (std::uint32_t child = 0; child < 4; ++child) {
                        const std::uint32_t cx = 2 * x + child % 2, cy = 2 * y + child / 2;
                        if (std::max(cx, cy) >= read.count_cells_across_level(level - 1)) continue;
                        const vec2 bounds = read.distance_bounds_of_cell(level - 1, layer, cx, cy);
                        wanted = {std::min(wanted.x, bounds.x), std::max(wanted.y, bounds.y)};
                    }
                    wrong += read.distance_bounds_of_cell(level, layer, x, y) != wanted;
                }
    EXPECT_EQ(wrong, 0u);
}

/// Inside a face, the bounds of a cell must be those of its 2x2 texels and the ring around them.
/// The bounds are rounded outwards to half floats.
TEST(Pyramid, BoundsAreNoWiderThanTheirTexels) {
    constexpr std::uint32_t kCaptureFaceTexels = 64;
    const scene::Scene scene = scene::make_cornell();
    const test::CapturedCubes captured = test::capture_mirrors(scene, kCaptureFaceTexels,
                                                               TexelFormat::r32f);
    const PyramidReadBack read = build_and_read_pyramid(scene, "pyramid:face=64",
                                                        make_random_directions(4));
    std::size_t wrong = 0;
    std::ostringstream first;
    first.precision(9);
    for (std::uint32_t layer = 0; layer < 24; ++layer)
        for (std::uint32_t y = 1; y + 1 < kCaptureFaceTexels / 2; ++y)
            for (std::uint32_t x = 1; x + 1 < kCaptureFaceTexels / 2; ++x) {
                vec2 wanted(std::numeric_limits<float>::infinity(), 0);
                for (std::uint32_t k = 0; k < 16; ++k) {
                    const float d = captured.distance(layer / 6, static_cast<int>(layer % 6),
                                                      2 * x - 1 + k % 4, 2 * y - 1 + k / 4,
                                                      TexelFormat::r32f);
                    wanted = {std::min(wanted.x, d), std::max(wanted.y, d)};
                }
                const vec2 bounds = read.distance_bounds_of_cell(1, layer, x, y);
                for (int i = 0; i < 2; ++i)
                    wrong += std::isinf(wanted[i])
                                 ? bounds[i] != wanted[i]
                                 : !(std::abs(bounds[i] - wanted[i]) <= 0x1p-10f * wanted[i]);
                wrong += bounds.x > wanted.x || bounds.y < wanted.y;
                if (wrong > 0 && first.str().empty())
                    first << "layer " << layer << ", cell " << x << ' ' << y << ": wanted "
                          << wanted.x << " to " << wanted.y << ", found " << bounds.x << " to "
                          << bounds.y;
            }
    EXPECT_EQ(wrong, 0u) << first.str();
}

/// Returns the mean error in degrees of reflected rays on a device that interpolates positions and
/// normals between vertices that it has snapped to 1/256 of a pixel.
double snapped_vertices_error() { return test::computes_like_cpp() ? 0 : .005; }

TEST(Pyramid, SearchFindsTheWallsOfAnEmptyRoom) {
    for (const int face : {16, 37, 64, 256}) {
        const auto pixels = test::measure_lookup_directions(
            stress::LetterRoom().make_scene(), "pyramid:face=" + std::to_string(face), {128, 128});
        ASSERT_GT(pixels.size(), 1000u);
        EXPECT_EQ(std::ranges::count(pixels, 0, &measure::LookupError::state), std::ssize(pixels))
            << "face " << face;
        const measure::LookupSummary error = measure::summarise_lookups(pixels);
        double worst = 0;
        for (const measure::LookupError& pixel : pixels)
            worst = std::max(worst, pixel.angle_degrees);
        std::cout << "[ MEASURED ] face " << face << ": mean angle " << error.mean_degrees
                  << ", worst " << worst << " degrees\n";
        // Bilinear distances are wrong by less than a texel in the corners of the room. On flat
        // walls the error is of second order in the size of a texel.
        const double texel = 90.0 / face;
        EXPECT_LT(worst, texel);
        EXPECT_LT(error.mean_degrees, texel * texel / 90 + snapped_vertices_error());
    }
}

TEST(Pyramid, HitsAreExactAndMissesAreTrue) {
    const auto pixels = test::measure_lookup_directions(
        scene::make_cornell(), "pyramid:face=256,continue=0", test::kSearchTestPictureSize);
    std::array<std::size_t, 3> count{}, wrong{};
    double hit_angle = 0, miss_angle = 0;
    for (const measure::LookupError& pixel : pixels) {
        ++count[static_cast<std::size_t>(pixel.state)];
        wrong[static_cast<std::size_t>(pixel.state)] += pixel.wrong_object;
        if (pixel.state == 0) hit_angle += pixel.angle_degrees;
        if (pixel.state == 2) miss_angle = std::max(miss_angle, pixel.angle_degrees);
    }
    hit_angle /= static_cast<double>(count[0]);
    std::cout << "[ MEASURED ] hits " << count[0] << ", mean angle " << hit_angle
              << " degrees, wrong object " << wrong[0] << "; unknown " << count[1] << "; misses "
              << count[2] << ", worst angle " << miss_angle << ", wrong object " << wrong[2]
              << "\n";
    // degrees; a hundredth of a texel
    EXPECT_LT(hit_angle, 90.0 / 256 / 100 + snapped_vertices_error());
    EXPECT_LT(wrong[0], count[0] / 200);
    EXPECT_LT(miss_angle, .01);
    EXPECT_LT(wrong[2], count[2] / 200);
}

} // namespace
