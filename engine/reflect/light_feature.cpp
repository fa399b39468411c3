// What lights diffuse surfaces apart from lamps: light probes, and what hides the environment.
#include "reflect/feature.hpp"
#include "render/ambient_occlusion.hpp"

#include <algorithm>
#include <cstdio>

namespace catoptric::reflect {

namespace {

using Occlusion = LightKnobs::Occlusion;

bool has_some(const std::vector<TechniqueChoice>& choices, Occlusion occlusion) {
    return std::ranges::any_of(choices, [=](const TechniqueChoice& choice) {
        return choice.shared.light.occlusion == occlusion;
    });
}

bool has_probe_light(const FrameDeclaration& frame) {
    return std::ranges::any_of(frame.choices(), [](const TechniqueChoice& choice) {
        return choice.shared.light.has_probe_light();
    });
}

/// Returns the most light probes of the frame's grid: the largest number of its techniques. 0: no
/// technique needs light probes.
std::uint32_t most_probes(const FrameDeclaration& frame) {
    std::uint32_t most = 0;
    for (const TechniqueChoice& choice : frame.choices())
        if (choice.shared.light.has_probe_light() ||
            (choice.shared.light.uses_probes() && frame.inputs.scene.has_environment_light()))
            most = std::max(most, choice.shared.light.most_probes);
    return most;
}

constexpr FrameFeature kLightProbeFeature{
    .name = "light probes",
    .order = feature_order::kLightProbes,
    .applies = [](const FrameDeclaration& frame) { return most_probes(frame) > 0; },
    .add =
        [](FrameDeclaration& frame) {
            // If some technique has light between surfaces, light probes hold it for all.
            frame.probes = render::declare_light_probes(
                frame.graph, frame.inputs, most_probes(frame),
                has_probe_light(frame) ? shared::kLightProbesOfSurfaces
                                       : shared::kLightProbesOfEnvironment);
        }};
const RegisteredFeature kLightProbeRegistration{kLightProbeFeature};

constexpr FrameFeature kLightProbeCaptureFeature{
    .name = "captures of light probes",
    .order = feature_order::kLightProbeCaptures,
    .applies = [](const FrameDeclaration& frame) { return frame.probes && is_rasterised(frame); },
    .add =
        [](FrameDeclaration& frame) {
            render::add_light_probes(frame.graph, frame.inputs, *frame.probes, frame.lighting,
                                     frame.captures
                                         ? frame.captured_looks
                                         : render::use_same_shader(frame.inputs.scene, {}));
            frame.outputs.draws_everything = true;
            if (!frame.probes->note.empty()) frame.outputs.notes.push_back(frame.probes->note);
            if (frame.history.most > 0)
                frame.outputs.notes.emplace_back(
                    "light probes need all captures, so no budget limits them");
            if (std::ranges::any_of(frame.choices(), [](const TechniqueChoice& choice) {
                    return choice.shared.capture.every > 1;
                }))
                frame.outputs.notes.emplace_back(
                    "light probes need all captures in each frame, so 'every' has no effect");
        }};
const RegisteredFeature kLightProbeCaptureRegistration{kLightProbeCaptureFeature};

/// Adds notes on values of `ao` that have no effect. Light probes of ao=captures already know what
/// hides the light.
void note_unused_occlusion(FrameDeclaration& frame) {
    const bool has_light = has_probe_light(frame);
    if (!has_some(frame.choices(), Occlusion::captures)) return;
    if (has_light)
        frame.outputs.notes.emplace_back(
            "ao=captures has no effect beside indirect=captures, whose light probes know what "
            "hides the environment");
    else if (has_some(frame.choices(), Occlusion::screen))
        frame.outputs.notes.emplace_back("ao=screen has no effect beside ao=captures, whose light "
                                         "probes know what hides the environment");
}

/// Returns whether surfaces of the camera's view hide light from each other.
bool has_screen_occlusion(const FrameDeclaration& frame) {
    const bool has_light = has_probe_light(frame);
    return has_some(frame.choices(), Occlusion::screen) &&
           (has_light || (!has_some(frame.choices(), Occlusion::captures) &&
                          frame.inputs.scene.has_environment_light()));
}

constexpr FrameFeature kOcclusionFeature{
    .name = "occlusion",
    .order = feature_order::kOcclusion,
    .applies =
        [](const FrameDeclaration& frame) {
            return is_rasterised(frame) && (has_some(frame.choices(), Occlusion::screen) ||
                                            has_some(frame.choices(), Occlusion::captures));
        },
    .add =
        [](FrameDeclaration& frame) {
            note_unused_occlusion(frame);
            if (!has_screen_occlusion(frame)) return;
            char note[96];
            std::snprintf(note, sizeof note,
                          "ao=screen: surfaces up to %.3g world units away hide the %s",
                          render::occlusion_radius(frame.inputs.scene),
                          has_probe_light(frame) ? "light of light probes" : "environment");
            frame.outputs.notes.emplace_back(note);
            frame.view_lighting.ambient_occlusion = render::add_ambient_occlusion(frame.graph,
                                                                                  frame.inputs);
        }};
const RegisteredFeature kOcclusionRegistration{kOcclusionFeature};

} // namespace

} // namespace catoptric::reflect
