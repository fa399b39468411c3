// Part three of the seed report. Captures also hold distance, and one step corrects the reflected
// direction. `distance=unorm8` stores distance as the report did: in eight bits, clamped at
// `range`.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kShader = "reflect/parallax.frag";
constexpr std::array<std::string_view, 3> kWithoutChoices{"none", "saturation", "void_test"};
enum class ParallaxRule { none, saturation, void_test };
constexpr Knob kWithout{.name = "without",
                        .help = "rule of robustness to leave out, to measure its cost",
                        .high = 2,
                        .choices = kWithoutChoices};
constexpr Knob kKnobs[] = {kFace,
                           kEvery,
                           kColour,
                           kDistance,
                           kRange,
                           kRough,
                           kLaw,
                           kTaps,
                           kRays,
                           kRefract,
                           kIndirect,
                           kProbes,
                           kAmbientOcclusion,
                           kShadow,
                           kShadowMap,
                           kSoftShadow,
                           kWithout};

render::CaptureOptions make_parallax_options(const render::FrameInputs& inputs,
                                             const KnobSettings& settings) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.saturates = settings.get<ParallaxRule>(kWithout) != ParallaxRule::saturation;
    return options;
}

constexpr std::string_view kDefaultRows[] = {"parallax"};

constexpr Technique kTechnique{
    .name = "parallax",
    .summary = "As reuse, but corrects the reflected direction once, from the captured distance.",
    .order = 3,
    .traits = {.captures = TechniqueTraits::Captures::shared,
               .seed_part = TechniqueTraits::SeedPart::parallax},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes = count_capture_passes,
    .capture = make_parallax_options,
    .in_captures = kShader,
    .look = [](graph::Graph&, const render::FrameInputs&, const KnobSettings& settings,
               const ShadingInputs& around) {
        MirrorShading look{make_capture_shader(around, kShader, settings), {}};
        if (settings.get<ParallaxRule>(kWithout) == ParallaxRule::void_test)
            look.mirror.constants.emplace_back("tests_void", 0u);
        return look;
    }};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
