// Whitted ray tracing of one pixel with camera rays, mirror rays and shadow rays. The reference uses this code for all
// pixels, and hybrid techniques use it for pixels whose search ends unknown.
// Variants: DOUBLES computes hit points in double precision. NAIVE is the simple implementation of lib/trace.glsl.
#ifndef CATOPTRIC_WHITTED_GLSL
#define CATOPTRIC_WHITTED_GLSL

#include "lib/constants.glsl"
#include "lib/environment.glsl"
#include "lib/eye.glsl"
#include "lib/first_hit.glsl"
#include "lib/lamps.glsl"
#include "lib/lights.glsl"
#include "lib/material.glsl"

// The list of triangle corners, one texel each: the normal, and the index of the corner's VertexAttribute as a word of
// engine/bvh/words.hpp.
#ifdef NAIVE
TEXEL_LIST(NORMALS_BINDING, normals, vec4, samplerBuffer, true)
#else
TEXEL_LIST(NORMALS_BINDING, normals, vec4, samplerBuffer, false)
#endif
#define NORMAL(i) normals_at(i).xyz

VertexAttribute read_attribute_of_corner(uint corner) { return read_vertex_attribute(floatBitsToUint(normals_at(corner).w) & kBvhIdMask); }

const TriangleTextureSides kNoSides = TriangleTextureSides(vec3(0), vec3(0), vec4(0), vec4(0));

// Returns the attribute at a point of the triangle whose corners are stored from index `corner` on.
VertexAttribute interpolate_attribute(uint corner, vec3 barycentric) {
    VertexAttribute a = read_attribute_of_corner(corner), b = read_attribute_of_corner(corner + 1u), c = read_attribute_of_corner(corner + 2u);
    return VertexAttribute(barycentric.x * a.uv + barycentric.y * b.uv + barycentric.z * c.uv,
                     barycentric.x * a.colour + barycentric.y * b.colour + barycentric.z * c.colour);
}
bool has_vertex_attributes(uint detail) { return (read_material_parameters(detail).flags & kMaterialHasAttributesFlag) != 0u; }
// Returns whether a ray meets the surface there. Of blended surfaces, only shadow rays ask for half of the alpha.
bool passes_alpha_test(uint triangle, uint object, vec3 barycentric, bool is_shadow_ray) {
    uint detail = read_surface(object).detail;
    VertexAttribute at = kNoAttribute;
    if (has_vertex_attributes(detail)) at = interpolate_attribute(3u * triangle, barycentric);
    if (has_blending != 0u && !is_shadow_ray && is_blended(detail)) return surface_alpha(detail, at) > 0.0;
    return !fails_alpha_test(detail, at);
}
#define TRACE_IS_THERE(triangle, object, barycentric, is_shadow_ray) passes_alpha_test(triangle, object, barycentric, is_shadow_ray)
layout(constant_id = EXACT_SPHERES_CONSTANT) const uint exact_spheres = 0u;
#define TRACE_BALLS (exact_spheres != 0u)

#define TRACE_TINTS_SHADOWS
#include "lib/glass_shadow.glsl"
#include "lib/trace.glsl"
#include "lib/shadow.glsl"
#ifdef DOUBLES
#include "lib/double_hit.glsl"
#endif

layout(constant_id = MAX_DEPTH_CONSTANT) const uint max_depth = 8u;
layout(constant_id = SHADOW_CONSTANT) const uint shadow = 2u; // shadow method: kShadowNone, kShadowMap or kShadowRay
#ifndef SHADOW_BY // the including shader may define SHADOW_BY as a variable
#define SHADOW_BY shadow
#endif

// 1: the rasteriser has found the surfaces that the camera rays meet, and there may be a shadow map. Shadow rays are
// then traced only where the shadow map cannot tell.
layout(constant_id = FIRST_RASTER_CONSTANT) const uint first_raster = 0u;

// 1: rays leave rough surfaces in a direction drawn from the surface's lobe. 0: rough mirrors reflect sharply. Path
// tracing (traces_paths 1) also sets this constant to 1.
layout(constant_id = TRACES_LOBES_CONSTANT) const uint traces_lobes = 0u;
// The arguments of sample_pattern_point for the traced path.
uint path_pixel = 0u, path_sample = 0u, path_seed = 0u;

// Above 0: the environment lights diffuse surfaces with shadows, from this many directions at the first two surfaces of a
// path, and from one direction at each later surface.
layout(constant_id = ENVIRONMENT_SHADOWS_CONSTANT) const uint environment_shadows = 0u;
uint path_bounce = 0u; // reflections before the surface that is shaded

