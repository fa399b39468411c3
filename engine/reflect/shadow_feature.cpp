// Shadow maps, and the lighting of the frame's views. Passes that ask for the same edge share a
// shadow map.
#include "reflect/feature.hpp"

#include <algorithm>

namespace catoptric::reflect {

render::ShadingLights FrameDeclaration::shadow_map(std::uint32_t edge) {
    const auto found = shadow_maps_.find(edge);
    if (found != shadow_maps_.end()) return found->second;
    const std::string suffix = shadow_maps_.empty() ? "" : "." + std::to_string(edge);
    render::ShadingLights made{
        render::add_shadows(graph, inputs, edge, continued_history().model, suffix),
        probes ? std::optional(probes->images) : std::nullopt};
    if (made.shadow_map && inputs.scene.has_tinted_shadows())
        made.glass_depths = render::add_glass_shadows(graph, inputs, *made.shadow_map, edge,
                                                      suffix);
    return shadow_maps_[edge] = made;
}

render::ShadingLights FrameDeclaration::light_with(const ShadowMapRequest& wanted) {
    if (!wanted.edge) return {.probes = probes ? std::optional(probes->images) : std::nullopt};
    render::ShadingLights made = shadow_map(*wanted.edge);
    made.has_soft_shadows = wanted.is_soft && made.shadow_map && inputs.scene.has_lamp_extents();
    if (made.has_soft_shadows) inputs.requests.draw_soft_shadows();
    return made;
}

ShadowMapRequest choose_shadow_map(const ShadowKnobs& knobs) {
    if (knobs.method != ShadowKnobs::Method::map) return {};
    return {knobs.edge, knobs.is_soft};
}

namespace {

bool completes_view(const std::vector<TechniqueChoice>& choices) {
    const TechniqueChoice& choice = choices.front();
    return choices.size() == 1 && choice.technique->completes_view(choice.settings);
}

/// Returns the view's shadow map: the finest that a technique asks for, read softly if one
/// technique asks for it. A view that is rasterised although its technique traces shadow rays needs
/// a shadow map.
ShadowMapRequest view_shadow_map(const FrameDeclaration& frame) {
    if (!frame.is_mixed() && !frame.completes_view)
        return choose_shadow_map(frame.choices().front().shared.shadow);
    ShadowMapRequest wanted;
    for (const TechniqueChoice& choice : frame.choices()) {
        if (choice.shared.shadow.method == ShadowKnobs::Method::none) continue;
        wanted.edge = std::max(wanted.edge.value_or(1), choice.shared.shadow.edge);
        wanted.is_soft = wanted.is_soft || choice.shared.shadow.is_soft;
    }
    return wanted;
}

constexpr FrameFeature kShadowFeature{
    .name = "shadow maps",
    .order = feature_order::kShadowMaps,
    .applies = [](const FrameDeclaration&) { return true; },
    .add =
        [](FrameDeclaration& frame) {
            frame.completes_view = completes_view(frame.choices());
            frame.lighting = frame.light_with(view_shadow_map(frame));
            frame.view_lighting = frame.lighting;
        }};
const RegisteredFeature kShadowRegistration{kShadowFeature};

} // namespace

} // namespace catoptric::reflect
