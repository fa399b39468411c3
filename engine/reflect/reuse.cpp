// Part two of the seed report. Each mirror has one capture per frame. Deeper bounces come from the
// captures of the last frame, so frame k shows k bounces. R = N + 2.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kReuseShader = "reflect/naive.frag";
constexpr Knob kReuseKnobs[] = {
    kFace,   kColour,           kRough,  kTaps,      kRays,      kRefract, kIndirect,
    kProbes, kAmbientOcclusion, kShadow, kShadowMap, kSoftShadow};

constexpr std::string_view kReuseDefaultRows[] = {"reuse"};

constexpr Technique kReuseTechnique{
    .name = "reuse",
    .summary = "Draws one capture per mirror and frame; deeper bounces come from the last frame's "
               "captures.",
    .order = 2,
    .traits = {.captures = TechniqueTraits::Captures::shared,
               .seed_part = TechniqueTraits::SeedPart::last_captures},
    .knobs = kReuseKnobs,
    .compared = kReuseDefaultRows,
    .scene_passes = count_capture_passes,
    .capture = make_capture_options,
    .in_captures = kReuseShader,
    .search = kReuseShader};
const RegisteredTechnique kReuseRegistration{kReuseTechnique};

} // namespace

} // namespace catoptric::reflect