uint camera_rays = 0u; // camera rays that walked through the BVH
uint mirror_rays = 0u;
uint shadow_rays = 0u;

// A point on a surface, with a bound of its position's error (see triangle_hit_point).
struct SurfacePoint {
    vec3 position;
    vec3 error;
    vec3 normal; // interpolated shading normal, unit
    vec3 facet;  // geometric normal of the triangle, unit
    float lift;  // height above the triangle of the smooth surface that the corners' normals describe
    uint object;
    uint leaves; // Ray::leaves of rays that start at this point
    uint inside; // record of the instance in whose object space the triangle lies; 0: the triangle is in scene units
    VertexAttribute at;
    TriangleTextureSides sides; // scene units; zero on a sphere, and if no material has a texture of normals
    vec3 arm;       // vector from the instance's centre to the point, scene units
    vec3 arm_error; // bound of the error of `arm`
};
SurfacePoint point; // the point that is shaded

// Returns the flags of triangles that rays ignore. If spheres are exact, rays ignore meshes that approximate a sphere.
// A sphere in the scene's tree, or the walk's own test of an instance's sphere, takes the place of such a mesh.
uint skipped_triangle_flags() { return exact_spheres != 0u ? kBvhStandsForSphere : 0u; }

// Transforms a point from an instance's object space to scene units.
void transform_point_to_scene(inout SurfacePoint p, uint record) {
    ObjectPlacement place = read_placement(record);
    p.inside = record;
    p.arm = rotate_to_scene_offset(place, p.position);
    p.arm_error = offset_rounding_error(place, p.position, p.error);
    p.normal = transform_normal_out_of_object_space(place, p.normal);
    vec3 low;
    p.position = add_offset_to_object_centre(place, p.arm, low);
    p.error = p.arm_error + rounding_error_gamma_bound(2) * abs(p.position);
}

SurfacePoint point_on_triangle(TraceHit hit) {
    vec3 a, b, c;
    read_triangle_corners(hit.place, a, b, c);
    vec3 w = hit.barycentric;
    SurfacePoint p;
    p.position = triangle_hit_point(a, b, c, w, p.error);
    p.facet = facet_normal(a, b, c);
    uint corner = 3u * hit.triangle;
    if (object_spaces != 0u && hit.inside != 0u) corner -= 3u * triangle_number_offset(hit.inside);
    p.at = kNoAttribute;
    if (details != 0u && has_vertex_attributes(read_surface(hit.object).detail)) p.at = interpolate_attribute(corner, w);
    p.inside = 0u;
    p.arm = p.arm_error = vec3(0);
    vec3 normal_a = NORMAL(corner), normal_b = NORMAL(corner + 1u), normal_c = NORMAL(corner + 2u);
    p.normal = normalize(w.x * normal_a + w.y * normal_b + w.z * normal_c);
    vec3 lit_a = a, lit_b = b, lit_c = c; // corners in scene units
    if (object_spaces != 0u && hit.inside != 0u) {
        ObjectPlacement place = read_placement(hit.inside);
        lit_a = rotate_to_scene_offset(place, a), lit_b = rotate_to_scene_offset(place, b), lit_c = rotate_to_scene_offset(place, c);
        normal_a = transform_normal_out_of_object_space(place, normal_a), normal_b = transform_normal_out_of_object_space(place, normal_b), normal_c = transform_normal_out_of_object_space(place, normal_c);
        p.facet = facet_normal(lit_a, lit_b, lit_c);
        transform_point_to_scene(p, hit.inside);
    }
    p.sides = kNoSides;
    if (has_normal_textures != 0u && has_vertex_attributes(read_surface(hit.object).detail)) {
        vec4 uv = read_attribute_of_corner(corner).uv;
        p.sides = TriangleTextureSides(lit_b - lit_a, lit_c - lit_a, read_attribute_of_corner(corner + 1u).uv - uv, read_attribute_of_corner(corner + 2u).uv - uv);
    }
    p.lift = smooth_surface_offset(lit_a, lit_b, lit_c, normal_a, normal_b, normal_c, w);
#ifdef DOUBLES
    dvec3 exact_a = dvec3(a), exact_b = dvec3(b), exact_c = dvec3(c);
    if (object_spaces != 0u && hit.inside != 0u) {
        ObjectPlacement place = read_placement(hit.inside);
        exact_a = transform_exact_position_to_scene(place, a), exact_b = transform_exact_position_to_scene(place, b), exact_c = transform_exact_position_to_scene(place, c);
    }
    dvec3 exact_w = refine_exact_triangle_hit(exact_a, exact_b, exact_c, w);
    exact_normal = exact_w.x * dvec3(NORMAL(corner)) + exact_w.y * dvec3(NORMAL(corner + 1u)) +
                   exact_w.z * dvec3(NORMAL(corner + 2u));
    if (object_spaces != 0u && hit.inside != 0u) exact_normal = transform_exact_normal_to_scene(read_placement(hit.inside), exact_normal);
    exact_normal = normalize(exact_normal);
    p.position = vec3(exact_point);
    p.normal = vec3(exact_normal);
#endif
    p.object = hit.object;
    p.leaves = is_precision_rule_kept(kOriginErrorBoundRule) ? hit.triangle + 1u : 0u;
    return p;
}

