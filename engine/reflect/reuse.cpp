// Part two of the seed report. Each mirror has one capture per frame. Deeper bounces come from the
// captures of the last frame, so frame k shows k bounces. R = N + 2.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kShader = "reflect/naive.frag";
constexpr Knob kKnobs[] = {kFace,   kEvery,     kColour,    kRough,  kTaps,
                           kRays,   kRefract,   kIndirect,  kProbes, kAmbientOcclusion,
                           kShadow, kShadowMap, kSoftShadow};

constexpr std::string_view kDefaultRows[] = {"reuse"};

constexpr Technique kTechnique{
    .name = "reuse",
    .summary = "Draws one capture per mirror and frame; deeper bounces come from the last frame's "
               "captures.",
    .order = 2,
    .traits = {.captures = TechniqueTraits::Captures::shared,
               .seed_part = TechniqueTraits::SeedPart::last_captures},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes = count_capture_passes,
    .capture = make_capture_options,
    .in_captures = kShader,
    .search = kShader};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
