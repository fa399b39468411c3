#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

ShadowKnobs::Method read_shadow_method(const KnobSettings& settings) {
    using enum ShadowKnobs::Method;
    constexpr ShadowKnobs::Method kRasterShadowMethods[] = {map, none},
                                  kTracedShadows[] = {ray, map, none};
    if (settings.has(kShadowKnob)) return kRasterShadowMethods[settings.integer(kShadowKnob)];
    return settings.has(kTracedShadowKnob) ? kTracedShadows[settings.integer(kTracedShadowKnob)]
                                           : none;
}

/// Returns the value of a knob, or nothing if there is no such knob or its special word is set.
std::optional<std::uint32_t> find_knob_number(const KnobSettings& settings, const Knob& knob) {
    if (!settings.has(knob) || settings.is_special(knob)) return std::nullopt;
    return static_cast<std::uint32_t>(settings.integer(knob));
}

/// Returns whether the second choice of a knob with two choices is selected.
bool has_second_choice_of_knob(const KnobSettings& settings, const Knob& knob) {
    return settings.has(knob) && settings.integer(knob) == 1;
}

} // namespace

SharedKnobs read_shared_knobs(const KnobSettings& settings) {
    constexpr TexelFormat kDistanceFormats[] = {TexelFormat::r32f, TexelFormat::r16f,
                                                TexelFormat::r8_unorm};
    SharedKnobs knobs;
    knobs.shadow.method = read_shadow_method(settings);
    knobs.shadow.edge = find_knob_number(settings, kShadowMapEdgeKnob).value_or(1);
    knobs.shadow.is_soft = has_second_choice_of_knob(settings, kSoftShadowKnob);
    knobs.capture.face = find_knob_number(settings, kCaptureFaceKnob);
    knobs.capture.chooses_face = settings.has(kCaptureFaceKnob) && !knobs.capture.face;
    knobs.capture.stores_floats = has_second_choice_of_knob(settings, kCaptureColourKnob);
    if (settings.has(kCaptureDistanceKnob))
        knobs.capture.distance = kDistanceFormats[settings.integer(kCaptureDistanceKnob)];
    if (settings.has(kDistanceRangeKnob)) knobs.capture.range = settings.number(kDistanceRangeKnob);
    knobs.search.continues = find_knob_number(settings, kContinuedSearchesKnob).value_or(0);
    knobs.search.by_object = has_second_choice_of_knob(settings, kCaptureTexelLookupKnob);
    knobs.search.asks_all = has_second_choice_of_knob(settings, kSearchedCapturesKnob);
    knobs.search.leaves_out_spheres = has_second_choice_of_knob(settings, kMirrorsInCapturesKnob);
    if (settings.has(kRoughMirrorMethodKnob)) {
        knobs.rough.lookup = settings.get<RoughKnobs::Lookup>(kRoughMirrorMethodKnob);
        knobs.rough.taps = static_cast<std::uint32_t>(settings.integer(kFilterTapsKnob));
        knobs.rough.rays = static_cast<std::uint32_t>(settings.integer(kRoughRaysKnob));
    }
    if (settings.has(kBlurLawKnob)) knobs.rough.law = settings.get<RoughKnobs::Law>(kBlurLawKnob);
    if (settings.has(kGlassRefractionModelKnob))
        knobs.refract = static_cast<std::uint32_t>(settings.integer(kGlassRefractionModelKnob));
    if (settings.has(kLightProbesKnob)) {
        knobs.light.indirect = settings.get<LightKnobs::Indirect>(kIndirectLightKnob);
        knobs.light.occlusion = settings.get<LightKnobs::Occlusion>(kAmbientOcclusionKnob);
        knobs.light.most_probes = *find_knob_number(settings, kLightProbesKnob);
    }
    knobs.others.face = find_knob_number(settings, kCaptureForOtherMirrorsKnob);
    knobs.others.is_black = settings.has(kCaptureForOtherMirrorsKnob) && !knobs.others.face;
    return knobs;
}