SurfacePoint point_on_sphere(Ray ray, float t, uint object) {
    SurfacePoint p;
    Surface of = read_surface(object);
    p.position = sphere_hit_point(of.centre, of.radius, ray, t, p.error);
#ifdef DOUBLES
    refine_exact_sphere_hit(dvec3(of.centre), double(of.radius), t);
    p.position = vec3(exact_point);
#endif
    p.normal = p.facet = (p.position - of.centre) / of.radius;
    p.lift = 0.0;
    p.at = kNoAttribute;
    p.sides = kNoSides;
    p.object = object;
    p.leaves = 0u;
    p.inside = 0u;
    p.arm = p.arm_error = vec3(0);
    return p;
}

// Returns the point of a hit on the exact sphere of an instance. `low` is the rounding error of the ray's origin.
SurfacePoint point_on_instance_sphere(Ray ray, vec3 low, TraceHit hit) {
    SurfacePoint p;
    ObjectPlacement place = read_placement(hit.inside);
    float radius = object_space_sphere_radius(hit.inside);
    p.position = sphere_hit_point(vec3(0), radius, transform_ray_to_object_space(place, ray, low), hit.t, p.error);
    p.normal = p.position / radius;
    p.lift = 0.0;
    p.at = kNoAttribute;
    p.sides = kNoSides;
    p.object = hit.object;
    p.leaves = 0u;
    transform_point_to_scene(p, hit.inside);
    p.facet = p.normal;
#ifdef DOUBLES
    refine_exact_sphere_hit(transform_exact_position_to_scene(place, vec3(0)), double(radius) * length(dvec3(place.scene_x)), hit.t);
    p.normal = p.facet = vec3(exact_normal);
    p.position = vec3(exact_point);
#endif
    return p;
}

vec4 first_words = vec4(0); // texel of the picture of triangles (lib/first_hit.glsl) for the camera ray

// Two words for each object, and one word for each triangle. The words of an object are the record of its instance (0:
// its triangles are in scene units), and the index of its first triangle in this list. The word of a triangle is its
// stored index. kNoFirstHit: the tree does not hold the object or the triangle.
TEXEL_LIST(FIRST_HITS_BINDING, first_hits, uint, usamplerBuffer, false)
const uint kNoFirstHit = 0xffffffffu;

// What is known of a ray's hit before the ray is traced: nothing (kUnknownHit), or the hit (kKnownHit).
const uint kUnknownHit = 0u, kKnownHit = 1u;

// Intersects the camera ray with the triangle that the rasteriser drew in the ray's pixel. Returns kUnknownHit if no
// triangle is named, or if the ray misses the triangle. The latter happens at edges, where the rasteriser rounds corners
// to parts of a pixel.
uint intersect_rasterised_triangle(Ray ray, out TraceHit hit) {
    hit = TraceHit(kLargestFloat, vec3(0), 0u, 0u, 0u, 0u);
    if (!is_first_hit(first_words)) return kUnknownHit;
    uint object = read_first_hit_object(first_words);
    uint record = first_hits_at(2u * object);
    uint place = first_hits_at(first_hits_at(2u * object + 1u) + read_first_hit_triangle(first_words));
    if (record == kNoFirstHit || place == kNoFirstHit) return kUnknownHit;
    Ray own = ray;
    uint shift = 0u;
    if (object_spaces != 0u && record != 0u) {
        own = transform_ray_to_object_space(read_placement(record), ray, trace_low);
        shift = triangle_number_offset(record);
    }
    vec3 a, b, c, weights;
    read_triangle_corners(place, a, b, c);
    float t;
    TriangleTestRayShear shear = make_ray_shear(own.direction);
    bool meets = is_precision_rule_kept(kWatertightRule) ? intersect_triangle_watertight(a, b, c, own.origin, shear, t, weights)
                                    : plain_triangle_test(a, b, c, own, t, weights);
    uint triangle = (floatBitsToUint(bvh_triangles_at(3u * place + 1u).w) & kBvhIdMask) + shift;
    hit = TraceHit(t, normalise_barycentric(weights), triangle, object, place, record);
    return meets ? kKnownHit : kUnknownHit;
}

