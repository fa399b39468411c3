#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

SharedKnobs::ShadowMethod shadow_method_of(const KnobSettings& settings) {
    using enum SharedKnobs::ShadowMethod;
    constexpr SharedKnobs::ShadowMethod kRasterShadows[] = {map, none},
                                        kTracedShadows[] = {ray, map, none};
    if (settings.has_knob(kShadowKnob)) return kRasterShadows[settings.integer_value(kShadowKnob)];
    return settings.has_knob(kTracedShadowKnob)
               ? kTracedShadows[settings.integer_value(kTracedShadowKnob)]
               : none;
}

/// Returns the value of a knob, or nothing if there is no such knob or its special word is set.
std::optional<std::uint32_t> find_knob_number(const KnobSettings& settings, const Knob& knob) {
    if (!settings.has_knob(knob) || settings.is_special(knob)) return std::nullopt;
    return static_cast<std::uint32_t>(settings.integer_value(knob));
}

/// Returns whether a knob of two choices has the second.
bool has_second_choice(const KnobSettings& settings, const Knob& knob) {
    return settings.has_knob(knob) && settings.integer_value(knob) == 1;
}

} // namespace

SharedKnobs shared_knobs(const KnobSettings& settings) {
    constexpr Format kDistanceFormats[] = {Format::r32f, Format::r16f, Format::r8_unorm};
    SharedKnobs knobs{.shadow = shadow_method_of(settings)};
    knobs.shadow_map = find_knob_number(settings, kShadowMapEdgeKnob).value_or(1);
    knobs.face = find_knob_number(settings, kFaceKnob);
    knobs.chooses_face = settings.has_knob(kFaceKnob) && !knobs.face;
    knobs.stores_floats = has_second_choice(settings, kColourKnob);
    if (settings.has_knob(kDistanceKnob))
        knobs.distance = kDistanceFormats[settings.integer_value(kDistanceKnob)];
    if (settings.has_knob(kDistanceRangeKnob))
        knobs.range = settings.number_value(kDistanceRangeKnob);
    knobs.continues = find_knob_number(settings, kContinueKnob).value_or(0);
    knobs.by_object = has_second_choice(settings, kLookupKnob);
    knobs.asks_all = has_second_choice(settings, kCapturesKnob);
    knobs.leaves_out_spheres = has_second_choice(settings, kMirrorsKnob);
    if (settings.has_knob(kRoughKnob)) {
        knobs.rough = settings.enum_value<SharedKnobs::Rough>(kRoughKnob);
        knobs.taps = static_cast<std::uint32_t>(settings.integer_value(kTapsKnob));
        knobs.lobe_rays = static_cast<std::uint32_t>(settings.integer_value(kRoughRaysKnob));
    }
    if (settings.has_knob(kBlurLawKnob))
        knobs.law = settings.enum_value<SharedKnobs::Law>(kBlurLawKnob);
    knobs.capture = find_knob_number(settings, kCaptureKnob);
    knobs.is_black_in_others = settings.has_knob(kCaptureKnob) && !knobs.capture;
    return knobs;
}

int count_shadow_passes(int lights, const KnobSettings& settings) {
    return shadow_method_of(settings) == SharedKnobs::ShadowMethod::map ? lights : 0;
}

render::CaptureOptions make_capture_options(const render::FrameInputs& inputs,
                                            const KnobSettings& settings) {
    const SharedKnobs knobs = shared_knobs(settings);
    render::CaptureOptions options;
    options.face = knobs.face ? *knobs.face : inputs.scene.common_face_edge();
    if (knobs.stores_floats) {
        check(inputs.scene.device().has_float_filtering(), Failure::no_device,
              "colour=float filters images of 32-bit floats, which device '",
              inputs.scene.device().info().name, "' cannot; take colour=half");
        options.colour = Format::rgba32f;
    }
    if (!knobs.distance) return options;
    options.distance = knobs.distance;
    if (options.distance == Format::r8_unorm)
        options.stored_unit = inputs.scene.space().to_scene_length(knobs.range);
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
    for (const auto& [knob, constant] : {std::pair{&kContinueKnob, "hops"},
                                         {&kLookupKnob, "by_object"},
                                         {&kCapturesKnob, "asks_others"},
                                         {&kShowKnob, "show"}})
        if (settings.has_knob(*knob)) set(constant, settings.integer_value(*knob));
    // The captures of mirrors that share a technique all hold surface numbers, or none does. Some
    // mirrors may have no capture, so all are checked.
    if (std::ranges::any_of(around.mirrors, [&](std::uint32_t mirror) {
            const render::CubeArray* const cubes = around.captures->array_of_mirror(mirror);
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
        const double value = settings.number_value(knob);
        if (knob.is_real)
            look.constants.emplace_back(knob.name, static_cast<float>(value));
        else
            look.constants.emplace_back(knob.name, static_cast<std::uint32_t>(value));
    }
    return look;
}

} // namespace catoptric::reflect
