// Technique `proxy`: approximates the surroundings by one box (Lagarde and Zanuttini 2012) or one sphere (Brennan 2002)
// around the capture's centre. The box is exact for an empty room with six walls perpendicular to the axes. A ray that
// starts outside the box or sphere is looked up where it enters.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#define CONTINUE
#include "lib/constants.glsl"
#include "lib/probe.glsl"
#include "reflect/proxy.glsl"

layout(set = 0, binding = 20, scalar) readonly buffer Proxies { ProxyShapes proxies[]; };
const uint kBoxProxy = 0u, kSphereProxy = 1u;
layout(constant_id = OWN_CONSTANTS) const uint shape = kBoxProxy;
// A lookup is a hit if the captured surface is at most this far from the box or sphere, relative to the distance from
// the centre.
const float kProxyTolerance = 0.05;

bool intersects_box(vec3 lo, vec3 hi, vec3 offset, vec3 direction, out float t) {
    float enter = 0.0, leave = kLargestFloat;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (offset[axis] < lo[axis] || offset[axis] > hi[axis]) return false;
            continue;
        }
        float a = (lo[axis] - offset[axis]) / direction[axis];
        float b = (hi[axis] - offset[axis]) / direction[axis];
        enter = max(enter, min(a, b));
        leave = min(leave, max(a, b));
    }
    t = enter > 0.0 ? enter : leave;
    return leave > 0.0 && leave <= kLargestFloat && enter <= leave;
}

// Returns the lookup of a ray that leaves the scene, because it misses the box or sphere, or no surface was captured.
Lookup make_outward_lookup(uint mirror, vec3 direction) {
    bool empty = is_miss(captured_distance(mirror, direction));
    return Lookup(direction, empty ? kMiss : kUnknown, 0.0, empty ? 0.0 : kLeaves);
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    ProxyShapes proxy = proxies[mirror];
    float t = 0.0;
    bool met = proxy.radius > 0.0 &&
               (shape == kBoxProxy ? intersects_box(proxy.lo, proxy.hi, offset, direction, t)
                              : intersect_sphere_robustly(vec3(0), proxy.radius, Ray(offset, direction, 0u), kLargestFloat, t));
    vec3 p = offset + direction * t;
    float size = length(p);
    if (!met || !(size > 0.0 && size <= kLargestFloat)) return make_outward_lookup(mirror, direction);
    float captured = captured_distance(mirror, p / size);
    if (is_miss(captured)) return make_outward_lookup(mirror, direction);
    float residual = min(abs(captured - size) / size, 1.0);
    return Lookup(p / size, residual <= kProxyTolerance ? kHit : kUnknown, residual, 0.0);
}
#include "lib/mirror.glsl"