// Finds the surface that the ray meets. `known` and `hit` are the result of intersect_rasterised_triangle, or kUnknownHit and any hit.
// Sets `hit` to the ray's hit.
bool trace_ray(Ray ray, uint skipped, uint known, inout TraceHit hit, out SurfacePoint p) {
    vec3 low = trace_low;
    bool found = known == kKnownHit;
    if (known == kUnknownHit) found = find_closest_hit(ray, kLargestFloat, skipped | kBvhOneSided | skipped_triangle_flags(), hit);
    trace_low = vec3(0);
    if (found && object_spaces != 0u && hit.place == kHitOnExactSphere) p = point_on_instance_sphere(ray, low, hit);
    else if (found && exact_spheres != 0u && read_surface(hit.object).radius > 0.0) p = point_on_sphere(ray, hit.t, hit.object);
    else if (found) p = point_on_triangle(hit);
    return found;
}

// Evaluates the material at a point. Bends the normal by the material's texture of normals. The normal of a two-sided
// material turns to the side from which `direction` comes.
Surface evaluate_surface(inout SurfacePoint p, vec3 direction) {
    Surface surface = read_surface(p.object);
    if (details != 0u) {
        vec3 turned = turn_shading_normal_to_viewer(surface.detail, p.normal, p.facet, direction);
        // Seen from the back, the smooth surface is hollow, so it lies below the triangle.
        bool is_front = turned == p.normal;
        if (!is_front) p.lift = 0.0;
        if (has_normal_textures != 0u) {
            vec3 bent = apply_normal_texture(surface.detail, p.at, p.normal, p.sides);
#ifdef DOUBLES
            if (bent != p.normal) exact_normal = dvec3(is_front ? bent : -bent);
#endif
            turned = is_front ? bent : -bent;
        }
        p.normal = turned;
    }
    if (traces_paths != 0u && dot(p.normal, p.facet) * dot(direction, p.facet) > 0.0) {
        p.normal = -p.normal; // light arrives on the side from which the path comes
        p.lift = 0.0;
    }
    if (details != 0u) evaluate_material(surface, p.at, -dot(p.normal, direction));
    return surface;
}

// Returns the origin of a ray that leaves the point along `direction`. Sets trace_low if the point is on an instance.
vec3 find_leaving_ray_origin(SurfacePoint p, vec3 direction) {
    if (object_spaces != 0u && p.inside != 0u)
        return add_offset_to_object_centre(read_placement(p.inside), ray_spawn_origin(p.arm, p.arm_error, p.facet, direction), trace_low);
    return is_precision_rule_kept(kOriginErrorBoundRule) ? ray_spawn_origin(p.position, p.error, p.facet, direction)
        : plain_ray_spawn_origin(p.position, p.facet, direction);
}

// Returns the origin of a shadow ray that goes below the facet's plane, although the light is above the shading
// normal's plane. The ray starts on the smooth surface that the vertex normals describe. From the facet itself, the ray
// would hit neighbouring facets, and a smooth body's shadow terminator would show its facets.
vec3 lifted_shadow_ray_origin(SurfacePoint p, vec3 normal) {
    if (object_spaces != 0u && p.inside != 0u)
        return add_offset_to_object_centre(read_placement(p.inside), ray_spawn_origin(p.arm + p.lift * normal, p.arm_error, p.facet, normal), trace_low);
    return ray_spawn_origin(p.position + p.lift * normal, p.error, p.facet, normal);
}

#include "lib/paths.glsl"
#include "lib/nested_glass.glsl"
#include "lib/glass.glsl"

// Returns a number in [0, 1) that chooses a coated surface's layer at the path's `bounce`th surface.
float draw_layer_choice(uint bounce) {
    float choice, unused;
    sample_pattern_point(path_pixel, path_sample, kLayerDimensions + bounce, path_seed, choice, unused);
    return choice;
}

// Returns the origin of a ray that leaves the surface along `direction`. Works for reflected rays and for paths that
// leave diffuse surfaces.
vec3 reflected_ray_origin(SurfacePoint p, vec3 direction) {
    bool goes_below = traces_paths != 0u && is_precision_rule_kept(kOriginErrorBoundRule) && dot(direction, facet_normal_on_shading_side(p.normal, p.facet)) < 0.0;
    return goes_below ? lifted_shadow_ray_origin(p, p.normal) : find_leaving_ray_origin(p, direction);
}

