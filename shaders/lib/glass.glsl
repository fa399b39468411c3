// Smooth glass and blended surfaces in rays. At each surface of glass a ray splits into a reflected ray and one that passes
// through. The path goes on with the one that passes, and follows the reflected ones afterwards. At a blended surface the
// path goes on as at an opaque one, and the ray behind the surface is followed afterwards.
#ifndef CATOPTRIC_GLASS_GLSL
#define CATOPTRIC_GLASS_GLSL

// A ray that is traced after the path, with the rounding error of its origin, its weight, and the path's bounces so far.
struct PendingRay {
    Ray ray;
    vec3 low;
    vec3 weight;
    uint bounce;
};
const uint kMaxPendingRays = 8u;
PendingRay pending_rays[kMaxPendingRays];
uint pending_count = 0u;

// Rays below this weight are not followed. It is less than the smallest step of an 8-bit picture.
const float kMinGlassWeight = 1.0 / 512.0;

// Returns whether rays pass through the surface that was evaluated last.
bool is_glass(uint detail) {
    return has_glass != 0u && details != 0u && (read_material_parameters(detail).flags & kMaterialGlassFlag) != 0u;
}

// Sets the ray to one that leaves the point.
void leave_point(SurfacePoint p, vec3 direction, out Ray ray) { ray = Ray(find_leaving_ray_origin(p, direction), direction, p.leaves); }

// Splits the ray, which has met glass at the point, at its `bounce`th surface. Sets the ray and its weight to what passes
// through, or to what is reflected if nothing passes. Other reflected light becomes a pending ray. The direction is bent at
// solid bodies alone: those are closed, and their facets point outwards.
void split_at_glass(SurfacePoint p, uint detail, uint bounce, inout Ray ray, inout vec3 weight) {
    MaterialParameters glass = read_material_parameters(detail);
    vec3 direction = ray.direction;
    bool is_solid = (glass.flags & kMaterialSolidFlag) != 0u, is_inside = is_solid && dot(direction, p.facet) > 0.0;
    if (is_inside) weight *= exp(-glass.absorption * length(p.position - ray.origin));
    vec3 normal = dot(direction, p.normal) > 0.0 ? -p.normal : p.normal;
    float cosine = min(-dot(direction, normal), 1.0), ratio = is_inside ? 1.0 / glass.ior : glass.ior, cosine_behind;
    float reflected = fresnel_dielectric(cosine, ratio, cosine_behind);
    vec3 mirrored = reflect_above_facet(direction, p.normal, p.facet), mirrored_weight = weight * reflected;
    vec3 passing_weight = weight * (1.0 - reflected) * glass_tint;
    bool follows_mirrored = largest_vector_component(mirrored_weight) > kMinGlassWeight;
    if (!(largest_vector_component(passing_weight) > kMinGlassWeight)) {
        weight = follows_mirrored ? mirrored_weight : vec3(0);
        leave_point(p, mirrored, ray);
        return;
    }
    if (follows_mirrored && pending_count < kMaxPendingRays) {
        Ray other;
        leave_point(p, mirrored, other);
        pending_rays[pending_count++] = PendingRay(other, trace_low, mirrored_weight, bounce + 1u);
    }
    trace_low = vec3(0);
    weight = passing_weight;
    leave_point(p, is_solid ? refract_direction(direction, normal, cosine, ratio, cosine_behind) : direction, ray);
}

// Splits the ray, which has met a blended surface at the point, at its `bounce`th surface. The share `alpha` of the weight
// stays with the path, and the rest becomes a pending ray straight on. Rays below kMinGlassWeight are left out.
void split_at_blended_surface(SurfacePoint p, uint detail, uint bounce, Ray ray, inout vec3 weight) {
    float alpha = surface_alpha(detail, p.at);
    vec3 passing_weight = weight * (1.0 - alpha);
    weight *= alpha;
    if (!(largest_vector_component(passing_weight) > kMinGlassWeight) || pending_count == kMaxPendingRays) return;
    Ray behind;
    leave_point(p, ray.direction, behind);
    pending_rays[pending_count++] = PendingRay(behind, trace_low, passing_weight, bounce);
    trace_low = vec3(0);
}

// Goes on with a pending ray after the path has ended. Returns false if there is none. No ray to a lamp accompanies the
// pending ray, so its density is 0 (counted_share_of_met_emission in lib/whitted.glsl).
bool resume_pending_ray(inout Ray ray, inout vec3 weight, inout uint bounce, inout float ray_density, inout bool done) {
    if ((has_glass == 0u && has_blending == 0u) || pending_count == 0u) return false;
    PendingRay next = pending_rays[--pending_count];
    ray = next.ray;
    trace_low = next.low;
    weight = next.weight;
    bounce = next.bounce;
    ray_density = 0.0;
#ifdef DOUBLES
    set_double_precision_ray(ray, trace_low);
#endif
    done = false;
    return true;
}

#endif
