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

} // namespace

graph::Image add_pyramid(graph::Graph& graph, const render::FrameInputs& inputs,
                         const Feedback& captured) {
    const std::uint32_t face = captured.options.face, layers = 6 * inputs.scene.mirror_count(),
                        top = top_level(face);
    const graph::Image distance = *captured.cubes->distance;
    const graph::Image bounds = graph.image(
        {inputs.prefix + "pyramid", Format::r32ui, 1u << top, level_edge(face, 1), layers});
    graph.pass(inputs.prefix + "pyramid")
        .reads(distance, graph::Use::sampled)
        .writes(bounds, graph::Use::storage_write)
        .record([=](graph::Commands& commands) {
            commands.bind("distance_cubes", distance);
            commands.bind("bounds", bounds);
            for (std::uint32_t level = 1; level <= top; ++level) {
                if (level > 1) commands.barrier();
                commands.use(gpu::ComputeState{"reflect/pyramid.comp",
                                               {{"from_cells", level > 1 ? 1u : 0u}}});
                commands.push(static_cast<std::int32_t>(level));
                const std::uint32_t groups = (level_edge(face, level) + 7) / 8;
                commands.dispatch(groups, groups, layers);
            }
        });
    return bounds;
}

namespace {

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    const Feedback captured = add_feedback(graph, inputs, settings, "reflect/parallax.frag");
    render::MirrorLook look = view_look(captured, settings, "reflect/pyramid.frag");
    if (captured.cubes) look.images.emplace_back("bounds", add_pyramid(graph, inputs, captured));
    return add_view_of(graph, inputs, captured, look);
}

constexpr std::string_view kCompared[] = {"pyramid"};

constexpr Technique kPyramid{
    .name = "pyramid",
    .summary =
        "Follows the reflected ray through bounds of the captured distance, exact to the texel.",
    .order = 13,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = feedback_passes,
    .add = add};
const Registered kRow{kPyramid};

} // namespace

} // namespace catoptric::reflect
