// Part three of the seed report. Captures also hold distance, and one step corrects the reflected
// direction. `distance=unorm8` stores distance as the report did: in eight bits, clamped at
// `range`.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kParallaxShader = "reflect/parallax.frag";
constexpr std::array<std::string_view, 3> kOmittedParallaxRuleChoices{"none", "saturation",
                                                                      "void_test"};
enum class OmittedParallaxRule { none, saturation, void_test };
constexpr Knob kOmittedParallaxRuleKnob{
    .name = "without",
    .help = "rule of robustness to leave out, to measure its cost",
    .high = 2,
    .choices = kOmittedParallaxRuleChoices};
constexpr Knob kParallaxKnobs[] = {kCaptureFaceKnob,
                                   kCaptureColourKnob,
                                   kCaptureDistanceKnob,
                                   kDistanceRangeKnob,
                                   kRoughMirrorMethodKnob,
                                   kBlurLawKnob,
                                   kFilterTapsKnob,
                                   kRoughRaysKnob,
                                   kGlassRefractionModelKnob,
                                   kIndirectLightKnob,
                                   kLightProbesKnob,
                                   kAmbientOcclusionKnob,
                                   kShadowKnob,
                                   kShadowMapEdgeKnob,
                                   kSoftShadowKnob,
                                   kOmittedParallaxRuleKnob};

render::CaptureOptions make_parallax_capture_options(const render::FrameInputs& inputs,
                                                     const KnobSettings& settings) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.saturates = settings.get<OmittedParallaxRule>(kOmittedParallaxRuleKnob) !=
                        OmittedParallaxRule::saturation;
    return options;
}

constexpr std::string_view kParallaxDefaultRows[] = {"parallax"};

constexpr Technique kParallaxTechnique{
    .name = "parallax",
    .summary = "As reuse, but corrects the reflected direction once, from the captured distance.",
    .order = 3,
    .traits = {.captures = TechniqueTraits::Captures::shared,
               .seed_part = TechniqueTraits::SeedPart::parallax},
    .knobs = kParallaxKnobs,
    .compared = kParallaxDefaultRows,
    .scene_passes = count_capture_passes_with_feedback,
    .capture = make_parallax_capture_options,
    .in_captures = kParallaxShader,
    .look = [](graph::Graph&, const render::FrameInputs&, const KnobSettings& settings,
               const MirrorShadingInputs& around) {
        MirrorShadingSetup look{make_capture_shader(around, kParallaxShader, settings), {}};
        if (settings.get<OmittedParallaxRule>(kOmittedParallaxRuleKnob) ==
            OmittedParallaxRule::void_test)
            look.mirror.constants.emplace_back("tests_void", 0u);
        return look;
    }};
const RegisteredTechnique kParallaxRegistration{kParallaxTechnique};

} // namespace

} // namespace catoptric::reflect