// With samples_lamps, a ray to a point drawn on a lamp is traced before the path goes on: that point, the weight of its
// emission, and the path's next ray with the rounding error of its origin.
bool traces_to_lamp = false;
LampPoint lamp;
vec3 lamp_weight, path_low;
Ray path_ray;
const uint kLampDimensions = 0x10000u; // first dimension of sample_pattern_point for lamps; lobes have those below

// Replaces the path's next ray by one to a point drawn on a lamp, unless the surface reflects no light from there to
// where `direction` comes from. `weight` is the path's weight before the surface. Light that drawn rays meet, too,
// counts by the shares of both densities (multiple importance sampling, balance heuristic: Veach and Guibas,
// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995).
void replace_ray_by_ray_to_lamp(SurfacePoint p, Reflection parts, vec3 direction, uint bounce, vec3 weight, inout Ray ray) {
    float u, v, density;
    sample_pattern_point(path_pixel, path_sample, kLampDimensions + bounce, path_seed, u, v);
    lamp = draw_lamp_point(u, v);
    vec3 to_lamp = lamp.position - p.position;
    vec3 reflected = evaluate_reflection(p, parts, direction, normalize(to_lamp), density);
    float lamp_density = solid_angle_density(lamp_point_density(lamp.object), to_lamp, lamp.normal);
    lamp_weight = weight * reflected / (density + lamp_density);
    traces_to_lamp = largest_vector_component(lamp_weight) > 0.0;
    if (!traces_to_lamp) return;
    path_ray = ray;
    path_low = trace_low;
    vec3 origin = reflected_ray_origin(p, to_lamp);
    ray = Ray(origin, normalize(lamp.position - origin), p.leaves);
    ++shadow_rays;
}

// Goes on with the path after the path's ray to a lamp has been traced.
void resume_path_after_lamp_ray(out Ray ray) {
    ray = path_ray;
    trace_low = path_low;
    traces_to_lamp = false;
}

// Returns whether the ray has met the point drawn on a lamp, and no other surface before.
bool does_ray_meet_lamp_point(SurfacePoint p, vec3 origin) {
    // Part of the distance by which the direction's rounding may move the point: about 800 times the rounding of a float
    // (2^-23), so that lamps seen at a cosine down to about 1/800 count. Positions add their own rounding.
    const float kTolerance = 1e-4;
    vec3 miss = p.position - lamp.position;
    float allowed = kTolerance * length(lamp.position - origin) + length(p.error + rounding_error_gamma_bound(4) * abs(lamp.position));
    return p.object == lamp.object && length(miss) <= allowed;
}

// Returns the share of a surface's emission that counts where a ray meets it: the rest is counted by rays to lamps.
// `ray_density` is the density with which the ray was drawn, 0 for a ray that no lamp ray accompanies.
float counted_share_of_met_emission(SurfacePoint p, vec3 origin, float ray_density) {
    float density = lamp_point_density(p.object);
    if (ray_density == 0.0 || density == 0.0) return 1.0;
    return ray_density / (ray_density + solid_angle_density(density, p.position - origin, p.facet));
}

// The glass that the shadow ray has passed so far: the ray's direction, whose length is that of t = 1 in scene units; the
// optical depth, in which the inside of a body counts from the ray's origin to where the ray leaves the body, less the way to
// where it enters; and the absorption of bodies that the ray has entered more often than left, per scene unit.
vec3 shadow_direction, passed_depth, entered_absorption;

// Adds the absorption up to the surface of a solid body.
void pass_side_of_solid_glass(uint detail, float way, bool leaves) {
    vec3 absorption = leaves ? read_material_parameters(detail).absorption : -read_material_parameters(detail).absorption;
    passed_depth += absorption * way;
    entered_absorption -= absorption;
}

void pass_triangle_of_glass(uint record, Ray ray, uint object, uint triangle, vec3 weights, vec3 facet, float t) {
    Surface surface = read_surface(object);
    uint corner = 3u * triangle;
    VertexAttribute at = kNoAttribute;
    if (has_vertex_attributes(surface.detail)) at = interpolate_attribute(corner, weights);
    if (masks != 0u && fails_alpha_test(surface.detail, at)) return;
    vec3 normal = weights.x * NORMAL(corner) + weights.y * NORMAL(corner + 1u) + weights.z * NORMAL(corner + 2u);
    if (object_spaces != 0u && record != 0u) normal = transform_normal_out_of_object_space(read_placement(record), normal);
    passed_depth += glass_surface_depth(surface.detail, surface.albedo, at, abs(dot(normalize(normal), normalize(shadow_direction))));
    if (is_solid_glass(surface.detail)) pass_side_of_solid_glass(surface.detail, t * length(shadow_direction), dot(facet, ray.direction) > 0.0);
}

