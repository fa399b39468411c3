// Part three of the report: captures hold the distance too, and the reflected direction is corrected by
// one step. distance=unorm8 stores it as the report did, clamped at `range` in eight bits.
#include "reflect/knobs.hpp"

namespace catoptric::reflect {

namespace {

constexpr Knob kKnobs[] = {kFace, kDistance, kRange, kShadow, kShadowMapEdge};

constexpr Technique kParallax{
    .name = "parallax",
    .summary = "As reuse, with the reflected direction corrected by one step from the captured distance.",
    .order = 3,
    .knobs = kKnobs,
    .scene_passes = [](int mirrors, int lights, const Settings& settings) {
        return mirrors + shadow_passes(lights, settings) + 1;
    },
    .add = [](graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
        return add_with_feedback(graph, inputs, settings, "reflect/parallax.frag");
    }};
const Row kRow{kParallax};

} // namespace

} // namespace catoptric::reflect
