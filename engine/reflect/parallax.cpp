// Part three of the report. Captures also hold distance, and one step corrects the reflected
// direction. `distance=unorm8` stores distance as the report did: in eight bits, clamped at
// `range`.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kFragment = "reflect/parallax.frag";
constexpr std::array<std::string_view, 3> kRules{"none", "saturation", "void_test"};
enum class Rule { none, saturation, void_test };
constexpr Knob kWithout{.name = "without",
                        .help = "rule of robustness to leave out, to measure its cost",
                        .high = 2,
                        .choices = kRules};
constexpr Knob kKnobs[] = {kFace, kColour,   kDistance, kRange,         kRough,  kLaw,
                           kTaps, kLobeRays, kShadow,   kShadowMapEdge, kWithout};

render::CaptureOptions capture(const render::FrameInputs& inputs, const KnobSettings& settings) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.saturates = settings.as<Rule>(kWithout) != Rule::saturation;
    return options;
}

constexpr std::string_view kCompared[] = {"parallax"};

constexpr Technique kParallax{
    .name = "parallax",
    .summary = "As reuse, but corrects the reflected direction once, from the captured distance.",
    .order = 3,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = count_feedback_passes,
    .capture = capture,
    .in_captures = kFragment,
    .look = [](graph::Graph&, const render::FrameInputs&, const KnobSettings& settings,
               const MirrorInputs& around) {
        MirrorShading look{make_capture_shader(around, kFragment, settings), {}};
        if (settings.as<Rule>(kWithout) == Rule::void_test)
            look.mirror.constants.emplace_back("tests_void", 0u);
        return look;
    }};
const RegisteredTechnique kRow{kParallax};

} // namespace

} // namespace catoptric::reflect
