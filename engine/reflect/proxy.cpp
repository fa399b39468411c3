// The oldest correction: the surroundings are taken for one box (Lagarde and Zanuttini 2012) or one
// sphere (Brennan 2002). Nobody places it: it is derived from the captured distances of each frame.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 2> kShapes{"box", "sphere"};
constexpr auto kKnobs = [] {
    auto knobs = search_knobs(std::array{Knob{.name = "shape",
                                              .help = "what stands for the surroundings",
                                              .high = 1,
                                              .choices = kShapes}});
    std::ranges::find(knobs, "continue", &Knob::name)->value = 0; // as it was known
    return knobs;
}();
constexpr std::uint64_t kProxyBytes = 28; // Proxy of shaders/reflect/proxy.glsl

/// One proxy a mirror.
graph::Buffer add_proxies(graph::Graph& graph, const render::FrameInputs& inputs,
                          const Feedback& captured) {
    const std::uint32_t mirrors = inputs.scene.mirror_count();
    const graph::Image distance = *captured.cubes->distance;
    const graph::Buffer proxies = graph.buffer({inputs.prefix + "proxies", kProxyBytes * mirrors});
    const gpu::Constants constants{
        {"stored_unit", captured.options.stored_unit},
        {"range_ends", captured.options.distance == Format::r8_unorm ? 1u : 0u}};
    graph.pass(inputs.prefix + "proxies")
        .reads(distance, graph::Use::sampled)
        .writes(proxies, graph::Use::storage_write)
        .record([=](graph::Commands& commands) {
            commands.use(gpu::ComputeState{"reflect/proxy.comp", constants});
            commands.bind("distance_faces", distance);
            commands.bind("Proxies", proxies);
            commands.dispatch(mirrors, 1);
        });
    return proxies;
}

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    const Feedback captured = add_feedback(graph, inputs, settings, "reflect/parallax.frag");
    render::MirrorLook look = view_look(captured, settings, "reflect/proxy.frag");
    if (captured.cubes) look.buffers.emplace_back("Proxies", add_proxies(graph, inputs, captured));
    look.constants.emplace_back("shape", static_cast<std::uint32_t>(settings.integer("shape")));
    return add_view_of(graph, inputs, captured, look);
}

constexpr Technique kProxy{
    .name = "proxy",
    .summary =
        "Takes each mirror's surroundings for one box or sphere, derived from what was captured.",
    .order = 10,
    .knobs = kKnobs,
    .scene_passes = feedback_passes,
    .add = add};
const Registered kRow{kProxy};

} // namespace

} // namespace catoptric::reflect