void pass_sphere_of_glass(Ray ray, uint object, vec3 centre, float radius, float t_max) {
    vec3 arm = centre - ray.origin;
    float size = length(ray.direction), along = dot(arm, ray.direction) / size;
    float square = radius * radius - dot(arm, arm) + along * along;
    if (!(square > 0.0)) return;
    float half_chord = sqrt(square);
    Surface surface = read_surface(object);
    vec3 depth = glass_surface_depth(surface.detail, surface.albedo, kNoAttribute, half_chord / radius);
    for (int side = -1; side <= 1; side += 2) {
        float t = (along + float(side) * half_chord) / size;
        if (!(t > 0.0 && t < t_max)) continue;
        passed_depth += depth;
        if (is_solid_glass(surface.detail)) pass_side_of_solid_glass(surface.detail, t * length(shadow_direction), side > 0);
    }
}

#include "lib/environment_directions.glsl"

float visible_share_of_light(uint light, vec3 position, vec3 normal, vec3 direction, float distance) {
    bool is_environment = environment_shadows != 0u && light == kEnvironmentLight;
    if (SHADOW_BY == kShadowNone) return 1.0;
    if (has_shadow_map != 0u && SHADOW_BY == kShadowMap && !is_environment)
        return sample_hard_or_soft_shadow_map(light, position, normal, normalize(point.facet), dot(abs(normal), point.error));
    float visible;
    if (has_shadow_map != 0u && first_raster != 0u && !is_environment &&
        find_light_share_by_shadow_map(light, position, normal, dot(abs(normal), point.error), visible))
        return visible;
    ++shadow_rays;
    bool goes_below = is_precision_rule_kept(kOriginErrorBoundRule) && dot(direction, facet_normal_on_shading_side(normal, point.facet)) < 0.0;
    vec3 origin;
    if (goes_below) origin = lifted_shadow_ray_origin(point, normal);
    else origin = find_leaving_ray_origin(point, direction);
    bool is_parallel = is_environment;
    if (!is_environment) is_parallel = is_directional_light(light);
    Ray ray = Ray(origin, direction, point.leaves);
    if (!is_environment) ray.direction = read_light(light).position - origin;
    float t = is_precision_rule_kept(kShadowRayEndRule) ? kShadowRayEnd : 1.0;
    if (is_parallel) {
        ray.direction = direction;
        t = kLargestFloat;
    }
    if (tints_shadows != 0u) {
        shadow_direction = ray.direction;
        passed_depth = entered_absorption = vec3(0);
    }
    bool is_hidden = has_any_hit(ray, t, kBvhCastsNoShadow | skipped_triangle_flags());
    if (tints_shadows != 0u) {
        // If the light is inside a body of glass, its light starts in the glass.
        if (!is_parallel) passed_depth += max(entered_absorption, vec3(0)) * length(shadow_direction);
        light_tint = share_behind_glass(passed_depth);
    }
    return is_hidden ? 0.0 : 1.0;
}
#ifdef LISTED
#define USES_AMBIENT_OCCLUSION
ivec2 occluded_pixel; // the pixel of the camera ray
bool is_surface_of_pixel; // whether the shaded surface is the opaque one that the camera ray meets first
float visible_hemisphere_share_here();
#endif
#include "lib/lighting.glsl"
#ifdef LISTED
float visible_hemisphere_share_here() { return is_surface_of_pixel ? visible_hemisphere_share(occluded_pixel) : 1.0; }
#endif

View camera_view = views[0]; // the view is read before the lanes diverge
// Returns the camera ray through a position, in pixels, of a picture of `size` pixels.
Ray make_camera_ray(vec2 place, uvec2 size) {
    View view = camera_view;
    vec2 ndc = place / vec2(size) * 2.0 - 1.0;
    if (object_spaces != 0u) trace_low = view.eye_low;
    if (orthographic != 0u)
        return Ray(view.eye + (ndc.x * view.right / dot(view.right, view.right) + ndc.y * view.down / dot(view.down, view.down)),
                   view.forward, 0u);
    return Ray(view.eye, normalize(view.forward + ndc.x * view.right / dot(view.right, view.right) +
                                   ndc.y * view.down / dot(view.down, view.down)), 0u);
}

