// Ablation: draws a mirror with some causes of error removed, to measure how much each cause contributes to the error.
// For each cause in draw.ablated, the reference's rays replace the approximation that the technique uses. A pixel takes
// up to a dozen rays, and is NaN if its rays took more BVH steps than the driver allows.
// Loops keep the number of calls small, because the driver's compiler inlines every call with the whole BVH walk.
#ifndef CATOPTRIC_ABLATE_GLSL
#define CATOPTRIC_ABLATE_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// The number, from 1, of the mirror that rays pass through, because a mirror's capture does not show the mirror itself.
// 0: rays pass through no mirror.
uint left_out;
bool does_ray_meet_object(uint object) { return left_out == 0u || read_surface(object).mirror != left_out; }
// How shadows are computed: kShadowRay, or the method of the technique.
uint shadow_by;

#define TRACE_PRIVATE_STACK
#define TRACE_SEES(object) does_ray_meet_object(object)
#define SHADOW_BY shadow_by
#include "lib/whitted.glsl"

layout(constant_id = PICTURE_WIDTH_CONSTANT) const uint picture_width = 1u;
layout(constant_id = PICTURE_HEIGHT_CONSTANT) const uint picture_height = 1u;

// A surface hides a point from the capture's centre if the surface is nearer by more than this share of the distance.
const float kOccluderTolerance = 1.0 / 16384.0;

bool is_cause_ablated(uint cause) { return (draw.ablated & cause) != 0u; }

uint lobe_draws = 0u; // directions that are drawn from the lobe of the pixel's surface; 0: it reflects one direction
vec3 lobe_direction, lobe_weight; // the direction that was drawn last, and its share of the reflection

// Returns the exact distance from the centre of capture `mirror` (from 0) to the first surface in a direction of any
// length. Returns +infinity if the ray meets no surface.
float trace_exact_distance(uint mirror, vec3 direction) {
    left_out = mirror + 1u;
    TraceHit hit;
    bool found = find_closest_hit(Ray(read_probe(mirror).centre, direction, 0u), kLargestFloat, kBvhOneSided, hit);
    left_out = 0u;
    return found ? hit.t * length(direction) : uintBitsToFloat(0x7f800000u);
}

// The end of a ray.
struct RayEndPoint {
    bool meets; // whether the ray meets a surface; false: it leaves the scene
    SurfacePoint point;
    uint mirror; // number of the mirror that the ray meets, from 1; 0: the ray meets no mirror
};

RayEndPoint find_ray_end(Ray ray, uint skipped) {
    RayEndPoint end;
    TraceHit none;
    end.meets = trace_ray(ray, skipped, kUnknownHit, none, end.point);
    end.mirror = end.meets ? read_surface(end.point.object).mirror : 0u;
    return end;
}

// Returns whether the ray ends on a blended surface, behind which light goes on. No cause is removed from such pixels.
bool ends_on_blended_surface(RayEndPoint end) {
    if (has_blending == 0u || details == 0u || !end.meets) return false;
    uint detail = read_surface(end.point.object).detail;
    return is_blended(detail) && surface_alpha(detail, end.point.at) < kOpaqueAlpha;
}

Ray reflect_ray_at_surface_point(Ray ray, SurfacePoint at) {
    vec3 direction = reflect_above_facet(ray.direction, at.normal, at.facet);
    if (lobe_draws > 0u) direction = lobe_direction;
    return Ray(find_leaving_ray_origin(at, direction), direction, at.leaves);
}

// Returns the surface point that capture `mirror` (from 0) shows in the looked-up direction. In the second layer, this
// is the next surface behind the first that faces the capture's centre.
RayEndPoint find_captured_ray_end(uint mirror, Lookup lookup) {
    left_out = mirror + 1u;
    Ray ray = Ray(read_probe(mirror).centre, lookup.direction, 0u);
    RayEndPoint end;
    bool goes_on, is_first = true;
    do {
        end = find_ray_end(ray, 0u);
        goes_on = end.meets && (is_first ? lookup.layer != 0.0 : dot(end.point.facet, ray.direction) >= 0.0);
        is_first = false;
        if (goes_on)
            ray = Ray(ray_spawn_origin(end.point.position, end.point.error, end.point.facet, ray.direction), ray.direction, end.point.leaves);
    } while (goes_on);
    left_out = 0u;
    return end;
}

// Returns the diffuse and emitted radiance of a point, seen along `direction`. `by`: how shadows are computed (see
// shadow_by).
vec3 shade_surface_point(SurfacePoint at, vec3 direction, uint by) {
    shadow_by = by;
    Surface surface = evaluate_surface(at, direction);
    if (has_clear_coats != 0u) cover_with_clear_coat(surface);
    point = at; // visible_share_of_light starts shadow rays at the global `point`
    return shade_surface(surface, at.position, at.normal, find_facet_normal_for_shading(surface.detail, at.facet), -direction,
                         surface.reflectance != vec3(0));
}

