// Light that passes a glass body, for mirrors that look it up in their capture (knob `refract`). The capture leaves the body
// out, so it shows what is behind. A ray bends where it enters the body and once more where it leaves. Light that is
// reflected inside the body is left out.
#ifndef CATOPTRIC_REFRACTION_GLSL
#define CATOPTRIC_REFRACTION_GLSL

#include "lib/material.glsl"

layout(constant_id = REFRACT_CONSTANT) const uint refract_model = kRefractNone;

// Returns whether light passes the surface that was evaluated last.
bool is_refracting(uint detail) {
    return refract_model != kRefractNone && is_glass(detail);
}

// A ray of light behind a glass surface.
struct RefractedRay {
    vec3 origin;    // where it leaves the body, scene units
    vec3 direction; // unit direction in which it leaves
    vec3 weight;    // share of its light that reaches the viewer
    float reflected; // share of the light that the drawn surface reflects instead
    float roughness; // of a mirror that spreads light as much as the glass does; 0: the glass is smooth
};

// Returns the roughness of a mirror that spreads light as much as the rough glass that was evaluated last. A facet tilted by
// a small angle turns reflected light by twice this angle, light through one surface by (ior - 1) times it, and light through
// both surfaces of a body, whose tilts are independent, by the root of two as much. Facets of a sheet bend like a mirror's.
float passing_roughness(bool is_solid, float ior) {
    const float kRootOfHalf = 0.70710678;
    return has_lobes == 0u ? 0.0 : is_solid ? specular_lobe.roughness * sqrt(min((ior - 1.0) * kRootOfHalf, 1.0)) : specular_lobe.roughness;
}

// Returns the way along `direction` from `at` to where the ray leaves the box, and the normal there, which points inwards.
float find_way_out_of_box(vec3 at, vec3 direction, vec3 lowest, vec3 highest, out vec3 normal) {
    float way = kLargestFloat;
    normal = -direction;
    for (int axis = 0; axis < 3; ++axis) {
        float end = direction[axis] > 0.0 ? highest[axis] : lowest[axis], t = (end - at[axis]) / direction[axis];
        if (direction[axis] == 0.0 || !(t < way)) continue;
        way = max(t, 0.0);
        normal = vec3(0);
        normal[axis] = direction[axis] > 0.0 ? -1.0 : 1.0;
    }
    return way;
}

// Returns the ray that meets the glass at `at` along the unit vector `seen`, behind the glass. `n` is the surface's unit
// normal; that of a solid body points outwards. `from_viewer`: the distance to the viewer, who may be inside the body.
RefractedRay refract_through_body(uint detail, vec3 at, vec3 seen, vec3 n, float from_viewer, Probe body) {
    MaterialParameters glass = read_material_parameters(detail);
    bool is_auto = refract_model == kRefractAuto || refract_model == kRefractTraced;
    bool is_thin = is_auto ? body.kind == kMirrorThinGlass : refract_model == kRefractThin;
    bool is_box = is_auto ? body.kind == kMirrorGlassBox : refract_model == kRefractBox;
    bool is_solid = (glass.flags & kMaterialSolidFlag) != 0u, is_inside = is_inside_glass(detail, seen, n);
    vec3 normal = dot(seen, n) > 0.0 ? -n : n;
    float ratio = is_inside ? 1.0 / glass.ior : glass.ior, cosine = min(-dot(seen, normal), 1.0), cosine_behind;
    float reflected = fresnel_dielectric(cosine, ratio, cosine_behind);
    RefractedRay ray = RefractedRay(at, seen, (1.0 - reflected) * glass_tint, reflected, passing_roughness(is_solid, glass.ior));
    if (is_inside) ray.weight *= exp(-glass.absorption * from_viewer);
    if (!is_solid || reflected == 1.0) return ray;
    if (is_thin && !is_inside) {
        ray.weight *= ray.weight;
        return ray;
    }
    if (!is_thin) ray.direction = refract_direction(seen, normal, cosine, ratio, cosine_behind);
    if (is_inside) return ray;
    vec3 inside = ray.direction, far_normal, size = body.highest - body.lowest;
    float way;
    if (is_box) {
        way = find_way_out_of_box(at, inside, body.lowest, body.highest, far_normal);
    } else {
        float along = dot(normal, inside);
        way = -along * min(size.x, min(size.y, size.z));
        far_normal = normalize(along * inside - 0.5 * normal);
    }
    ray.origin += way * inside;
    ray.weight *= exp(-glass.absorption * way);
    float far_cosine = min(-dot(inside, far_normal), 1.0);
    reflected = fresnel_dielectric(far_cosine, 1.0 / glass.ior, cosine_behind);
    if (reflected == 1.0) return ray; // totally reflected light would go on inside; it is shown as if it left unbent
    ray.weight *= (1.0 - reflected) * glass_tint;
    ray.direction = refract_direction(inside, far_normal, far_cosine, 1.0 / glass.ior, cosine_behind);
    return ray;
}

#endif
