// Glass and blended surfaces in rays. At each surface of glass a ray splits into a reflected ray and a ray that passes
// through. The path goes on with the ray that passes, and follows the reflected rays afterwards. At a blended surface
// the path goes on as at an opaque surface, and the ray behind the surface is followed afterwards.
#ifndef CATOPTRIC_GLASS_GLSL
#define CATOPTRIC_GLASS_GLSL

// A ray that is traced after the current path has ended, with the rounding error of the ray's origin, the ray's weight,
// and the number of bounces before the ray.
struct PendingRay {
    Ray ray;
    vec3 low;
    vec3 weight;
    uint bounce;
    uint bodies; // of glass that the ray is in
};
const uint kMaxPendingRays = 8u;
PendingRay pending_rays[kMaxPendingRays];
uint pending_count = 0u;

// The weight below which a ray is not followed. The weight is less than the smallest step of an 8-bit picture.
const float kMinGlassWeight = 1.0 / 512.0;

// Sets `ray` to a ray that leaves the surface point along `direction`.
void leave_point(SurfacePoint p, vec3 direction, out Ray ray) { ray = Ray(find_leaving_ray_origin(p, direction), direction, p.leaves); }

// Returns the index of refraction of each colour (KHR_materials_dispersion: the index of green, and a spread of which 20
// divided by the Abbe number is a measure).
vec3 glass_iors(MaterialParameters glass) {
    float half_spread = 0.025 * (glass.ior - 1.0) * glass.dispersion;
    return clamp(glass.ior + vec3(-half_spread, 0.0, half_spread), vec3(1), vec3(kLargestFloat));
}

bool is_dispersive_glass(uint bodies) { return is_in_ranked_glass(bodies) && read_glass_around(bodies).dispersion > 0.0; }
vec3 iors_in_bodies(uint bodies) { return is_in_ranked_glass(bodies) ? glass_iors(read_glass_around(bodies)) : vec3(1); }

// Returns whether rays leave the glass that was evaluated last in directions drawn from its microfacets.
bool draws_from_glass_facets() { return traces_lobes != 0u && has_rough_lobe(); }

// Returns a visible microfacet's normal, drawn for the path's `bounce`th surface. `normal` points to where the ray comes from.
vec3 draw_glass_facet(vec3 direction, vec3 normal, uint bounce) {
    float u, v;
    sample_pattern_point(path_pixel, path_sample, kGlassDimensions + bounce, path_seed, u, v);
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    vec3 to_eye = -vec3(dot(tangent, direction), dot(bitangent, direction), dot(normal, direction));
    vec3 facet = sample_visible_normal(roughness_to_alpha(specular_lobe.roughness), to_eye, 1.0, u, v);
    return facet.x * tangent + facet.y * bitangent + facet.z * normal;
}

// Returns the direction, mirrored at the plane of the unit normal `side` if it points to the plane's other side.
vec3 turn_to_side(vec3 direction, vec3 side) {
    float height = dot(direction, side);
    return height < 0.0 ? direction - 2.0 * height * side : direction;
}

