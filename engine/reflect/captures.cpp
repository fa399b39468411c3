#include "reflect/captures.hpp"

namespace catoptric::reflect {

render::Lighting add_lighting(graph::Graph& graph, const render::FrameInputs& inputs,
                              const Settings& settings) {
    if (settings.choice("shadow") != "map") return {};
    return {render::add_shadow(graph, inputs,
                               static_cast<std::uint32_t>(settings.integer("shadow_map")))};
}

int shadow_passes(int lights, const Settings& settings) {
    return settings.choice("shadow") == "map" ? lights : 0;
}

render::CaptureOptions capture_options(const render::FrameInputs& inputs, const Settings& settings,
                                       const render::Lighting& lighting) {
    render::CaptureOptions options;
    options.face = settings.is_special("face")
                       ? inputs.scene.common_face()
                       : static_cast<std::uint32_t>(settings.integer("face"));
    options.lighting = lighting;
    if (settings.choice("colour") == "float") options.colour = Format::rgba32f;
    if (!settings.has("distance")) return options;
    constexpr Format kFormats[] = {Format::r32f, Format::r16f, Format::r8_unorm};
    options.distance = kFormats[settings.integer("distance")];
    if (options.distance == Format::r8_unorm)
        options.stored_unit = inputs.scene.space().length(settings.number("range"));
    if (settings.has("without")) options.saturates = settings.choice("without") != "saturation";
    const bool continues = settings.has("continue") && settings.integer("continue") > 0;
    const auto chosen = [&](const char* knob, const char* choice) {
        return settings.has(knob) && settings.choice(knob) == choice;
    };
    options.surfaces = chosen("lookup", "object") || chosen("captures", "all") ||
                       (continues && inputs.scene.has_other_mirrors());
    options.leaves_out_spheres = continues && chosen("mirrors", "left_out");
    return options;
}

render::MirrorLook look_into(std::string fragment, const render::Cubes& cubes,
                             const render::CaptureOptions& options) {
    render::MirrorLook look;
    look.fragment = std::move(fragment);
    look.cubes = cubes;
    if (cubes.distance) look.constants.emplace_back("stored_unit", options.stored_unit);
    return look;
}

Feedback add_feedback(graph::Graph& graph, const render::FrameInputs& inputs,
                      const Settings& settings, const std::string& fragment, bool second_layer) {
    Feedback captured;
    captured.lighting = add_lighting(graph, inputs, settings);
    captured.options = capture_options(inputs, settings, captured.lighting);
    captured.options.second_layer = second_layer;
    if (inputs.scene.mirror_count() == 0) return captured;
    captured.cubes = render::declare_cubes(graph, inputs, captured.options);
    render::Cubes last{graph.previous(captured.cubes->colour), {}};
    if (captured.cubes->distance) last.distance = graph.previous(*captured.cubes->distance);
    captured.options.look = look_into(fragment, last, captured.options);
    captured.options.look.blank = !graph.has_history(captured.cubes->colour);
    render::add_captures(graph, inputs, captured.options, *captured.cubes);
    return captured;
}

render::MirrorLook view_look(const Feedback& captured, const Settings& settings,
                             const std::string& fragment) {
    if (!captured.cubes) return {};
    render::MirrorLook look = look_into(fragment, *captured.cubes, captured.options);
    const auto set = [&](const char* constant, int value) {
        look.constants.emplace_back(constant, static_cast<std::uint32_t>(value));
    };
    for (const auto& [knob, constant] : {std::pair{"continue", "hops"},
                                         {"lookup", "by_object"},
                                         {"captures", "asks_others"},
                                         {"show", "show"}})
        if (settings.has(knob)) set(constant, settings.integer(knob));
    if (captured.cubes->surfaces) set("has_surfaces", 1);
    return look;
}

Outputs add_view_of(graph::Graph& graph, const render::FrameInputs& inputs,
                    const Feedback& captured, const render::MirrorLook& look) {
    const render::View view = render::add_view(graph, inputs, captured.lighting, look);
    return {view.hdr, {}, {}, view.lookup, captured.cubes};
}

} // namespace catoptric::reflect
