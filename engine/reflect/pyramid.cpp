// Builds the least and largest distances of ever larger cells of the captures. The search skips a
// cell in one step if these bounds allow it. It is exact to the texel, whereas `march` may step
// over thin objects.
#include "reflect/pyramid.hpp"

#include "core/content_hash.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

namespace catoptric::reflect {

namespace {

constexpr auto kKnobs = search_knobs(std::array<Knob, 0>{});

/// Returns the topmost level, which has one cell per face. Must match level_edge
/// and top_level in shaders/reflect/pyramid.glsl.
std::uint32_t top_level(std::uint32_t face) {
    return face <= 2 ? 1 : static_cast<std::uint32_t>(std::bit_width(face - 1));
}
std::uint32_t level_edge(std::uint32_t face, std::uint32_t level) {
    return (face + (1u << level) - 1) >> level;
}

/// Consecutive cubes of one array.
struct PyramidRange {
    graph::ImageHandle distances, bounds;
    std::uint32_t face = 0;
};

/// Returns the content hash of the distance bounds of a mirror's cube. It covers the whole cube,
/// because cells at the edge of a face read the neighbouring faces.
std::uint64_t hash_bounds(const render::MirrorCaptures& captures, std::size_t mirror) {
    const render::CaptureOptions& options = captures.options[mirror];
    return ContentHash()
        .add(captures.drawings[mirror])
        .add(options.distance.value_or(options.colour))
        .add(options.stored_unit)
        .add(options.leaves_out_spheres)
        .sum();
}

/// Returns the cubes of the array whose stored bounds are out of date, as runs.
std::vector<PyramidRange> find_outdated_pyramids(graph::Graph& graph,
                                                 const render::MirrorCaptures& captures,
                                                 std::uint32_t array, graph::ImageHandle bounds) {
    const render::CubeCaptureArray& cubes = captures.arrays[array];
    // Captures that no search reads have no distance. Their colour is a placeholder that is never
    // read.
    const graph::ImageHandle distances = cubes.distance.value_or(cubes.colour);
    std::vector<PyramidRange> runs;
    for (const CubeRange& run :
         find_outdated_cubes(graph, captures, array, bounds,
                             [&](std::uint32_t mirror) { return hash_bounds(captures, mirror); }))
        runs.push_back({distances.layers(run.first, run.count), bounds.layers(run.first, run.count),
                        cubes.face});
    return runs;
}

/// Declares the pyramids of all arrays: all levels of all faces, one layer per face. Each level of
/// each run of cubes is one dispatch. If captures are kept from frame to frame, the pyramids are
/// kept as well.
std::vector<graph::ImageHandle> add_pyramid_passes(graph::Graph& graph,
                                                   const render::FrameInputs& inputs,
                                                   const render::MirrorCaptures& captures) {
    std::vector<graph::ImageHandle> pyramids;
    std::vector<PyramidRange> runs;
    std::uint32_t top_of_all = 0;
    for (std::uint32_t array = 0; array < captures.arrays.size(); ++array) {
        const render::CubeCaptureArray& cubes = captures.arrays[array];
        const std::uint32_t top = top_level(cubes.face);
        top_of_all = std::max(top_of_all, top);
        graph::ImageDesc desc{inputs.prefix + "pyramid" + (array ? std::to_string(array + 1) : ""),
                              TexelFormat::r32ui, 1u << top, level_edge(cubes.face, 1),
                              cubes.colour.layer_count};
        pyramids.push_back(captures.drawings.empty() ? graph.add_image(std::move(desc))
                                                     : graph.add_persistent(std::move(desc)));
        std::ranges::copy(find_outdated_pyramids(graph, captures, array, pyramids.back()),
                          std::back_inserter(runs));
    }
    if (runs.empty()) return pyramids;
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + "pyramid");
    for (const PyramidRange& run : runs)
        pass.reads(run.distances, graph::ResourceUse::sampled)
            .writes(run.bounds, graph::ResourceUse::storage_write);
    pass.record([top_of_all, runs = std::move(runs)](graph::PassCommands& commands) {
        for (std::uint32_t level = 1; level <= top_of_all; ++level) {
            if (level > 1) commands.storage_barrier();
            commands.bind_pipeline(
                gpu::ComputeState{"reflect/pyramid.comp", {{"from_cells", level > 1 ? 1u : 0u}}});
            commands.push_constants(static_cast<std::int32_t>(level));
            for (const PyramidRange& run : runs) {
                if (level > top_level(run.face)) continue;
                commands.bind("distances", run.distances);
                commands.bind("bounds", run.bounds);
                const std::uint32_t groups = (level_edge(run.face, level) + 7) / 8;
                commands.dispatch(groups, groups, run.bounds.layer_count);
            }
        }
    });
    return pyramids;
}

} // namespace

MirrorShading make_pyramid_shading(graph::Graph& graph, const render::FrameInputs& inputs,
                                   const KnobSettings& settings, const ShadingInputs& around) {
    MirrorShading look{make_capture_shader(around, "reflect/pyramid.frag", settings), {}};
    look.mirror.images.emplace_back("bounds", add_pyramid_passes(graph, inputs, *around.captures));
    return look;
}

namespace {

constexpr std::string_view kDefaultRows[] = {"pyramid"};

constexpr Technique kTechnique{
    .name = "pyramid",
    .summary =
        "Follows the reflected ray through bounds of the captured distance, exact to the texel.",
    .order = 13,
    .traits = {.captures = TechniqueTraits::Captures::shared},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes = count_capture_passes,
    .capture = make_capture_options,
    .in_captures = "reflect/parallax.frag",
    .look = make_pyramid_shading};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
