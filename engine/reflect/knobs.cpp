#include "reflect/knobs.hpp"

namespace catoptric::reflect {

render::Lighting add_lighting(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    if (settings.choice("shadow") != "map") return {};
    return {render::add_shadow(graph, inputs, static_cast<std::uint32_t>(settings.integer("shadow_map")))};
}

int shadow_passes(int lights, const Settings& settings) { return settings.choice("shadow") == "map" ? lights : 0; }

render::CaptureOptions capture_options(const render::FrameInputs& inputs, const Settings& settings,
                                       const render::Lighting& lighting) {
    render::CaptureOptions options;
    options.face = static_cast<std::uint32_t>(settings.integer("face"));
    options.lighting = lighting;
    if (!settings.has("distance")) return options;
    constexpr Format kFormats[] = {Format::r32f, Format::r16f, Format::r8_unorm};
    options.distance = kFormats[settings.integer("distance")];
    if (options.distance == Format::r8_unorm)
        options.stored_unit = inputs.scene.space().length(settings.number("range"));
    return options;
}

render::MirrorLook look_into(std::string fragment, const render::Cubes& cubes, const render::CaptureOptions& options) {
    render::MirrorLook look;
    look.fragment = std::move(fragment);
    look.cubes = cubes;
    if (cubes.distance) look.constants.emplace_back("stored_unit", options.stored_unit);
    return look;
}

Outputs add_with_feedback(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings,
                          const std::string& fragment) {
    const render::Lighting lighting = add_lighting(graph, inputs, settings);
    render::CaptureOptions options = capture_options(inputs, settings, lighting);
    if (inputs.scene.mirror_count() == 0) return {render::add_view(graph, inputs, lighting, {}), {}, {}};
    const render::Cubes cubes = render::declare_cubes(graph, inputs, options);
    render::Cubes last{graph.previous(cubes.colour), {}};
    if (cubes.distance) last.distance = graph.previous(*cubes.distance);
    options.look = look_into(fragment, last, options);
    options.look.blank = !graph.has_history(cubes.colour);
    render::add_captures(graph, inputs, options, cubes);
    return {render::add_view(graph, inputs, lighting, look_into(fragment, cubes, options)), {}, {}};
}

} // namespace catoptric::reflect
