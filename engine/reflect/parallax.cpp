// Part three of the report. Captures also hold distance, and one step corrects the reflected
// direction. `distance=unorm8` stores distance as the report did: in eight bits, clamped at
// `range`.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kParallaxShader = "reflect/parallax.frag";
constexpr std::array<std::string_view, 3> kDroppedParallaxRuleChoices{"none", "saturation",
                                                                      "void_test"};
enum class DroppedParallaxRule { none, saturation, void_test };
constexpr TechniqueKnob kWithoutParallaxRuleKnob{
    .name = "without",
    .help = "rule of robustness to leave out, to measure its cost",
    .high = 2,
    .choices = kDroppedParallaxRuleChoices};
constexpr TechniqueKnob kParallaxKnobs[] = {
    kCaptureFaceKnob, kCaptureColourKnob, kCaptureDistanceKnob, kDistanceRangeKnob,
    kRoughKnob,       kBlurLawKnob,       kFilterTapsKnob,      kRoughRaysKnob,
    kRefractKnob,     kShadowKnob,        kShadowMapEdgeKnob,   kWithoutParallaxRuleKnob};

render::CaptureOptions make_parallax_capture_options(const render::FrameInputs& inputs,
                                                     const KnobSettings& settings) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.saturates = settings.knob_value_as_enum<DroppedParallaxRule>(
                            kWithoutParallaxRuleKnob) != DroppedParallaxRule::saturation;
    return options;
}

constexpr std::string_view kParallaxDefaultRows[] = {"parallax"};

constexpr Technique kParallaxTechnique{
    .name = "parallax",
    .summary = "As reuse, but corrects the reflected direction once, from the captured distance.",
    .order = 3,
    .knobs = kParallaxKnobs,
    .compared = kParallaxDefaultRows,
    .scene_passes = count_feedback_passes,
    .capture = make_parallax_capture_options,
    .in_captures = kParallaxShader,
    .look = [](graph::Graph&, const render::FrameInputs&, const KnobSettings& settings,
               const MirrorShadingInputs& around) {
        MirrorShading look{make_capture_shader(around, kParallaxShader, settings), {}};
        if (settings.knob_value_as_enum<DroppedParallaxRule>(kWithoutParallaxRuleKnob) ==
            DroppedParallaxRule::void_test)
            look.mirror.constants.emplace_back("tests_void", 0u);
        return look;
    }};
const RegisteredTechnique kParallaxRegistration{kParallaxTechnique};

} // namespace

} // namespace catoptric::reflect
