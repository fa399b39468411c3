// Which other mirror a ray meets first. Few are asked one by one. More are found by a tree over their bounds, which is
// walked without a stack, and with the same answer: boxes are wider than whatever the tests let through.
#ifndef CATOPTRIC_NEXT_MIRROR_GLSL
#define CATOPTRIC_NEXT_MIRROR_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: there is a tree (engine/render/mirror_tree.hpp).
layout(constant_id = MIRROR_TREE_CONSTANT) const uint mirror_tree = 0u;
// Two a node: lowest corner, mirror from 1 or 0; highest corner, number of the node after all that is below it.
TEXEL_LIST(MIRROR_NODES_BINDING, mirror_nodes, vec4, samplerBuffer, false)

// An accepted sphere may lie 22 roundings of the largest coordinate aside of a ray, and its first point by the root of
// what that is before it is entered; box_ray's slack is 16 of them, and three times that is more than both.
const float kSphereSlack = 3.0;

// Where the ray meets a mirror that is an exact sphere, or the bounds of any other.
bool meets_mirror(uint mirror, Ray ray, out float t) {
    Probe probe = probe_at(mirror);
    return probe.radius > 0.0
               ? sphere_test(probe.sphere, probe.radius, ray, kLargest, t)
               : slab_test(probe.lowest, probe.highest, box_ray(ray, probe.lowest, probe.highest, 1.0), kLargest, t);
}

// The first mirror on the ray, but for `except`; of equally near ones that with the lowest number. `only_spheres`: those
// that are no exact sphere are passed by.
bool first_by_tree(Ray ray, uint except, bool only_spheres, out uint first, out float t) {
    vec4 low = mirror_nodes_at(0u), high = mirror_nodes_at(1u);
    BoxRay boxes = box_ray(ray, low.xyz, high.xyz, kSphereSlack);
    uint end = floatBitsToUint(high.w) & kBvhIdMask;
    bool found = false;
    t = kLargest;
    uint node = 0u;
    do { // loops ask at their end: see lib/trace.glsl
        low = mirror_nodes_at(2u * node);
        high = mirror_nodes_at(2u * node + 1u);
        float enters, met;
        bool inside = slab_test(low.xyz, high.xyz, boxes, t, enters);
        node = inside ? node + 1u : floatBitsToUint(high.w) & kBvhIdMask;
        uint number = floatBitsToUint(low.w) & kBvhIdMask; // from 1
        uint mirror = number - 1u;
        if (!inside || number == 0u || mirror == except || (only_spheres && !(probe_at(mirror).radius > 0.0))) continue;
        if (!meets_mirror(mirror, ray, met)) continue;
        if (met < t || (found && met == t && mirror < first)) {
            t = met;
            first = mirror;
            found = true;
        }
    } while (node < end);
    return found;
}

// The first exact sphere on the ray, but for `except`.
bool first_sphere(Ray ray, uint except, out uint first, out float t) {
    if (mirror_tree != 0u) return first_by_tree(ray, except, true, first, t);
    bool found = false;
    t = kLargest;
    uint i = 0u, count = frame.value.mirror_count;
    do {
        Probe probe = probe_at(i);
        float t_sphere;
        if (i != except && probe.radius > 0.0 && sphere_test(probe.sphere, probe.radius, ray, t, t_sphere)) {
            t = t_sphere;
            first = i;
            found = true;
        }
        ++i;
    } while (i < count);
    return found;
}

// Whether the ray meets another mirror than `except`, or its bounds, not after `end`.
bool meets_mirror_before(Ray ray, uint except, float end) {
    uint i = 0u, count = frame.value.mirror_count;
    bool meets = false;
    do {
        float t;
        meets = i != except && meets_mirror(i, ray, t) && !(end < t);
        ++i;
    } while (!meets && i < count);
    return meets;
}

#endif
