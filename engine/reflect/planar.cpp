// A flat mirror shows a mirrored view: the scene from the eye mirrored in the mirror's plane,
// clipped there (Diefenbach and Badler 1997). This is exact except at the edges of triangles. A
// rough mirror shows its view blurred. A mirror seen in a mirror needs a view within a view. Of a
// body with flat faces, each face that the eye is in front of has a view. R = 2 + views.
#include "reflect/captures.hpp"

#include <cstdio>

namespace catoptric::reflect {

namespace {

/// Returns the techniques that may draw mirrors which are not flat.
std::span<const std::string_view> rest_techniques() {
    static const std::vector<std::string_view> kNames = [] {
        std::vector<std::string_view> names;
        for (const Technique* technique : techniques())
            if (technique->traits.draws_any_mirror()) names.push_back(technique->name);
        return names;
    }();
    return kNames;
}

constexpr Knob kBounces{
    .name = "bounces",
    .help = "depth of views: number of flat mirrors in a row that a mirrored view shows; 0: black",
    .low = 0,
    .high = 16,
    .value = 2};
constexpr Knob kRest{.name = "rest",
                     .help = "technique of mirrors that are not flat",
                     .find_choices = rest_techniques};
constexpr std::array<std::string_view, 4> kPlanarRoughChoices{"none", "mips", "prefilter", "rest"};
constexpr int kRoughByRest = 3; // index of "rest"
constexpr Knob kPlanarRough{
    .name = "rough",
    .help = "look-up of rough mirrors in their view: none (sharp), mips (one box-filtered level), "
            "prefilter (directions of the GGX lobe, each in a box-filtered level), rest (the "
            "technique of the knob rest draws rough mirrors)",
    .high = kPlanarRoughChoices.size() - 1,
    .value = 2,
    .choices = kPlanarRoughChoices};
constexpr std::array<std::string_view, 2> kPlanarLawChoices{"none", "cone"};
constexpr Knob kPlanarLaw{
    .name = "law",
    .help = "how the blur of a rough mirror depends on the distance of the reflected surface: none "
            "(it does not), or cone",
    .high = kPlanarLawChoices.size() - 1,
    .value = 1,
    .choices = kPlanarLawChoices};
constexpr Knob kPlanarTaps{.name = "taps",
                           .help = "look-ups of each rough pixel for rough=prefilter",
                           .low = 1,
                           .high = 1024,
                           .value = 16};
constexpr Knob kKnobs[] = {kBounces,    kRest,      kPlanarRough, kPlanarLaw,
                           kPlanarTaps, kIndirect,  kProbes,      kAmbientOcclusion,
                           kShadow,     kShadowMap, kSoftShadow,  kOthersFace};

std::string describe_misfit(const scene::FlatFaces& flats, double tolerance,
                            const KnobSettings& settings) {
    if (!flats.misfit.empty()) return std::string(flats.misfit);
    if (flats.is_rough && settings.integer(kPlanarRough) == kRoughByRest) return "rough";
    if (flats.flat_share(tolerance) >= scene::kMinFlatShare) return {};
    char text[96] = "not flat";
    if (flats.flat_share(scene::kMaxPlaneDeviation) >= scene::kMinFlatShare)
        std::snprintf(text, sizeof text, "%.2g rad off a plane, where %.2g would do",
                      flats.faces.front().off, tolerance);
    return text;
}

MirroredViewOptions read_view_options(const KnobSettings& settings) {
    MirroredViewOptions options;
    options.bounces = settings.integer(kBounces);
    if (settings.integer(kPlanarRough) != kRoughByRest)
        options.rough = settings.get<RoughKnobs::Lookup>(kPlanarRough);
    if (settings.integer(kPlanarLaw) == 1) options.law = RoughKnobs::Law::cone;
    options.taps = static_cast<std::uint32_t>(settings.integer(kPlanarTaps));
    return options;
}

constexpr std::string_view kDefaultRows[] = {"planar"};

constexpr Technique kTechnique{
    .name = "planar",
    .summary = "Draws a mirrored view for each flat mirror, in each frame.",
    .order = 16,
    .traits = {.draws_mirrored_views = true},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes =
        [](int, int lights, const KnobSettings& settings) {
            return count_shadow_passes(lights, settings) + 1;
        },
    .look = [](graph::Graph&, const render::FrameInputs&, const KnobSettings&,
               const ShadingInputs&) { return MirrorShading{}; },
    .mirrored_views = read_view_options,
    .unfit = describe_misfit,
    .rest = &kRest};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