// Returns the colour that the search looked up. If the ablation asks for them, exact colour or traced shadows replace
// the captured texels or shadow map lookups.
vec3 find_ablated_lookup_colour(MirrorPath path, Lookup lookup, RayEndPoint target, bool is_target) {
    vec3 colour = lookup_colour(path.mirror, lookup);
    bool sees_nothing = lookup.state == kUnknown && lookup.layer == kLeaves;
    if (sees_nothing || !(is_cause_ablated(kAblateTexelColour) || is_cause_ablated(kAblateShadows))) return colour;
    RayEndPoint captured = target;
    if (!is_target) captured = find_captured_ray_end(path.mirror, lookup);
    if (captured.mirror != 0u) return colour; // a captured mirror keeps the colour from the capture
    if (ends_on_blended_surface(captured)) return colour;
    if (!captured.meets) return is_cause_ablated(kAblateTexelColour) ? environment_radiance(lookup.direction) : colour;
    if (is_cause_ablated(kAblateTexelColour)) colour = vec3(0);
    // The captured texels were lit through the shadow map. Adds the difference that shadow rays would have made.
    for (uint i = 0u; i < (is_cause_ablated(kAblateTexelColour) ? 1u : 2u); ++i) {
        vec3 lit = shade_surface_point(captured.point, lookup.direction, i == 0u && is_cause_ablated(kAblateShadows) ? kShadowRay : shadow);
        colour += i == 0u ? lit : -lit;
    }
    return colour;
}

vec3 find_ablated_radiance(MirrorPath path, Lookup lookup) {
    left_out = 0u;
    shadow_by = is_cause_ablated(kAblateShadows) ? kShadowRay : shadow;
    Ray camera = make_camera_ray(gl_FragCoord.xy, uvec2(picture_width, picture_height));
    Ray search_ray = camera, first_ray;
    RayEndPoint first, target;
    bool from_camera;
    // Traces a ray from the eye, then its reflection in the drawn mirror. If the search followed the path to another
    // mirror, a third ray leaves that mirror.
    uint i = 0u, last = path.hops > 0u ? 2u : 1u;
    do {
        left_out = i == 2u ? path.mirror + 1u : 0u;
        target = find_ray_end(search_ray, i == 0u ? kBvhHiddenFromCamera : 0u);
        if (ends_on_blended_surface(target)) return path.weight * lookup_colour(path.mirror, lookup);
        if (i == 0u) {
            // The rasteriser and the ray see different mirrors at this pixel, an error that no ablation removes.
            if (target.mirror != drawn_mirror_number()) return path.weight * lookup_colour(path.mirror, lookup);
            first = target;
            search_ray = first_ray = reflect_ray_at_surface_point(camera, first.point);
        } else if (i == 1u) {
            bool is_own = target.mirror == drawn_mirror_number();
            bool is_mirrored = !is_own && (target.mirror != 0u || path.hops > 0u);
            from_camera = is_own ? is_cause_ablated(kAblateSelfReflection) : is_mirrored && is_cause_ablated(kAblateMirrorReflections);
            if (path.hops > 0u) search_ray = Ray(path.at, path.direction, 0u);
        }
    } while (++i <= last);
    left_out = 0u;
    vec3 to_target = target.meets ? target.point.position - path.centre : search_ray.direction;
    float distance = target.meets ? length(to_target) : uintBitsToFloat(0x7f800000u);
    bool in_capture = target.mirror != path.mirror + 1u;
    bool asks_hidden = in_capture && (is_cause_ablated(kAblateHiddenPoints) || is_cause_ablated(kAblateDirection));
    bool is_hidden = asks_hidden && trace_exact_distance(path.mirror, to_target) < distance * (1.0 - kOccluderTolerance);
    bool along_search = is_hidden && is_cause_ablated(kAblateHiddenPoints);
    vec3 result = details != 0u ? shade_surface_point(first.point, camera.direction, is_cause_ablated(kAblateShadows) ? kShadowRay : shadow) : vec3(0);
    // No looked-up direction shows a point that is hidden from the capture's centre or left out of the capture.
    bool is_shown = in_capture && !is_hidden;
    if (from_camera || along_search) {
        bool whole = from_camera || path.hops == 0u;
        uint met, before = whole ? 0u : 1u + path.hops;
        if (!whole) {
            camera = search_ray;
        } else if (lobe_draws > 0u) {
            whole = false;
            camera = first_ray, path.weight = lobe_weight, before = 1u;
        }
        result = (whole ? vec3(0) : result) + (whole ? vec3(1) : path.weight) * trace_radiance(camera, before, met);
    } else {
        if (is_cause_ablated(kAblateDirection) && is_shown) {
            lookup = Lookup(normalize(to_target), kHit, 0.0, 0.0);
            set_distance_of_last_search_hit(target.meets ? distance : 0.0);
        }
        result += path.weight * find_ablated_lookup_colour(path, lookup, target, is_cause_ablated(kAblateDirection) && is_shown);
    }
    return trace_exhausted ? vec3(uintBitsToFloat(0x7fc00000u)) : result;
}

#endif
