// Part two of the report: one capture a mirror and frame; deeper bounces arrive from last frame's
// captures, so frame k shows k of them. R = N + 2.
#include "reflect/knobs.hpp"

namespace catoptric::reflect {

namespace {

constexpr Knob kKnobs[] = {kFace, kShadow, kShadowMapEdge};

constexpr Technique kReuse{
    .name = "reuse",
    .summary = "One capture per mirror and frame; deeper bounces arrive from the frame before.",
    .order = 2,
    .knobs = kKnobs,
    .scene_passes = [](int mirrors, int lights, const Settings& settings) {
        return mirrors + shadow_passes(lights, settings) + 1;
    },
    .add = [](graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
        return add_with_feedback(graph, inputs, settings, "reflect/naive.frag");
    }};
const Row kRow{kReuse};

} // namespace

} // namespace catoptric::reflect
