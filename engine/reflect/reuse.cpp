// Part two of the report. Each mirror has one capture per frame. Deeper bounces come from the
// captures of the last frame, so frame k shows k bounces. R = N + 2.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kFragment = "reflect/naive.frag";
constexpr Knob kKnobs[] = {kFace,     kColour, kRough,        kTaps,
                           kLobeRays, kShadow, kShadowMapEdge};

constexpr std::string_view kCompared[] = {"reuse"};

constexpr Technique kReuse{
    .name = "reuse",
    .summary = "Draws one capture per mirror and frame; deeper bounces come from the last frame's "
               "captures.",
    .order = 2,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = count_feedback_passes,
    .capture = make_capture_options,
    .in_captures = kFragment,
    .search = kFragment};
const RegisteredTechnique kRow{kReuse};

} // namespace

} // namespace catoptric::reflect
