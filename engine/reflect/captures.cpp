#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

SharedKnobs::Shadow shadow_of(const KnobSettings& settings) {
    using enum SharedKnobs::Shadow;
    constexpr SharedKnobs::Shadow kRastered[] = {map, none}, kTraced[] = {ray, map, none};
    if (settings.has(kShadow)) return kRastered[settings.integer(kShadow)];
    return settings.has(kTracedShadow) ? kTraced[settings.integer(kTracedShadow)] : none;
}

/// Returns the value of a knob, or nothing if there is no such knob or its special word is set.
std::optional<std::uint32_t> number_of(const KnobSettings& settings, const Knob& knob) {
    if (!settings.has(knob) || settings.is_special(knob)) return std::nullopt;
    return static_cast<std::uint32_t>(settings.integer(knob));
}

/// Returns whether a knob of two choices has the second.
bool has_second(const KnobSettings& settings, const Knob& knob) {
    return settings.has(knob) && settings.integer(knob) == 1;
}

} // namespace

SharedKnobs shared_knobs(const KnobSettings& settings) {
    constexpr Format kFormats[] = {Format::r32f, Format::r16f, Format::r8_unorm};
    SharedKnobs knobs{.shadow = shadow_of(settings)};
    knobs.shadow_map = number_of(settings, kShadowMapEdge).value_or(1);
    knobs.face = number_of(settings, kFace);
    knobs.chooses_face = settings.has(kFace) && !knobs.face;
    knobs.stores_floats = has_second(settings, kColour);
    if (settings.has(kDistance)) knobs.distance = kFormats[settings.integer(kDistance)];
    if (settings.has(kRange)) knobs.range = settings.number(kRange);
    knobs.continues = number_of(settings, kContinue).value_or(0);
    knobs.by_object = has_second(settings, kLookup);
    knobs.asks_all = has_second(settings, kCaptures);
    knobs.leaves_out_spheres = has_second(settings, kMirrors);
    if (settings.has(kRough)) {
        knobs.rough = settings.as<SharedKnobs::Rough>(kRough);
        knobs.taps = static_cast<std::uint32_t>(settings.integer(kTaps));
        knobs.lobe_rays = static_cast<std::uint32_t>(settings.integer(kLobeRays));
    }
    if (settings.has(kLaw)) knobs.law = settings.as<SharedKnobs::Law>(kLaw);
    knobs.capture = number_of(settings, kCapture);
    knobs.is_black_in_others = settings.has(kCapture) && !knobs.capture;
    return knobs;
}

int count_shadow_passes(int lights, const KnobSettings& settings) {
    return shadow_of(settings) == SharedKnobs::Shadow::map ? lights : 0;
}

render::CaptureOptions make_capture_options(const render::FrameInputs& inputs,
                                            const KnobSettings& settings) {
    const SharedKnobs knobs = shared_knobs(settings);
    render::CaptureOptions options;
    options.face = knobs.face ? *knobs.face : inputs.scene.common_face();
    if (knobs.stores_floats) {
        check(inputs.scene.device().filters_floats(), Failure::no_device,
              "colour=float filters images of 32-bit floats, which device '",
              inputs.scene.device().info().name, "' cannot; take colour=half");
        options.colour = Format::rgba32f;
    }
    if (!knobs.distance) return options;
    options.distance = knobs.distance;
    if (options.distance == Format::r8_unorm)
        options.stored_unit = inputs.scene.space().length(knobs.range);
    const bool continues = knobs.continues > 0;
    const bool wants_normals = knobs.looks_up_levels() && knobs.law == SharedKnobs::Law::exact &&
                               inputs.scene.has_rough_mirrors();
    options.surfaces = knobs.by_object || knobs.asks_all || wants_normals ||
                       (continues && inputs.scene.has_other_mirrors());
    // A blurred look-up shows mirrors only by the capture.
    options.leaves_out_spheres = continues && knobs.leaves_out_spheres &&
                                 !(knobs.looks_up_levels() && inputs.scene.has_rough_mirrors());
    return options;
}

render::MirrorShader make_capture_shader(const MirrorInputs& around, std::string fragment,
                                         const KnobSettings& settings) {
    render::MirrorShader look;
    look.fragment = std::move(fragment);
    const auto set = [&](const char* constant, int value) {
        look.constants.emplace_back(constant, static_cast<std::uint32_t>(value));
    };
    for (const auto& [knob, constant] : {std::pair{&kContinue, "hops"},
                                         {&kLookup, "by_object"},
                                         {&kCaptures, "asks_others"},
                                         {&kShow, "show"}})
        if (settings.has(*knob)) set(constant, settings.integer(*knob));
    // The captures of mirrors that share a technique all hold surface numbers, or none does. Some
    // mirrors may have no capture, so all are checked.
    if (std::ranges::any_of(around.mirrors, [&](std::uint32_t mirror) {
            const render::CubeArray* const cubes = around.captures->array_of(mirror);
            return cubes && cubes->surfaces;
        }))
        set("has_surfaces", 1);
    look.captures = around.captures;
    return look;
}

render::MirrorShader make_search_shader(const Technique& technique, const MirrorInputs& around,
                                        const KnobSettings& settings) {
    render::MirrorShader look = make_capture_shader(around, technique.search, settings);
    for (const Knob& knob : technique.knobs) {
        if (std::ranges::find(kSearchKnobs, knob.name, &Knob::name) != kSearchKnobs.end()) continue;
        const double value = settings.number(knob);
        if (knob.is_real)
            look.constants.emplace_back(knob.name, static_cast<float>(value));
        else
            look.constants.emplace_back(knob.name, static_cast<std::uint32_t>(value));
    }
    return look;
}

} // namespace catoptric::reflect
