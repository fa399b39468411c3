// A flat mirror shows a mirrored view: the scene from the eye mirrored in the mirror's plane,
// clipped there (Diefenbach and Badler 1997). This is exact except at the edges of triangles. A
// mirror seen in a mirror needs a view within a view. Of a body with flat faces, each face that the
// eye is in front of has a view. R = 2 + views.
#include "reflect/captures.hpp"

#include <cstdio>

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 9> kNonPlanarMirrorTechniqueChoices{
    "reuse", "parallax", "proxy", "secant", "pyramid", "march", "layered", "hybrid", "raytrace"};
constexpr TechniqueKnob kPlanarBouncesKnob{
    .name = "bounces",
    .help = "depth of views: number of flat mirrors in a row that a mirrored view shows; 0: black",
    .low = 0,
    .high = 16,
    .value = 2};
constexpr TechniqueKnob kNonPlanarMirrorTechniqueKnob{
    .name = "rest",
    .help = "technique of mirrors that are not flat",
    .high = kNonPlanarMirrorTechniqueChoices.size() - 1,
    .choices = kNonPlanarMirrorTechniqueChoices};
constexpr TechniqueKnob kPlanarKnobs[] = {kPlanarBouncesKnob,
                                          kNonPlanarMirrorTechniqueKnob,
                                          kIndirectLightKnob,
                                          kLightProbesKnob,
                                          kShadowKnob,
                                          kShadowMapEdgeKnob,
                                          kCaptureContentCacheKnob};

std::string describe_why_mirror_is_not_planar(const scene::FlatFaces& flats, double tolerance) {
    if (!flats.misfit.empty()) return std::string(flats.misfit);
    if (flats.flat_area_share(tolerance) >= scene::kMinFlatAreaShare) return {};
    char text[96] = "not flat";
    if (flats.flat_area_share(scene::kMaxPlaneDeviation) >= scene::kMinFlatAreaShare)
        std::snprintf(text, sizeof text, "%.2g rad off a plane, where %.2g would do",
                      flats.faces.front().off, tolerance);
    return text;
}

constexpr std::string_view kPlanarDefaultRows[] = {"planar"};

constexpr Technique kPlanarTechnique{
    .name = "planar",
    .summary = "Draws a mirrored view for each flat mirror, in each frame.",
    .order = 16,
    .knobs = kPlanarKnobs,
    .compared = kPlanarDefaultRows,
    .scene_passes =
        [](int, int lights, const TechniqueKnobSettings& settings) {
            return count_shadow_passes(lights, settings) + 1;
        },
    .look = [](graph::Graph&, const render::FrameInputs&, const TechniqueKnobSettings&,
               const MirrorShadingInputs&) { return MirrorShadingSetup{}; },
    .mirrored_bounces =
        [](const TechniqueKnobSettings& settings) {
            return settings.knob_value_as_integer(kPlanarBouncesKnob);
        },
    .unfit = describe_why_mirror_is_not_planar,
    .rest = &kNonPlanarMirrorTechniqueKnob};
const RegisteredTechnique kPlanarRegistration{kPlanarTechnique};

} // namespace

} // namespace catoptric::reflect
