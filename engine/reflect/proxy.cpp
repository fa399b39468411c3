// The oldest parallax correction. One box (Lagarde and Zanuttini 2012) or one sphere (Brennan 2002)
// stands for everything around the mirror. The shape is not placed by hand: each frame derives it
// from the captured distances.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 2> kShapeChoices{"box", "sphere"};
constexpr Knob kShape{.name = "shape",
                      .help = "shape that approximates the surroundings",
                      .high = 1,
                      .choices = kShapeChoices};
constexpr auto kKnobs = [] {
    auto knobs = search_knobs(std::array{kShape});
    std::ranges::find(knobs, kContinue.name, &Knob::name)->value =
        0; // as published: rays are not followed through other mirrors
    return knobs;
}();
constexpr std::uint64_t kStructBytes = 28; // size of Proxy in shaders/reflect/proxy.glsl

/// Declares the pass that derives one proxy per mirror. Returns the buffer of proxies.
graph::BufferHandle add_proxy_pass(graph::Graph& graph, const render::FrameInputs& inputs,
                                   const std::shared_ptr<const render::MirrorCaptures>& captures) {
    const std::uint32_t mirrors = inputs.scene.mirror_count();
    const graph::BufferHandle proxies = graph.add_buffer(
        {inputs.prefix + "proxies", kStructBytes * mirrors});
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + "proxies");
    std::vector<graph::ImageHandle> faces;
    for (const render::CubeCaptureArray& cubes : captures->arrays) {
        faces.push_back(
            cubes.distance.value_or(cubes.colour)); // placeholder: never read without distance
        pass.reads(faces.back(), graph::ResourceUse::sampled);
    }
    gpu::ComputeState state{"reflect/proxy.comp", {}};
    const render::CaptureOptions& options = captures->options.front();
    if (captures->table) {
        state.constants = {{"has_capture_table", 1u},
                           {"array_count", static_cast<std::uint32_t>(captures->arrays.size())},
                           {"stored_unit", 0.f}};
        pass.reads(*captures->table, graph::ResourceUse::sampled);
    } else {
        state.constants = {{"stored_unit", options.stored_unit},
                           {"range_ends", options.distance == TexelFormat::r8_unorm ? 1u : 0u}};
    }
    pass.writes(proxies, graph::ResourceUse::storage_write)
        .record([=, table = captures->table](graph::PassCommands& commands) {
            commands.bind_pipeline(state);
            commands.bind("distance_faces", faces);
            commands.bind("Proxies", proxies);
            commands.bind("nearest_texels", graph::TextureFilter::nearest);
            if (table) commands.bind("Captures", *table);
            commands.dispatch(mirrors, 1);
        });
    return proxies;
}

MirrorShading make_proxy_shading(graph::Graph& graph, const render::FrameInputs& inputs,
                                 const KnobSettings& settings, const ShadingInputs& around) {
    MirrorShading look{make_capture_shader(around, "reflect/proxy.frag", settings), {}};
    look.mirror.buffers.emplace_back("Proxies", add_proxy_pass(graph, inputs, around.captures));
    look.mirror.constants.emplace_back("shape",
                                       static_cast<std::uint32_t>(settings.integer(kShape)));
    return look;
}

constexpr Technique kTechnique{
    .name = "proxy",
    .summary =
        "Approximates each mirror's surroundings by a box or sphere, derived from the capture.",
    .order = 10,
    .traits = {.captures = TechniqueTraits::Captures::shared},
    .knobs = kKnobs,
    .scene_passes = count_capture_passes,
    .capture = make_capture_options,
    .in_captures = "reflect/parallax.frag",
    .reads_whole_cubes = true,
    .look = make_proxy_shading};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
