// Part three of the report: captures hold the distance too, and the reflected direction is corrected by
// one step. distance=unorm8 stores it as the report did, clamped at `range` in eight bits.
#include "reflect/knobs.hpp"

namespace catoptric::reflect {

namespace {

constexpr const char* kFragment = "reflect/parallax.frag";
constexpr Knob kKnobs[] = {kFace, kDistance, kRange, kShadow, kShadowMapEdge};

constexpr Technique kParallax{
    .name = "parallax",
    .summary = "As reuse, with the reflected direction corrected by one step from the captured distance.",
    .order = 3,
    .knobs = kKnobs,
    .scene_passes = feedback_passes,
    .add = [](graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
        const Captured captured = add_feedback(graph, inputs, settings, kFragment);
        return add_view_of(graph, inputs, captured, view_look(captured, settings, kFragment));
    }};
const Row kRow{kParallax};

} // namespace

} // namespace catoptric::reflect
