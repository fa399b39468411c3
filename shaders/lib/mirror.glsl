// Draws a mirror that looks its reflection up in captures. Each technique has a shader that includes this file and
// first defines the function
//   Lookup search(uint mirror, vec3 offset, vec3 direction)
// The function finds the surface that a reflected ray meets in capture `mirror` (from 0). The ray starts at `offset`
// from the capture's centre, in scene units, and runs along the unit vector `direction`.
#ifndef CATOPTRIC_MIRROR_GLSL
#define CATOPTRIC_MIRROR_GLSL

#include "lib/constants.glsl"
#include "lib/first_hit.glsl"
#include "lib/next_mirror.glsl"
#include "lib/probe.glsl"
#include "lib/refraction.glsl"
#include "lib/surface.glsl"
#include "lib/rough.glsl"
#ifndef ABLATE
#include "lib/lit.glsl"
#endif
#include "lib/opaque_picture.glsl"

// The number of further mirrors through which the reflected ray is followed. Exact spheres are intersected before the
// search, because the intersection costs no texture fetch. Other mirrors are met if a search ends on them.
layout(constant_id = HOPS_CONSTANT) const uint hops = 0u;
// 1: captures store number and normal of their surfaces, as is needed if some mirror is no exact sphere.
layout(constant_id = HAS_SURFACES_CONSTANT) const uint has_surfaces = 0u;
// 1: where a search in the mirror's own capture ends unknown, the other mirrors' captures are searched, too.
layout(constant_id = ASKS_OTHERS_CONSTANT) const uint asks_others = 0u;
const uint kShowColour = 0u, kShowState = 1u, kShowResidual = 2u;
layout(constant_id = SHOW_CONSTANT) const uint show = kShowColour;

// The number of the tracer that takes over pixels where the search ends unknown; 0: no tracer does.
layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;
// 1: the tracer takes over all pixels, whatever the search answers.
layout(constant_id = TRUSTS_NONE_CONSTANT) const uint trusts_none = 0u;

// The reflected ray that is looked up. The ray leaves mirror `mirror` (from 0) at the point `at`.
struct MirrorPath {
    uint mirror;
    vec3 at;
    vec3 direction; // unit direction of the reflected ray
    vec3 centre;    // centre of the mirror's capture
    vec3 weight;    // product of the reflectances on the way from the eye
    uint hops;      // number of mirrors that the path met after the drawn mirror
};

bool is_mirror_surface(vec4 surface) { return surface.x > 0.0; }
vec4 read_captured_surface(uint mirror, vec3 direction) {
#define SURFACE(i) textureLod(SURFACE_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 0)
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, SURFACE)
}

// Returns the reflectance of a mirror for a ray that meets the mirror. A mirror without a capture has reflectance 0, so
// it is black in other mirrors.
vec3 mirror_reflectance(uint mirror, vec3 direction, vec3 n) {
    if (!has_mirror_capture(mirror)) return vec3(0);
    vec3 reflectance = read_probe(mirror).reflectance;
    bool is_metal = details != 0u && read_probe(mirror).kind == kMirrorMetal;
    return is_metal ? schlick_fresnel(reflectance, vec3(1), abs(dot(n, direction))) : reflectance;
}

// Reflects the path at the next exact sphere that the ray meets. Returns false, without a change, if the ray meets no
// sphere or the sphere is hidden.
bool reflect_at_exact_sphere(inout MirrorPath path) {
    uint next;
    float t;
    Ray ray = Ray(path.at, path.direction, 0u);
    if (!find_first_exact_sphere(ray, path.mirror, next, t)) return false;
    // The probe is read once. The driver simplifies c + x - c to x only if both c come from the same read, so two reads
    // would make the normal's rounding depend on how the lists are bound.
    vec3 centre = read_probe(next).sphere;
    float radius = read_probe(next).radius;
    vec3 error;
    vec3 met = sphere_hit_point(centre, radius, ray, t, error);
    // The capture shows a surface in front of the sphere if its distance is smaller by more than the sphere's radius.
    vec3 seen = met - path.centre;
    if (captured_distance(path.mirror, normalize(seen)) + radius < length(seen)) return false;
    vec3 n = (met - centre) / radius;
    path = MirrorPath(next, met, reflect_above_facet(path.direction, n, n), read_probe(next).centre,
                path.weight * mirror_reflectance(next, path.direction, n), path.hops + 1u);
    return true;
}

