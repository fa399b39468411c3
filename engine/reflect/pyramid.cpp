// Least and largest distance of ever larger cells of the captures, and a search that passes a cell
// in one step wherever these bounds allow it: exact to the texel, where a march takes its chances.
#include "reflect/pyramid.hpp"

#include <bit>

namespace catoptric::reflect {

namespace {

constexpr auto kKnobs = search_knobs(std::array<Knob, 0>{});

/// The topmost level, one cell a face; level_edge and top_level of shaders/reflect/pyramid.glsl.
std::uint32_t top_level(std::uint32_t face) {
    return face <= 2 ? 1 : static_cast<std::uint32_t>(std::bit_width(face - 1));
}
std::uint32_t level_edge(std::uint32_t face, std::uint32_t level) {
    return (face + (1u << level) - 1) >> level;
}

/// All levels of all faces of each array, one layer a face: a dispatch a level.
std::vector<graph::Image> add_pyramid(graph::Graph& graph, const render::FrameInputs& inputs,
                                      const render::Captures& captures) {
    std::vector<graph::Image> pyramids;
    std::uint32_t top_of_all = 0;
    graph::PassBuilder pass = graph.pass(inputs.prefix + "pyramid");
    for (const render::Cubes& cubes : captures.arrays) {
        const std::string number = pyramids.empty() ? "" : std::to_string(pyramids.size() + 1);
        const std::uint32_t top = top_level(cubes.face);
        top_of_all = std::max(top_of_all, top);
        pyramids.push_back(
            graph.image({inputs.prefix + "pyramid" + number, Format::r32ui, 1u << top,
                         level_edge(cubes.face, 1), cubes.colour.layer_count}));
        // What nobody searches has no distance, and what stands for it is never read.
        pass.reads(cubes.distance.value_or(cubes.colour), graph::Use::sampled)
            .writes(pyramids.back(), graph::Use::storage_write);
    }
    pass.record([=, arrays = captures.arrays](graph::Commands& commands) {
        for (std::uint32_t level = 1; level <= top_of_all; ++level) {
            if (level > 1) commands.barrier();
            commands.use(
                gpu::ComputeState{"reflect/pyramid.comp", {{"from_cells", level > 1 ? 1u : 0u}}});
            commands.push(static_cast<std::int32_t>(level));
            for (std::size_t i = 0; i < arrays.size(); ++i) {
                if (level > top_level(arrays[i].face)) continue;
                commands.bind("distance_cubes", arrays[i].distance.value_or(arrays[i].colour));
                commands.bind("bounds", pyramids[i]);
                const std::uint32_t groups = (level_edge(arrays[i].face, level) + 7) / 8;
                commands.dispatch(groups, groups, arrays[i].colour.layer_count);
            }
        }
    });
    return pyramids;
}

} // namespace

Look look_through_pyramid(graph::Graph& graph, const render::FrameInputs& inputs,
                          const Settings& settings, const Surroundings& around) {
    Look look{look_into(around, "reflect/pyramid.frag", settings), {}};
    look.mirror.images.emplace_back("bounds", add_pyramid(graph, inputs, *around.captures));
    return look;
}

namespace {

constexpr std::string_view kCompared[] = {"pyramid"};

constexpr Technique kPyramid{
    .name = "pyramid",
    .summary =
        "Follows the reflected ray through bounds of the captured distance, exact to the texel.",
    .order = 13,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = feedback_passes,
    .capture = capture_options,
    .in_captures = "reflect/parallax.frag",
    .look = look_through_pyramid};
const Registered kRow{kPyramid};

} // namespace

} // namespace catoptric::reflect
