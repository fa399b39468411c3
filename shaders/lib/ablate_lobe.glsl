// Ablation of rough mirrors: directions that are drawn from a lobe replace the one look-up in a filtered level of the
// capture. docs/causes.md describes the three causes of error that go away in this way.
#ifndef CATOPTRIC_ABLATE_LOBE_GLSL
#define CATOPTRIC_ABLATE_LOBE_GLSL

const uint kAblationSeed = 0xab1a7e5u; // of the drawn directions; searches and the ray tracer have other seeds
SpecularLobe lobe_to_ablate;

// Prepares the directions of the pixel whose surface was evaluated last. `reflects`: the surface may have a lobe. The
// picture's number says which directions are drawn: that of its half, by the last bit, and which of the half, from 1.
void start_drawing_from_lobe(bool reflects) {
    uint number = draw.ablated >> kAblateDrawBits;
    path_pixel = uint(gl_FragCoord.y) << 16u | uint(gl_FragCoord.x);
    path_seed = kAblationSeed + (number & 1u);
    path_sample = (max(number >> 1u, 1u) - 1u) * kAblatedLobeRays;
    lobe_to_ablate = specular_lobe;
    lobe_draws = reflects && is_cause_ablated(kAblateFilter) && has_rough_lobe() ? kAblatedLobeRays : 0u;
}

// Returns the mean of max(0, z) over directions that sample_lobe_seen_head_on draws: with x, the squared tangent of the
// angle between normals, the integral over x from 0 to 1 of (1 - x) / (1 + x) a / (a + x)^2, where a is alpha^2.
float mean_cosine_of_lobe_seen_head_on(float alpha) {
    // At a = 1 the closed form is 0 / 0, and near 1 it loses digits: up to .98 floats err by less than .001 of the result,
    // at .99 by .004. From .98 to 1 the result only falls from .253 to .250.
    float a = min(alpha * alpha, 0.98), square = (1.0 - a) * (1.0 - a);
    return 1.0 / (1.0 - a) - 2.0 * a / square * (log(1.0 + a) - log(2.0 * a));
}

// Returns the direction whose angle to `to` is that of `direction` to `from`, with the tangent of half the angle
// multiplied by `scale`, so that a lobe seen head-on becomes one of `scale` times the width. All vectors are unit vectors.
vec3 turn_and_widen(vec3 direction, vec3 from, vec3 to, float scale) {
    // 1 plus the cosine of two directions is rounded by up to 6e-8. 1e-6 is 17 times that: directions whose angle is within
    // .08 degrees of 180 degrees have no digits left in the divisor.
    const float kMinDivisor = 1e-6;
    float cosine = dot(direction, from);
    vec3 side = (direction - cosine * from) * (scale / max(1.0 + cosine, kMinDivisor));
    side -= dot(to, side) / max(1.0 + dot(from, to), kMinDivisor) * (from + to); // the rotation by the least angle
    return normalize((1.0 - dot(side, side)) * to + 2.0 * side);
}

// Returns the lobe times the cosine, per steradian, and the density with which its directions are drawn. `middle` is the
// direction of the perfect mirror. `width` is that of the lobe seen head-on, which only its own shape replaces.
vec3 evaluate_ablated_lobe(vec3 seen, vec3 middle, vec3 facet, vec3 albedo, float width, vec3 direction, out float density) {
    if (is_cause_ablated(kAblateLobeShape)) return evaluate_specular_lobe(seen, middle, facet, direction, density);
    // The cosine of half the angle between the two directions. The least cosine keeps the divisor from 0 within .11 degrees
    // of the opposite direction, where the lobe is 0 in any case.
    const float kMinCosine = 1e-3;
    float cosine = max(sqrt(max(0.5 + 0.5 * dot(middle, direction), 0.0)), kMinCosine);
    density = ggx_density(width, vec3(0.5 * length(cross(middle, direction)) / cosine, 0, cosine)) / 4.0;
    return albedo * (max(dot(middle, direction), 0.0) / mean_cosine_of_lobe_seen_head_on(width) * density);
}

const uint kMostAimedLamps = 64u; // triangles of lamps; with more, no direction is aimed at a lamp

