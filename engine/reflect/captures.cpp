#include "reflect/captures.hpp"

namespace catoptric::reflect {

int shadow_passes(int lights, const Settings& settings) {
    return settings.choice("shadow") == "map" ? lights : 0;
}

render::CaptureOptions capture_options(const render::FrameInputs& inputs,
                                       const Settings& settings) {
    render::CaptureOptions options;
    options.face = settings.is_special("face")
                       ? inputs.scene.common_face()
                       : static_cast<std::uint32_t>(settings.integer("face"));
    if (settings.choice("colour") == "float") {
        check(inputs.scene.device().filters_floats(), Failure::no_device,
              "colour=float filters images of 32-bit floats, which device '",
              inputs.scene.device().info().name, "' cannot; take colour=half");
        options.colour = Format::rgba32f;
    }
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

bool visits_others(const Settings& settings) {
    return (settings.has("continue") && settings.integer("continue") > 0) ||
           (settings.has("captures") && settings.choice("captures") == "all");
}

render::MirrorShader shading_with_captures(const MirrorInputs& around, std::string fragment,
                                           const Settings& settings) {
    render::MirrorShader look;
    look.fragment = std::move(fragment);
    const auto set = [&](const char* constant, int value) {
        look.constants.emplace_back(constant, static_cast<std::uint32_t>(value));
    };
    for (const auto& [knob, constant] : {std::pair{"continue", "hops"},
                                         {"lookup", "by_object"},
                                         {"captures", "asks_others"},
                                         {"show", "show"}})
        if (settings.has(knob)) set(constant, settings.integer(knob));
    // The captures of mirrors that share a technique all hold surface numbers, or none does. Some
    // mirrors may have no capture, so all are checked.
    if (std::ranges::any_of(around.mirrors, [&](std::uint32_t mirror) {
            const render::Cubes* const cubes = around.captures->array_of(mirror);
            return cubes && cubes->surfaces;
        }))
        set("has_surfaces", 1);
    look.captures = around.captures;
    return look;
}

render::MirrorShader shading_of_search(const Technique& technique, const MirrorInputs& around,
                                       const Settings& settings) {
    render::MirrorShader look = shading_with_captures(around, technique.search, settings);
    for (const Knob& knob : technique.knobs) {
        if (std::ranges::find(kSearchKnobs, knob.name, &Knob::name) != kSearchKnobs.end()) continue;
        const double value = settings.number(knob.name);
        if (knob.is_real)
            look.constants.emplace_back(knob.name, static_cast<float>(value));
        else
            look.constants.emplace_back(knob.name, static_cast<std::uint32_t>(value));
    }
    return look;
}

} // namespace catoptric::reflect
