// Distinguishes a surface that a ray crosses from the silhouette of a surface behind which the ray passes.
#ifndef CATOPTRIC_SILHOUETTE_GLSL
#define CATOPTRIC_SILHOUETTE_GLSL

#include "lib/probe.glsl"

// The slope of captured distances above which a surface may be two surfaces that bilinear interpolation joins. The
// slope is the tangent of the angle between the surface and the plane perpendicular to the lookup's direction.
const float kMaxSurfaceSlope = 4.0;
// The step between neighbouring texels, relative to the distance, below which the slope does not matter. A rounding
// step of unorm8 distances is smaller than this step.
const float kMaxContinuousStep = 1.0 / 128.0;

// Angle of a texel in the middle of a face of the mirror's capture, radians.
float texel_angle_of_mirror_capture(uint mirror) { return 2.0 / float(distance_edge(mirror)); }
// inverse distance; 0: no surface
float reciprocal_or_zero(float distance) { return is_miss(distance) ? 0.0 : 1.0 / distance; }

// Changes of the captured surface between two directions. kSurfaceContinues: the same surface continues. kSurfaceEnds:
// the surface ends and a surface farther away begins, and the ray may meet either. kSurfaceSilhouette: a nearer surface
// begins, and the ray is behind this surface.
const uint kSurfaceContinues = 0u, kSurfaceEnds = 1u, kSurfaceSilhouette = 2u;

// Classifies the captured surface between two close unit directions. In direction `front` the ray is in front of the
// captured surface, in direction `behind` it is behind. The inverse captured distances of both directions are given.
// Takes four more lookups if the surface is steep between the directions.
uint classify_surface_between(uint mirror, vec3 front, vec3 behind, float captured_front, float captured_behind) {
    if (captured_front == 0.0) return kSurfaceSilhouette;
    float rise = captured_behind - captured_front, angle = length(behind - front);
    if (abs(rise) <= max(kMaxSurfaceSlope,
        kMaxContinuousStep / texel_angle_of_mirror_capture(mirror)) * angle * captured_front) return kSurfaceContinues;
    // A plane seen at a grazing angle is as steep on at least one of the two sides. The lookups lie beyond the texels
    // that the given distances interpolate.
    float apart = 1.25 * texel_angle_of_mirror_capture(mirror);
    vec3 move = (behind - front) * (apart / angle);
    // A loop around a single call of captured_distance() keeps the compiled code small. In ablated shaders
    // (lib/ablate.glsl) this call traces a ray, and four separate calls would be inlined four times. In other shaders
    // the compiler unrolls the loop.
    const vec4 away = vec4(-1, -2, 2, 1);
    vec4 beside;
    for (int i = 0; i < 4; ++i)
        beside[i] = reciprocal_or_zero(captured_distance(mirror, normalize((i < 2 ? front : behind) + away[i] * move)));
    float before = beside[0] - beside[1], after = beside[2] - beside[3];
    float slope = rise < 0.0 ? -min(before, after) : max(before, after);
    if (abs(rise) <= 1.5 * slope * angle / apart) return kSurfaceContinues;
    return rise < 0.0 ? kSurfaceEnds : kSurfaceSilhouette;
}

#endif
