// Finds the first other mirror that a ray meets. Few mirrors are tested one by one. Many mirrors are found by a
// stackless walk of a tree over their bounds. Both ways give the same answer, because the tree's boxes are widened by
// more than the errors of the mirror tests.
#ifndef CATOPTRIC_NEXT_MIRROR_GLSL
#define CATOPTRIC_NEXT_MIRROR_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: the mirrors have a tree (engine/render/mirror_tree.hpp).
layout(constant_id = MIRROR_TREE_CONSTANT) const uint mirror_tree = 0u;
// Two texels for each node of the tree over mirrors. The first texel is the lowest corner of the box, and the mirror
// number (from 1; 0: inner node). The second texel is the highest corner of the box, and the number of the node that
// follows the node's subtree.
TEXEL_LIST(MIRROR_NODES_BINDING, mirror_nodes, vec4, samplerBuffer, false)

// The factor by which boxes are widened for spheres. The sphere test accepts a sphere that misses the ray by up to 22
// roundings of the largest coordinate. make_box_ray widens boxes by 16 roundings, and 3 times 16 is more than 22.
const float kSphereTestTolerance = 3.0;

// Intersects the ray with a mirror: with its exact sphere, or with the bounds of a mirror of another shape.
bool intersects_mirror(uint mirror, Ray ray, out float t) {
    Probe probe = read_probe(mirror);
    return probe.radius > 0.0
               ? intersect_sphere_robustly(probe.sphere, probe.radius, ray, kLargestFloat, t)
               : intersect_box_slabs(probe.lowest, probe.highest, make_box_ray(ray, probe.lowest, probe.highest, 1.0),
                   kLargestFloat, t);
}

// Finds the first mirror on the ray other than `except`. Of equally near mirrors the lowest number wins. `only_spheres`
// ignores mirrors that are no exact sphere.
bool find_first_mirror_by_tree(Ray ray, uint except, bool only_spheres, out uint first, out float t) {
    vec4 low = mirror_nodes_at(0u), high = mirror_nodes_at(1u);
    BoxTestRay boxes = make_box_ray(ray, low.xyz, high.xyz, kSphereTestTolerance);
    uint end = floatBitsToUint(high.w) & kBvhIdMask;
    bool found = false;
    t = kLargestFloat;
    uint node = 0u;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        low = mirror_nodes_at(2u * node);
        high = mirror_nodes_at(2u * node + 1u);
        float enters, met;
        bool inside = intersect_box_slabs(low.xyz, high.xyz, boxes, t, enters);
        node = inside ? node + 1u : floatBitsToUint(high.w) & kBvhIdMask;
        uint number = floatBitsToUint(low.w) & kBvhIdMask; // mirror number, from 1
        uint mirror = number - 1u;
        if (!inside || number == 0u || mirror == except || (only_spheres && !(read_probe(mirror).radius > 0.0))) continue;
        if (!intersects_mirror(mirror, ray, met)) continue;
        if (met < t || (found && met == t && mirror < first)) {
            t = met;
            first = mirror;
            found = true;
        }
    } while (node < end);
    return found;
}

// Finds the first exact sphere on the ray, other than mirror `except`.
bool find_first_exact_sphere(Ray ray, uint except, out uint first, out float t) {
    if (mirror_tree != 0u) return find_first_mirror_by_tree(ray, except, true, first, t);
    bool found = false;
    t = kLargestFloat;
    uint i = 0u, count = frame.value.mirror_count;
    do {
        Probe probe = read_probe(i);
        float t_sphere;
        if (i != except && probe.radius > 0.0 && intersect_sphere_robustly(probe.sphere, probe.radius, ray, t, t_sphere)) {
            t = t_sphere;
            first = i;
            found = true;
        }
        ++i;
    } while (i < count);
    return found;
}

// Returns whether the ray meets a mirror other than `except`, or that mirror's bounds, at or before `end`.
bool intersects_mirror_before(Ray ray, uint except, float end) {
    uint i = 0u, count = frame.value.mirror_count;
    bool meets = false;
    do {
        float t;
        meets = i != except && intersects_mirror(i, ray, t) && !(end < t);
        ++i;
    } while (!meets && i < count);
    return meets;
}

#endif