// Returns the density, per steradian, with which a point drawn on a lamp lies in `direction` from `origin`.
float lamp_direction_density(vec3 origin, vec3 direction, uint triangles) {
    float density = 0.0;
    uint i = 0u;
    do {
        vec3 corner = lamp_texels_at(1u + 3u * i).xyz, second = lamp_texels_at(2u + 3u * i).xyz;
        vec4 third = lamp_texels_at(3u + 3u * i);
        vec3 across = cross(direction, third.xyz), from = origin - corner, around = cross(from, second);
        float divisor = dot(second, across), u = dot(from, across) / divisor, v = dot(direction, around) / divisor, t = dot(third.xyz, around) / divisor;
        if (t > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0)
            density += solid_angle_density(lamp_point_density(floatBitsToUint(third.w) & kBvhIdMask), t * direction, normalize(cross(second, third.xyz)));
    } while (++i < triangles);
    return density;
}

// Draws direction `index` of the picture, and the look-up in it. `seen` and `facet`: as for sample_specular_lobe.
// `albedo`: of the lobe. `mirrored` and `lookup`: the path of the perfect mirror, and its end. `path` is at first the path
// before its search. Every second direction is aimed at a lamp, as it is seen from the surface or from the capture's
// centre, because few directions of a lobe meet a small lamp. The weights are those of the balance heuristic.
void draw_from_lobe(vec3 seen, vec3 facet, vec3 albedo, uint index, MirrorPath mirrored, inout MirrorPath path, inout Lookup lookup) {
    specular_lobe = lobe_to_ablate; // the ablation has evaluated other surfaces
    path_sample = path_sample / kAblatedLobeRays * kAblatedLobeRays + index;
    bool is_searched = is_cause_ablated(kAblateDistanceLaw), has_shape = is_cause_ablated(kAblateLobeShape);
    float u, v, alpha = roughness_to_alpha(specular_lobe.roughness), width = alpha, scale = 1.0, density;
    if (!is_searched) width = rough_lookup_alpha(mirrored, lookup, specular_lobe.roughness);
    if (has_shape) scale = width / alpha;
    uint triangles = 0u;
    if (samples_lamps != 0u) triangles = floatBitsToUint(lamp_texels_at(0u).y) & kBvhIdMask;
    if (triangles > kMostAimedLamps) triangles = 0u;
    bool is_aimed = triangles > 0u && (index & 1u) != 0u;
    sample_pattern_point(path_pixel, triangles > 0u ? path_sample >> 1u : path_sample, is_aimed ? kLampDimensions : 0u, path_seed, u, v);
    // With one look-up for the lobe, a lamp is where the capture's centre sees it.
    vec3 middle = path.direction, place, in_capture, origin = is_searched && (index & 2u) == 0u ? path.at : path.centre;
    if (is_aimed) {
        in_capture = place = normalize(draw_lamp_point(u, v).position - origin);
        if (!is_searched) place = turn_and_widen(in_capture, lookup.direction, middle, 1.0 / scale);
    } else {
        vec3 unused = vec3(1), tangent, bitangent, drawn = sample_lobe_seen_head_on(width, u, v);
        tangent_frame(middle, tangent, bitangent);
        place = has_shape ? middle : drawn.x * tangent + drawn.y * bitangent + drawn.z * middle;
        if (has_shape) sample_specular_lobe(seen, facet, u, v, unused, place);
        in_capture = is_searched ? place : turn_and_widen(place, middle, lookup.direction, scale);
    }
    path.direction = place;
    path.weight = evaluate_ablated_lobe(seen, middle, facet, albedo, width, place, density);
    if (triangles > 0u) {
        float aimed = lamp_direction_density(path.centre, in_capture, triangles);
        if (is_searched) aimed = 0.5 * (aimed + lamp_direction_density(path.at, in_capture, triangles));
        // Widening by `scale` changes solid angles.
        float widening = is_searched ? 1.0 : scale * (1.0 + dot(in_capture, lookup.direction)) / (1.0 + dot(place, middle));
        density = 0.5 * (density + aimed * widening * widening);
    }
    path.weight = density > 0.0 ? path.weight / density : vec3(0);
    lobe_direction = path.direction;
    lobe_weight = path.weight;
    if (!is_searched) lookup = Lookup(in_capture, kHit, 0.0, 0.0);
}

#endif