// Reflects the path at the mirror, of any shape, on which the search ended. The reflected ray starts where the path
// meets the mirror's tangent plane. Returns false, without a change, if the search ended on no such mirror.
bool reflect_at_captured_mirror(inout MirrorPath path, Lookup lookup) {
    vec4 surface = read_captured_surface(path.mirror, lookup.direction);
    if (lookup.state != kHit || lookup.layer != 0.0 || !is_mirror_surface(surface)) return false;
    uint next = uint(surface.x) - 1u;
    // If the captured mirror is an exact sphere, reflect_at_exact_sphere has found that the ray misses that sphere.
    if (read_probe(next).radius > 0.0) return false;
    // Only the capture knows the light of a lit mirror.
    if (details != 0u && read_probe(next).kind >= kMirrorLit) return false;
    vec3 n = normalize(surface.yzw);
    vec3 seen = path.centre + lookup.direction * captured_distance(path.mirror, lookup.direction);
    float t = dot(seen - path.at, n) / dot(path.direction, n);
    if (!(is_finite(t) && t > 0.0)) return false;
    path = MirrorPath(next, path.at + path.direction * t, reflect_above_facet(path.direction, n, n), read_probe(next).centre,
                path.weight * mirror_reflectance(next, path.direction, n), path.hops + 1u);
    return true;
}

// Returns whether the search ended on glass or a blended surface. The capture's colour there holds what its centre sees
// behind the surface, and the ray sees something else.
bool ends_on_see_through_surface(uint mirror, Lookup lookup) {
    if (has_surfaces == 0u || (has_glass == 0u && has_blending == 0u) || lookup.state == kMiss) return false;
    float number = read_captured_surface(mirror, lookup.direction).x;
    return number == kBlendedSurface || (number > 0.0 && read_probe(uint(number) - 1u).kind >= kMirrorThinGlass);
}

#ifndef OWN_LOOKUP_COLOUR // the including shader may define these functions itself, for captures of two layers
vec3 lookup_colour(uint mirror, Lookup lookup) { return colour_found_by_search(mirror, lookup); }
// Returns the distance from the capture's centre to the last found surface; 0: not known.
float distance_of_last_search_hit() { return 0.0; }
void set_distance_of_last_search_hit(float distance) {}
#endif

// Returns the distance along the path at which a search in capture `mirror` ends.
float find_path_distance_to_end(uint mirror, MirrorPath path, Lookup lookup) {
    float distance = distance_of_last_search_hit() > 0.0 ? distance_of_last_search_hit() : captured_distance(mirror, lookup.direction);
    vec3 end = read_probe(mirror).centre + lookup.direction * distance;
    return lookup.state == kMiss ? kLargestFloat : dot(end - path.at, path.direction);
}

// Searches the other mirrors' captures for the end of the ray, and takes the first that finds a surface. A search that
// ends on a mirror does not count, because the capture shows that mirror's reflection for another eye.
void search_other_captures(inout MirrorPath path, inout Lookup lookup) {
    float distance = distance_of_last_search_hit();
    Ray ray = Ray(path.at, path.direction, 0u);
    // The first mirror whose sphere or bounds the ray meets is the same for the captures of all mirrors.
    uint first;
    float met;
    bool meets = mirror_tree != 0u && find_first_mirror_by_tree(ray, path.mirror, false, first, met);
    uint next = 0u, count = frame.value.mirror_count;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        uint i = next++;
        if (i == path.mirror || !has_mirror_capture(i)) continue;
        Lookup other = search(i, path.at - read_probe(i).centre, path.direction);
        if (other.state == kUnknown || is_mirror_surface(read_captured_surface(i, other.direction))) continue;
        float end = find_path_distance_to_end(i, path, other);
        if (mirror_tree != 0u ? meets && !(end < met) : intersects_mirror_before(ray, path.mirror, end)) continue;
        path.mirror = i;
        path.centre = read_probe(i).centre;
        lookup = other;
        return;
    } while (next < count);
    set_distance_of_last_search_hit(distance);
}

// Follows the path through further mirrors to its end. Returns the place of the path's end in a capture.
// `most_hops`: the number of further mirrors through which the path is followed.
Lookup follow_path_through_mirrors(inout MirrorPath path, uint most_hops) {
    Lookup lookup;
    bool goes_on;
    do {
#ifdef CONTINUE
        while (path.hops < most_hops && reflect_at_exact_sphere(path)) {}
#endif
        lookup = search(path.mirror, path.at - path.centre, path.direction);
        goes_on = false;
#ifdef CONTINUE
        if (has_surfaces != 0u && path.hops < most_hops) goes_on = reflect_at_captured_mirror(path, lookup);
#endif
    } while (goes_on);
#ifdef CONTINUE
    if (asks_others != 0u && lookup.state == kUnknown) search_other_captures(path, lookup);
#endif
    return lookup;
}

