#include "render/mirror_tree.hpp"

#include "bvh/words.hpp"
#include "render/nearest.hpp"

namespace catoptric::render {

namespace {

/// Returns bounds that contain everything that the ray test may hit. Roundings make sphere bounds
/// one step wider.
Bounds<float> mirror_bounds(const shared::Probe& probe) {
    if (!(probe.radius > 0)) return {probe.lowest, probe.highest};
    Bounds<float> box{probe.sphere - probe.radius, probe.sphere + probe.radius};
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = f32::next_down(box.lo[axis]);
        box.hi[axis] = f32::next_up(box.hi[axis]);
    }
    return box;
}

} // namespace

std::vector<vec4> build_mirror_tree(std::span<const shared::Probe> probes) {
    std::vector<Bounds<float>> boxes;
    for (const shared::Probe& probe : probes) boxes.push_back(mirror_bounds(probe));
    std::vector<vec4> texels;
    for (const BoxTree::Step& step : BoxTree(boxes, 1).traversal()) {
        texels.emplace_back(step.box.lo, bvh::pack_number(step.only ? *step.only + 1 : 0));
        texels.emplace_back(step.box.hi, bvh::pack_number(step.past));
    }
    return texels;
}

} // namespace catoptric::render