int count_shadow_passes(int lights, const KnobSettings& settings) {
    return read_shadow_method(settings) == ShadowKnobs::Method::map ? lights : 0;
}

render::CaptureOptions make_capture_options(const render::FrameInputs& inputs,
                                            const KnobSettings& settings) {
    const SharedKnobs knobs = read_shared_knobs(settings);
    render::CaptureOptions options;
    options.face = knobs.capture.face ? *knobs.capture.face : inputs.scene.common_face_edge();
    if (knobs.capture.stores_floats) {
        check(inputs.scene.device().filters_floats(), Failure::no_device,
              "colour=float filters images of 32-bit floats, which device '",
              inputs.scene.device().info().name, "' cannot; take colour=half");
        options.colour = TexelFormat::rgba32f;
    }
    if (!knobs.capture.distance) return options;
    options.distance = knobs.capture.distance;
    if (options.distance == TexelFormat::r8_unorm)
        options.stored_unit = inputs.scene.scene_units().to_scene_length(knobs.capture.range);
    const bool continues = knobs.search.continues > 0;
    const bool wants_normals = knobs.rough.uses_filtered_levels() &&
                               knobs.rough.law == RoughKnobs::Law::exact &&
                               inputs.scene.has_rough_mirrors();
    options.surfaces = knobs.search.by_object || knobs.search.asks_all || wants_normals ||
                       (continues && inputs.scene.has_complex_mirrors());
    // A blurred look-up of a rough mirror does not follow rays through other mirrors, so captures
    // must show the other mirrors.
    options.leaves_out_spheres = continues && knobs.search.leaves_out_spheres &&
                                 !(knobs.rough.uses_filtered_levels() &&
                                   inputs.scene.has_rough_mirrors());
    return options;
}

void remove_images_of_camera_view(render::MirrorShader& look) {
    std::erase_if(look.images, [](const auto& image) {
        return image.first == kGlassBackImage || image.first == kOpaquePictureImage ||
               image.first == kOpaqueLevelImage;
    });
    for (auto& [name, value] : look.constants)
        if (name == "refract_model")
            value = choose_refraction_model_of_other_views(std::get<std::uint32_t>(value));
}

render::MirrorShader make_capture_shader(const MirrorShadingInputs& around, std::string fragment,
                                         const KnobSettings& settings) {
    render::MirrorShader look;
    look.fragment = std::move(fragment);
    const auto set = [&](const char* constant, int value) {
        look.constants.emplace_back(constant, static_cast<std::uint32_t>(value));
    };
    for (const auto& [knob, constant] : {std::pair{&kContinuedSearchesKnob, "hops"},
                                         {&kCaptureTexelLookupKnob, "by_object"},
                                         {&kSearchedCapturesKnob, "asks_others"},
                                         {&kShownDebugPictureKnob, "show"},
                                         {&kGlassRefractionModelKnob, "refract_model"}})
        if (settings.has(*knob)) set(constant, settings.integer(*knob));
    // Among mirrors with the same technique, either all captures hold surface numbers or none does.
    // All mirrors are checked, because some may have no capture.
    if (std::ranges::any_of(around.mirrors, [&](std::uint32_t mirror) {
            const render::CubeCaptureArray* const cubes = around.captures->find_array(mirror);
            return cubes && cubes->surfaces;
        }))
        set("has_surfaces", 1);
    look.captures = around.captures;
    return look;
}

render::MirrorShader make_search_shader(const Technique& technique,
                                        const MirrorShadingInputs& around,
                                        const KnobSettings& settings) {
    render::MirrorShader look = make_capture_shader(around, technique.search, settings);
    for (const Knob& knob : technique.knobs) {
        if (std::ranges::find(kCommonSearchKnobs, knob.name, &Knob::name) !=
            kCommonSearchKnobs.end())
            continue;
        const double value = settings.number(knob);
        if (knob.is_real)
            look.constants.emplace_back(knob.name, static_cast<float>(value));
        else
            look.constants.emplace_back(knob.name, static_cast<std::uint32_t>(value));
    }
    return look;
}

} // namespace catoptric::reflect