vec3 apply_shown_picture_mode(vec3 colour, Lookup lookup) {
    if (show == kShowResidual) return vec3(lookup.residual);
    if (show == kShowState)
        return lookup.state == kHit ? vec3(0.1, 0.6, 0.2) : lookup.state == kUnknown ? vec3(0.9, 0.3, 0.1) : vec3(0.1, 0.2, 0.8);
    return colour;
}

// Returns the width alpha of the look-up that shows what the surface of that roughness at the start of the path reflects.
float rough_lookup_alpha(MirrorPath path, Lookup lookup, float roughness) {
    float ratio = 1.0, foreshortening = 1.0;
    float from_centre = distance_of_last_search_hit();
    if (distance_law != kLawNone && !(from_centre > 0.0)) from_centre = captured_distance(path.mirror, lookup.direction);
    // A surface outside the scene is so far away that the mirror and the capture's centre see it alike.
    if (distance_law != kLawNone && lookup.state != kMiss && is_finite(from_centre) && from_centre > 0.0) {
        vec3 end = path.centre + lookup.direction * from_centre;
        ratio = distance(end, path.at) / from_centre;
        if (distance_law == kLawExact && has_surfaces != 0u) {
            // The captured normal is zero beside a silhouette, where the nearest texel shows no surface. Both cosines
            // then have their least value.
            vec3 n = read_captured_surface(path.mirror, lookup.direction).yzw;
            // Shortest captured normal; a normal of length 0 is divided by this, all other normals are far longer.
            const float kMinNormalLength = 1e-3;
            float size = max(length(n), kMinNormalLength);
            float to_centre = abs(dot(n, lookup.direction)) / size, to_surface = abs(dot(n, path.direction)) / size;
            // At grazing angles the surface ends before the lobe's cross section does.
            foreshortening = max(to_centre, 0.1) / max(to_surface, 0.1);
        }
    }
    return lookup_alpha_by_distance_law(distance_law, roughness, ratio, foreshortening);
}

#ifdef ABLATE
#include "lib/ablate.glsl"
#include "lib/ablate_lobe.glsl"
#else

// Returns the radiance that the path brings from its end to a surface of roughness `roughness` at its start.
vec3 rough_path_radiance(MirrorPath path, Lookup lookup, float roughness) {
    float level = rough_lookup_level(path.mirror, rough_lookup_alpha(path, lookup, roughness));
    vec3 blurred = capture_colour_at_level(path.mirror, lookup.direction, max(level, 1.0));
    return level < 1.0 ? mix(lookup_colour(path.mirror, lookup), blurred, level) : blurred;
}

// Returns the radiance that the path brings to a glass surface. The glass spreads the light that passes as a mirror of
// roughness `roughness` spreads reflected light.
vec3 passing_radiance(MirrorPath path, Lookup lookup, float roughness) {
    if (has_lobes != 0u && has_levels && roughness > kMaxSharpRoughness) return rough_path_radiance(path, lookup, roughness);
    return lookup_colour(path.mirror, lookup);
}

// Returns whether the ray that enters a body of glass meets an object in it, and then the light from there.
bool find_light_inside_body(MirrorPath path, RefractedRay ray, vec3 absorption, out Lookup lookup, out vec3 light) {
    lookup = Lookup(ray.inside, kMiss, 0.0, 0.0);
    light = vec3(0);
    if (read_probe(path.mirror).holds == 0u || !(ray.way > 0.0)) return false;
    path.direction = ray.inside;
    float way = ray.way;
#ifdef CONTINUE
    uint next;
    float t;
    bool meets = hops > 0u && find_first_exact_sphere(Ray(path.at, path.direction, 0u), path.mirror, next, t) && t < way;
    if (meets) way = t;
#else
    const bool meets = false;
#endif
    if (!meets) {
        lookup = search(path.mirror, path.at - path.centre, path.direction);
        float met = find_path_distance_to_end(path.mirror, path, lookup);
        if (lookup.state == kMiss || !(met > 0.0 && met < way)) return false;
        way = met;
    }
    path.weight = ray.entering * exp(-absorption * way);
    lookup = follow_path_through_mirrors(path, hops);
    light = path.weight * lookup_colour(path.mirror, lookup);
    return true;
}