#include "lib/path_start.glsl"

// Returns the radiance along a ray that has met `first` mirrors before. `met` is the number of the first mirror that
// the ray meets, and the number of the second << kBitsPerMirrorHit. If the first surface reflects but is no mirror, the
// first number is 0 and the second kHitSmoothDielectric or kHitRoughNonMirror. A ray with `first` 0 is a camera ray and
// passes through objects hidden from the camera. With first_raster, a camera ray starts at the triangle that `first_words` names.
// With finds_path_start, the radiance is that of the part which the paths share. With resumes_path, it is that of one path
// after this part.
vec3 trace_radiance(Ray ray, uint first, out uint met) {
    vec3 weight = vec3(1);
    vec3 result = vec3(0);
    met = met_before;
    uint skipped = first == 0u ? kBvhHiddenFromCamera : 0u;
#ifdef DOUBLES
    set_double_precision_ray(ray, trace_low);
#endif
    bool done = false;
    uint bounce = first;
    TraceHit hit;
    uint known = kUnknownHit;
    float ray_density = 0.0; // with which the path's ray was drawn; 0: a ray of the camera or of a smooth surface
    bool is_shaded = false; // whether the light of the next surface's shading counts elsewhere
    bool is_on_way = true;  // whether the ray comes to the next surface by a way on which glass absorbs light
    path_bodies = 0u;
    if (resumes_path) {
        resume_path(ray, hit, weight, bounce, is_shaded);
        is_on_way = false; // the stored weight has it
        known = kKnownHit;
    } else if (first_raster != 0u && first == 0u) {
        known = intersect_rasterised_triangle(ray, hit);
    }
    if (known == kUnknownHit && first == 0u) ++camera_rays;
    do {
        // A camera ray that passes a blended surface still counts as a camera ray.
        if (has_blending != 0u && first == 0u && bounce == 0u) skipped = kBvhHiddenFromCamera;
        vec3 low = trace_low;
        bool found = trace_ray(ray, skipped, known, hit, point);
        known = kUnknownHit;
        if (finds_path_start) keep_camera_hit(hit);
        bool is_to_lamp = samples_lamps != 0u && traces_to_lamp;
        if (is_to_lamp && !found) {
            resume_path_after_lamp_ray(ray);
            done = weight == vec3(0);
            continue;
        }
        if (!found) {
            if (environment_kind != kNoEnvironment) result += weight * environment_radiance(ray.direction);
            done = true;
            continue;
        }
        Surface surface = evaluate_surface(point, ray.direction);
        if (has_nested_glass != 0u) {
            uint bodies = path_bodies;
            if (is_ranked_glass(surface.detail)) bodies = find_bodies_at_surface(surface.detail, ray.direction, point.facet).before;
            if (is_on_way) weight *= share_through_bodies(bodies, length(point.position - ray.origin));
            is_on_way = true;
        }
        bool is_coated = has_clear_coats != 0u && clear_coat.strength > 0.0, has_sharp_coat = is_coated && clear_coat.roughness <= kMaxSharpRoughness;
        if (finds_path_start && is_shading_random(surface, is_coated)) {
            keep_path_start(hit, ray, low, weight, bounce, false);
            done = true;
            continue;
        }
        if (has_clear_coats != 0u && is_coated) {
            if (traces_lobes == 0u || is_to_lamp) cover_with_clear_coat(surface);
            else choose_layer_of_clear_coat(draw_layer_choice(bounce), surface);
        }
        if (is_to_lamp) {
            if (does_ray_meet_lamp_point(point, ray.origin)) result += lamp_weight * surface.emission;
            resume_path_after_lamp_ray(ray);
            done = weight == vec3(0);
            continue;
        }
        if (has_nested_glass != 0u && is_ranked_glass(surface.detail)) {
            BodiesAtSurface bodies = find_bodies_at_surface(surface.detail, ray.direction, point.facet);
            if (are_in_same_glass(bodies.before, bodies.behind)) {
                path_bodies = bodies.behind;
                leave_point(point, ray.direction, ray);
#ifdef DOUBLES
                set_double_precision_ray(ray, trace_low);
#endif
                continue;
            }
        }
        if (samples_lamps != 0u) surface.emission *= counted_share_of_met_emission(point, ray.origin, ray_density);
        bool is_see_through = has_blending != 0u && details != 0u && is_blended(surface.detail) && surface_alpha(surface.detail, point.at) < kOpaqueAlpha;
        if (has_blending != 0u && is_see_through && !is_shaded) split_at_blended_surface(point, surface.detail, bounce, ray, weight);
        bool is_recorded = bounce < first + 2u && met < kHitRoughNonMirror << kBitsPerMirrorHit;
        // Of the branches of a path, the first to meet a mirror is recorded. Behind a blended surface the pixel counts as what
        // it would be without that surface.
        if (has_glass != 0u || has_blending != 0u) is_recorded = is_recorded && (met >> (kBitsPerMirrorHit * (bounce - first)) & kMaxMirrors) == 0u;
        if (is_recorded) met |= surface.mirror << (kBitsPerMirrorHit * (bounce - first));
        bool reflects = surface.mirror != 0u;
        if (details != 0u) reflects = surface.reflectance != vec3(0);
        if (details != 0u && bounce == 0u && surface.mirror == 0u && !is_see_through && met == 0u) {
            if (reflects || has_sharp_coat) met = kHitSmoothDielectric << kBitsPerMirrorHit;
            else if (is_coated || has_rough_lobe()) met = kHitRoughNonMirror << kBitsPerMirrorHit;
        }
        if (traces_lobes != 0u) reflects = reflects || has_rough_lobe();
        bool is_passed = has_glass != 0u && is_glass(surface.detail);
        if (has_glass != 0u && is_passed) surface.albedo = vec3(0); // light that is not reflected passes, and none is scattered
        vec3 lit_normal = point.normal;
        bool is_inside = has_glass != 0u && is_passed && is_inside_glass(surface.detail, ray.direction, point.facet);
        // Glass reflects highlights on the side that is seen, but from inside a body it shows no light without a surface.
        if (has_glass != 0u && is_passed && dot(lit_normal, ray.direction) > 0.0) lit_normal = -lit_normal;
#ifdef LISTED
        is_surface_of_pixel = bounce == 0u && !is_see_through;
#endif
        // All surfaces share this one call, because the driver's compiler inlines each call with the whole BVH walk of its
        // shadow ray.
        if (environment_shadows != 0u) path_bounce = bounce - first;
        if (is_shaded) is_shaded = false;
        else if (has_glass != 0u && is_inside) result += weight * surface.emission;
        else if (!reflects || details != 0u) result += weight * shade_surface(surface, point.position, lit_normal, find_facet_normal_for_shading(surface.detail, point.facet), -ray.direction, reflects || is_passed || traces_paths != 0u);
        if (has_glass != 0u && is_passed) {
            done = bounce == max_depth;
            if (finds_path_start && !done && draws_from_glass_facets()) {
                keep_path_start(hit, ray, low, weight, bounce, true);
                done = true;
                continue;
            }
            if (!done) split_at_glass(point, surface.detail, bounce, ray, weight);
#ifdef DOUBLES
            set_double_precision_ray(ray, trace_low);
#endif
            done = done || weight == vec3(0);
            ++bounce;
            ++mirror_rays;
            skipped = 0u;
            ray_density = 0.0;
            continue;
        }
        if (!reflects && (traces_paths == 0u || surface.albedo == vec3(0))) {
            done = true;
        } else if (bounce == max_depth) {
            done = true;
        } else {
            vec3 direction, weight_before = weight, arriving = ray.direction;
            Reflection parts = split_reflection(surface, reflects, -dot(point.normal, arriving));
            if (finds_path_start && is_direction_random(parts, bounce)) {
                keep_path_start(hit, ray, low, weight, bounce, true);
                done = true;
                continue;
            }
            bool is_drawn = sample_reflection_direction(point, parts, arriving, bounce, weight, direction, ray_density);
#ifdef DOUBLES
            if (!is_drawn) direction = reflect_exact_ray();
#endif
            ray = Ray(reflected_ray_origin(point, direction), direction, point.leaves);
#ifdef DOUBLES
            if (is_drawn) set_double_precision_ray(ray, trace_low);
#endif
            skipped = 0u;
            ++mirror_rays;
            if (samples_lamps != 0u && (is_drawn || parts.diffuse != vec3(0)))
                replace_ray_by_ray_to_lamp(point, parts, arriving, bounce, weight_before, ray);
            ++bounce;
            if (traces_lobes != 0u) done = weight == vec3(0) && !traces_to_lamp;
        }
    } while (!done || resume_pending_ray(ray, weight, bounce, ray_density, done));
    // The software driver silently stops this loop, too, after it has stopped a loop of the BVH walk.
    trace_exhausted = trace_exhausted || !done;
    return result;
}

#endif
