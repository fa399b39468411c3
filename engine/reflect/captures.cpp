#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

ShadowKnobs::Method read_shadow_method(const KnobSettings& settings) {
    using enum ShadowKnobs::Method;
    constexpr ShadowKnobs::Method kRasterShadowMethods[] = {map, none},
                                  kTracedShadows[] = {ray, map, none};
    if (settings.has(kShadow)) return kRasterShadowMethods[settings.integer(kShadow)];
    return settings.has(kTracedShadow) ? kTracedShadows[settings.integer(kTracedShadow)] : none;
}

/// Returns the value of a knob, or nothing if there is no such knob or its special word is set.
std::optional<std::uint32_t> find_number(const KnobSettings& settings, const Knob& knob) {
    if (!settings.has(knob) || settings.is_special(knob)) return std::nullopt;
    return static_cast<std::uint32_t>(settings.integer(knob));
}

/// Returns whether the second choice of a knob with two choices is selected.
bool is_second_choice(const KnobSettings& settings, const Knob& knob) {
    return settings.has(knob) && settings.integer(knob) == 1;
}

} // namespace

SharedKnobs read_knobs(const KnobSettings& settings) {
    constexpr TexelFormat kDistanceFormats[] = {TexelFormat::r32f, TexelFormat::r16f,
                                                TexelFormat::r8_unorm};
    SharedKnobs knobs;
    knobs.shadow.method = read_shadow_method(settings);
    knobs.shadow.edge = find_number(settings, kShadowMap).value_or(1);
    knobs.shadow.is_soft = is_second_choice(settings, kSoftShadow);
    knobs.capture.face = find_number(settings, kFace);
    knobs.capture.every = find_number(settings, kEvery).value_or(1);
    knobs.capture.chooses_face = settings.has(kFace) && !knobs.capture.face;
    knobs.capture.stores_floats = is_second_choice(settings, kColour);
    if (settings.has(kDistance))
        knobs.capture.distance = kDistanceFormats[settings.integer(kDistance)];
    if (settings.has(kRange)) knobs.capture.range = settings.number(kRange);
    knobs.search.continues = find_number(settings, kContinue).value_or(0);
    knobs.search.by_object = is_second_choice(settings, kLookup);
    knobs.search.asks_all = is_second_choice(settings, kSearchedCaptures);
    knobs.search.leaves_out_spheres = is_second_choice(settings, kCapturedMirrors);
    if (settings.has(kRough)) {
        knobs.rough.lookup = settings.get<RoughKnobs::Lookup>(kRough);
        knobs.rough.taps = static_cast<std::uint32_t>(settings.integer(kTaps));
        knobs.rough.rays = static_cast<std::uint32_t>(settings.integer(kRays));
    }
    if (settings.has(kLaw)) knobs.rough.law = settings.get<RoughKnobs::Law>(kLaw);
    if (settings.has(kRefract))
        knobs.refract = static_cast<std::uint32_t>(settings.integer(kRefract));
    if (settings.has(kProbes)) {
        knobs.light.indirect = settings.get<LightKnobs::Indirect>(kIndirect);
        knobs.light.occlusion = settings.get<LightKnobs::Occlusion>(kAmbientOcclusion);
        knobs.light.most_probes = *find_number(settings, kProbes);
    }
    knobs.others.face = find_number(settings, kOthersFace);
    knobs.others.is_black = settings.has(kOthersFace) && !knobs.others.face;
    return knobs;
}

int count_shadow_passes(int lights, const KnobSettings& settings) {
    return read_shadow_method(settings) == ShadowKnobs::Method::map ? lights : 0;
}

render::CaptureOptions make_capture_options(const render::FrameInputs& inputs,
                                            const KnobSettings& settings) {
    const SharedKnobs knobs = read_knobs(settings);
    render::CaptureOptions options;
    options.face = knobs.capture.face ? *knobs.capture.face : inputs.scene.common_face_edge();
    if (knobs.capture.stores_floats) {
        check(inputs.scene.device().filters_floats(), Failure::no_device,
              "colour=float filters images of 32-bit floats, which device '",
              inputs.scene.device().info().name, "' cannot; take colour=half");
        options.colour = TexelFormat::rgba32f;
    }
    options.every = knobs.capture.every;
    if (!knobs.capture.distance) return options;
    options.distance = knobs.capture.distance;
    if (options.distance == TexelFormat::r8_unorm)
        options.stored_unit = inputs.scene.scene_units().to_scene_length(knobs.capture.range);
    const bool continues = knobs.search.continues > 0;
    const bool wants_normals = knobs.rough.uses_levels() &&
                               knobs.rough.law == RoughKnobs::Law::exact &&
                               inputs.scene.has_rough_mirrors();
    options.surfaces = knobs.search.by_object || knobs.search.asks_all || wants_normals ||
                       (continues && inputs.scene.has_complex_mirrors());
    // A blurred look-up of a rough mirror does not follow rays through other mirrors, so captures
    // must show the other mirrors.
    options.leaves_out_spheres = continues && knobs.search.leaves_out_spheres &&
                                 !(knobs.rough.uses_levels() && inputs.scene.has_rough_mirrors());
    return options;
}

void remove_view_images(render::MirrorShader& look) {
    std::erase_if(look.images, [](const auto& image) {
        return image.first == kGlassBackImage || image.first == kOpaquePictureImage ||
               image.first == kOpaqueLevelImage;
    });
    for (auto& [name, value] : look.constants)
        if (name == "refract_model") value = other_view_refraction(std::get<std::uint32_t>(value));
}

render::MirrorShader make_capture_shader(const ShadingInputs& around, std::string fragment,
                                         const KnobSettings& settings) {
    render::MirrorShader look;
    look.fragment = std::move(fragment);
    const auto set = [&](const char* constant, int value) {
        look.constants.emplace_back(constant, static_cast<std::uint32_t>(value));
    };
    for (const auto& [knob, constant] : {std::pair{&kContinue, "hops"},
                                         {&kLookup, "by_object"},
                                         {&kSearchedCaptures, "asks_others"},
                                         {&kShow, "show"},
                                         {&kRefract, "refract_model"}})
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

render::MirrorShader make_search_shader(const Technique& technique, const ShadingInputs& around,
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