// Splits the ray, which has met glass at the point, at its `bounce`th surface. Sets the ray and its weight to what passes
// through, or to what is reflected if nothing passes. Other light becomes pending rays: what is reflected, and in dispersive
// glass two of the three colours that pass. The direction is bent at solid bodies alone: those are closed, and their facets
// point outwards. Light that other microfacets block is lost, or with multiple scattering leaves on the same side as
// other light: no light is lost then, but the surface is not reciprocal.
void split_at_glass(SurfacePoint p, uint detail, uint bounce, inout Ray ray, inout vec3 weight) {
    MaterialParameters glass = read_material_parameters(detail);
    vec3 direction = ray.direction;
    bool is_solid = (glass.flags & kMaterialSolidFlag) != 0u, is_inside = is_inside_glass(detail, direction, p.facet);
    bool is_rough = has_lobes != 0u && draws_from_glass_facets();
    bool is_ranked = is_ranked_glass(detail);
    BodiesAtSurface bodies = BodiesAtSurface(0u, 0u);
    if (has_nested_glass != 0u && is_ranked) bodies = find_bodies_at_surface(detail, direction, p.facet);
    else if (is_inside) weight *= exp(-glass.absorption * length(p.position - ray.origin));
    vec3 normal = dot(direction, p.normal) > 0.0 ? -p.normal : p.normal, mean_normal = normal;
    vec3 mirrored = reflect_above_facet(direction, p.normal, p.facet);
    float alpha = 0.0, unblocked = 1.0;
    bool keeps_blocked_light = (glass.flags & kMaterialMultipleScatteringFlag) != 0u;
    vec3 facet_side = facet_normal_on_shading_side(mean_normal, p.facet);
    if (has_lobes != 0u && is_rough) {
        alpha = roughness_to_alpha(specular_lobe.roughness);
        normal = draw_glass_facet(direction, mean_normal, bounce);
        mirrored = reflect(direction, normal);
        if (keeps_blocked_light) {
            mirrored = turn_to_side(mirrored, facet_side);
        } else {
            unblocked = unblocked_reflected_share(alpha, -dot(direction, mean_normal), dot(mirrored, mean_normal));
            if (!(dot(mirrored, facet_side) > 0.0)) unblocked = 0.0;
        }
    }
    float cosine = min(-dot(direction, normal), 1.0);
    bool is_dispersive = is_solid && glass.dispersion > 0.0;
    vec3 iors = is_dispersive ? glass_iors(glass) : vec3(glass.ior), reflected, behind_cosines;
    vec3 ratios = is_inside ? 1.0 / iors : iors;
    if (has_nested_glass != 0u && is_ranked) {
        is_dispersive = is_dispersive_glass(bodies.before) || is_dispersive_glass(bodies.behind);
        ratios = iors_in_bodies(bodies.behind) / iors_in_bodies(bodies.before);
    }
    uint colours = is_dispersive ? 3u : 1u, colour = 0u;
    do {
        float behind, ratio = ratios[colour];
        reflected[colour] = fresnel_dielectric(cosine, ratio, behind);
        behind_cosines[colour] = behind;
    } while (++colour < colours);
    if ((glass.flags & kMaterialOpenSheetFlag) != 0u) reflected.x = sheet_reflectance(reflected.x);
    if (!is_dispersive) reflected = vec3(reflected.x);
    vec3 mirrored_weight = weight * reflected * unblocked;
    vec3 passing_weight = weight * (1.0 - reflected) * glass_tint;
    bool follows_mirrored = largest_vector_component(mirrored_weight) > kMinGlassWeight;
    if (!(largest_vector_component(passing_weight) > kMinGlassWeight)) {
        weight = follows_mirrored ? mirrored_weight : vec3(0);
        leave_point(p, mirrored, ray);
        return;
    }
    vec3 low = vec3(0);
    weight = vec3(0);
    colour = 0u;
    bool is_first = true;
    do {
        vec3 part = is_dispersive ? vec3(colour == 0u, colour == 1u, colour == 2u) * passing_weight : passing_weight;
        if (!(largest_vector_component(part) > kMinGlassWeight)) continue;
        if (!is_first && pending_count == kMaxPendingRays) {
            weight += part; // this colour goes the same way as the first colour
            continue;
        }
        float ratio = ratios[colour];
        vec3 leaving = direction;
        if (is_solid) leaving = refract_direction(direction, normal, cosine, ratio, behind_cosines[colour]);
        else if (has_lobes != 0u && is_rough) leaving = reflect(mirrored, mean_normal);
        if (has_lobes != 0u && is_rough) {
            if (keeps_blocked_light) leaving = turn_to_side(leaving, -facet_side);
            else if (dot(leaving, facet_side) > 0.0) part = vec3(0);
            else part *= unblocked_passing_share(alpha, -dot(leaving, mean_normal));
        }
        trace_low = vec3(0);
        Ray passing;
        leave_point(p, leaving, passing);
        if (is_first) {
            ray = passing;
            low = trace_low;
            weight = part;
        } else {
            pending_rays[pending_count++] = PendingRay(passing, trace_low, part, bounce + 1u, is_ranked ? bodies.behind : path_bodies);
        }
        is_first = false;
    } while (++colour < colours);
    if (follows_mirrored && pending_count < kMaxPendingRays) {
        trace_low = vec3(0);
        Ray other;
        leave_point(p, mirrored, other);
        pending_rays[pending_count++] = PendingRay(other, trace_low, mirrored_weight, bounce + 1u, path_bodies);
    }
    if (has_nested_glass != 0u && is_ranked) path_bodies = bodies.behind;
    trace_low = low;
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
    pending_rays[pending_count++] = PendingRay(behind, trace_low, passing_weight, bounce, path_bodies);
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
    path_bodies = next.bodies;
    ray_density = 0.0;
#ifdef DOUBLES
    set_double_precision_ray(ray, trace_low);
#endif
    done = false;
    return true;
}

#endif