// Returns what the clear coat at the start of the path reflects to a viewer at the angle `cosine` to the normal. `sharp` is
// the coat's reflectance as a perfect mirror. With kRoughRays the coat reflects sharply.
vec3 clear_coat_radiance(MirrorPath path, Lookup lookup, vec3 sharp, float cosine) {
    if (has_levels && clear_coat.roughness > kMaxSharpRoughness)
        return rough_clear_coat_albedo(cosine) * rough_path_radiance(path, lookup, clear_coat.roughness);
    return sharp * lookup_colour(path.mirror, lookup);
}
#endif

void main() {
    vec3 facet = normalize(cross(dFdx(from_eye), dFdy(from_eye)));
    // Fragments are discarded after the derivatives, because a discard before the derivatives would make them
    // undefined.
    if (peels != 0u && is_peeled_from_second_layer()) discard;
    discard_cut_out_fragments();
    vec3 n = normalize(normal);
    Surface surface = find_surface_at_fragment(n, facet);
    vec3 seen = normalize(direction_from_viewer());
    MirrorPath path = MirrorPath(drawn_mirror_number() - 1u, fragment_surface_position(), reflect_above_facet(seen, n, facet),
                                 read_probe(drawn_mirror_number() - 1u).centre, surface.reflectance, 0u);
    bool is_glass = is_refracting(surface.detail);
    // These conditions repeat the shader constants, because the compiler removes only branches on constants, with the
    // code in them.
    bool is_traced_glass = has_glass != 0u && refract_model == kRefractTraced && tracer != 0u && is_glass;
    RefractedRay behind;
    if (has_glass != 0u && refract_model != kRefractNone && is_glass) {
        Probe body = read_probe(path.mirror);
        behind = refract_through_body(surface.detail, path.at, seen, n, length(from_eye), body);
        path.weight = vec3(behind.reflected);
        surface.reflectance = path.weight;
        surface.albedo = vec3(0); // light that is not reflected passes, and none is scattered
    }
    MirrorPath passing = path;
#ifdef ABLATE
    MirrorPath first = path;
    Lookup lookup;
    // With a lobe, the first look-up is that of the perfect mirror, and the others are those of drawn directions.
    start_drawing_from_lobe(surface.reflectance != vec3(0) && !is_glass);
    vec3 colour = vec3(0), albedo = specular_lobe_albedo(-dot(n, seen));
    uint i = 0u;
    do {
        bool is_drawn = i > 0u;
        MirrorPath followed = first;
        Lookup found = lookup;
        if (is_drawn) draw_from_lobe(seen, facet, albedo, i - 1u, path, followed, found);
        if (!is_drawn || is_cause_ablated(kAblateDistanceLaw)) found = follow_path_through_mirrors(followed, lobe_draws > 0u && has_levels ? 0u : hops);
        if (!is_drawn) lookup = found, path = followed;
        // No cause of error is removed from glass: the exact rays of the ablation follow reflections alone.
        if (is_glass) colour = path.weight * lookup_colour(path.mirror, lookup) + surface.emission;
        else if (is_drawn == lobe_draws > 0u) colour += find_ablated_radiance(followed, found);
    } while (i++ < lobe_draws);
    if (lobe_draws > 0u) colour *= i > lobe_draws ? 1.0 / float(lobe_draws) : uintBitsToFloat(0x7fc00000u); // NaN if the driver stopped the loop
#else
    bool is_rough = rough != kRoughNone && has_rough_lobe() && surface.reflectance != vec3(0), is_stopped = false;
    vec3 coat_weight = vec3(0);
    bool coat_looks_up_level = false;
    if (has_clear_coats != 0u && clear_coat.strength > 0.0) {
        is_rough = is_rough && clear_coat.is_base_shown;
        if (clear_coat.is_shown) coat_weight = vec3(clear_coat.reflected);
        path.weight -= coat_weight;
        coat_looks_up_level = clear_coat.is_shown && has_levels && clear_coat.roughness > kMaxSharpRoughness;
    }
    bool looks_up_level = is_rough && rough != kRoughRays;
    if (rough != kRoughNone && looks_up_level && !is_glass) path.weight = specular_lobe_albedo(-dot(n, seen));
    vec3 base_weight = path.weight;
    if (has_clear_coats != 0u) path.weight = vec3(1); // the surface and its coat share the path
    MirrorPath first = path;
    // A blurred look-up does not follow the path through further mirrors. A lobe reflects a mirror and its
    // neighbourhood at once, which only the blurred capture shows.
    Lookup lookup = follow_path_through_mirrors(path, looks_up_level || coat_looks_up_level ? 0u : hops);
    vec3 colour;
    if (rough == kRoughNone || !is_rough)
        colour = path.weight * lookup_colour(path.mirror, lookup);
    else if (rough != kRoughRays)
        colour = path.weight * rough_path_radiance(path, lookup, specular_lobe.roughness);
    else {
        // The search along the perfect mirror's direction says how the search ends, and is no sample of the lobe.
        colour = vec3(0);
        uint pixel = uint(gl_FragCoord.y) << 16u | uint(gl_FragCoord.x), i = 0u;
        do {
            float u, v;
            sample_pattern_point(pixel, i, 0u, kSearchSeed, u, v);
            MirrorPath drawn = first;
            drawn.weight = vec3(1);
            if (sample_specular_lobe(seen, facet, u, v, drawn.weight, drawn.direction) &&
                drawn.weight != vec3(0)) {
                Lookup found = follow_path_through_mirrors(drawn, hops);
                colour += drawn.weight * lookup_colour(drawn.mirror, found);
            }
            ++i;
        } while (i < lobe_rays);
        // The software driver silently stops an invocation's loops after 65,535 iterations.
        is_stopped = i < lobe_rays;
        colour /= float(lobe_rays);
    }
    if (has_clear_coats != 0u) {
        if (!is_rough || looks_up_level) colour *= base_weight;
        if (coat_weight != vec3(0)) colour += path.weight * clear_coat_radiance(path, lookup, coat_weight, -dot(n, seen));
    }
    if (lights_mirrors != 0u) {
        // As in rays (trace_radiance): from inside glass, no light without a surface is seen.
        if (has_glass != 0u && is_glass && is_inside_glass(surface.detail, seen, n)) {
            colour += surface.emission;
        } else {
            bool turns = has_glass != 0u && is_glass && dot(n, seen) > 0.0;
            colour += shade_drawn_fragment(surface, turns ? -n : n, facet);
        }
    }
#endif
    if (has_glass != 0u && refract_model != kRefractNone && is_glass && !is_traced_glass) {
        MirrorPath passing_start = passing;
        passing.at = behind.origin;
        passing.direction = behind.direction;
        passing.weight = behind.weight;
        vec3 shown;
#ifndef ABLATE
        Lookup within;
        if (find_light_inside_body(passing_start, behind, read_material_parameters(surface.detail).absorption, within, shown)) {
            colour += shown;
            if (within.state == kUnknown) {
                lookup.state = kUnknown;
                lookup.layer = 0.0;
            }
        } else
#endif
        if (refract_model == kRefractScreen && !is_inside_glass(surface.detail, seen, n) &&
            find_light_in_opaque_picture(surface.detail, behind.origin, shown)) {
            colour += passing.weight * shown;
        } else {
#ifdef ABLATE
            Lookup passed = follow_path_through_mirrors(passing, hops);
            colour += passing.weight * lookup_colour(passing.mirror, passed);
#else
            Lookup passed = follow_path_through_mirrors(passing, has_levels && behind.roughness > kMaxSharpRoughness ? 0u : hops);
            colour += passing.weight * passing_radiance(passing, passed, behind.roughness);
#endif
            if (passed.state == kUnknown) {
                lookup.state = kUnknown;
                lookup.layer = 0.0;
            }
        }
    }
    write_fragment_outputs(apply_shown_picture_mode(colour, lookup));
#ifndef ABLATE
    if (rough == kRoughRays && is_stopped) out_colour.rgb = vec3(uintBitsToFloat(0x7fc00000u)); // the pixel is NaN
#endif
    if (tracer != 0u && (trusts_none != 0u || is_traced_glass || lookup.state == kUnknown ||
        ends_on_see_through_surface(path.mirror, lookup))) {
        out_distance = float(tracer);
#ifdef FIRST_HIT
        out_colour = make_first_hit_words(uint(gl_PrimitiveID), drawn_object_index(), drawn_mirror_number(), tracer);
#endif
    }
    if (keeps_surface == 0u)
        out_more = vec4(lookup.direction, float(1u + lookup.state) + 4.0 * lookup.layer + 8.0 * float(path.mirror) +
                                              clamp(lookup.residual, 0.0, 0.996)); // residual: a fraction below 1
}

#endif
