// Part two of the report: one capture a mirror and frame; deeper bounces arrive from last frame's
// captures, so frame k shows k of them. R = N + 2.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kFragment = "reflect/naive.frag";
constexpr Knob kKnobs[] = {kFace, kColour, kShadow, kShadowMapEdge};

constexpr std::string_view kCompared[] = {"reuse"};

constexpr Technique kReuse{
    .name = "reuse",
    .summary = "One capture per mirror and frame; deeper bounces arrive from the frame before.",
    .order = 2,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = feedback_passes,
    .capture = capture_options,
    .in_captures = kFragment,
    .search = kFragment};
const Registered kRow{kReuse};

} // namespace

} // namespace catoptric::reflect
