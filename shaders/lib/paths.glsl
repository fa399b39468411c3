// Path tracing (Kajiya, "The Rendering Equation", 1986): how a ray goes on at a surface that also reflects diffusely. Each
// ray follows either the specular part of the surface or its diffuse part, and rays to lamps count both parts.
#ifndef CATOPTRIC_PATHS_GLSL
#define CATOPTRIC_PATHS_GLSL

// First dimension of sample_pattern_point that decides which part of the surface a path follows, and whether the path
// ends.
const uint kPartDimensions = 0x20000u;
// First dimensions of sample_pattern_point for the layer of a coated surface, and for directions of rough glass.
const uint kLayerDimensions = 0x30000u, kGlassDimensions = 0x40000u;
// Reflections after which a path may end by chance (Russian roulette).
const uint kBouncesBeforeRoulette = 3u;

// What a surface reflects in all directions, and what it reflects in its lobe or in the mirrored direction.
struct Reflection {
    vec3 diffuse;         // albedo for rays that leave in all directions; 0 without traces_paths
    vec3 mirrored;        // share of light from the mirrored direction, if the surface is smooth
    float specular_share; // probability that a ray follows the lobe or the mirrored direction
    uint detail;          // index of the MaterialParameters
};

// Returns whether rays leave the surface that was evaluated last in directions drawn from its lobe.
bool draws_from_lobe() { return traces_lobes != 0u && has_rough_lobe(); }

// Returns the parts of the surface that was evaluated last. `has_specular`: it reflects in its lobe or like a mirror.
// `cosine`: between the shading normal and the direction to the viewer.
Reflection split_reflection(Surface surface, bool has_specular, float cosine) {
    Reflection parts = Reflection(vec3(0), surface.reflectance, 1.0, surface.detail);
    if (traces_paths == 0u) return parts;
    // Without MaterialParameters, a mirror has no diffuse part.
    if (!has_specular || details != 0u) parts.diffuse = surface.albedo;
    float specular = has_specular ? largest_vector_component(has_rough_lobe() ? specular_lobe_albedo(cosine) : surface.reflectance) : 0.0;
    float whole = specular + largest_vector_component(parts.diffuse);
    if (whole > 0.0) parts.specular_share = specular / whole;
    return parts;
}

// Returns a unit vector drawn with the density cosine / pi around the unit normal. `u` and `v` are uniform in [0, 1).
vec3 sample_cosine(vec3 normal, float u, float v) {
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    float angle = 2.0 * kPi * u, radius = sqrt(v);
    return normalize(radius * cos(angle) * tangent + radius * sin(angle) * bitangent + sqrt(1.0 - v) * normal);
}

// Returns the share of light, per steradian, that the surface reflects from `leaving` to where the ray along `direction`
// comes from, without the mirrored part, and the density with which sample_reflection_direction draws `leaving`.
vec3 evaluate_reflection(SurfacePoint p, Reflection parts, vec3 direction, vec3 leaving, out float density) {
    vec3 reflected = vec3(0);
    density = 0.0;
    if (draws_from_lobe()) {
        reflected = evaluate_specular_lobe(direction, reflect_above_facet(direction, p.normal, p.facet), p.facet, leaving, density);
        density *= parts.specular_share;
    }
    if (traces_paths == 0u) return reflected;
    float cosine = dot(p.normal, leaving);
    if (!(cosine > 0.0) || parts.diffuse == vec3(0)) return reflected;
    vec3 facet = find_facet_normal_for_shading(parts.detail, p.facet);
    float share = 1.0, drawn = cosine;
    if (facet != vec3(0)) {
        facet = normalize(facet_normal_on_shading_side(p.normal, facet));
        // What the facet hides of its light returns to the rest, so that a surface keeps its albedo.
        share = facet_light_share(leaving, p.normal, facet) / mean_facet_light_share(dot(p.normal, facet));
        drawn = dot(leaving, facet) > 0.0 ? cosine + max(dot(p.normal, reflect(leaving, facet)), 0.0) : 0.0;
    }
    density += (1.0 - parts.specular_share) * drawn / kPi;
    return reflected + parts.diffuse * (share * cosine / kPi);
}

// Returns a direction drawn for the diffuse part: by the cosine to the shading normal, and above the facet. A direction
// below the facet is mirrored at it.
vec3 sample_diffuse_direction(SurfacePoint p, Reflection parts, float u, float v) {
    vec3 leaving = sample_cosine(p.normal, u, v);
    vec3 facet = facet_normal_on_shading_side(p.normal, find_facet_normal_for_shading(parts.detail, p.facet));
    return dot(leaving, facet) < 0.0 ? reflect(leaving, normalize(facet)) : leaving;
}

// Returns whether sample_reflection_direction draws random numbers that change its results.
bool is_direction_random(Reflection parts, uint bounce) {
    return draws_from_lobe() || traces_paths != 0u && (parts.diffuse != vec3(0) || bounce >= kBouncesBeforeRoulette);
}

// Draws the direction in which a ray leaves a surface at the path's `bounce`th reflection. `direction` is that of the
// arriving ray. Multiplies the weight by what the surface reflects from there. Returns false, with the mirrored direction
// and density 0, if a smooth part of the surface reflects the ray.
bool sample_reflection_direction(SurfacePoint p, Reflection parts, vec3 direction, uint bounce, inout vec3 weight, out vec3 leaving, out float density) {
    leaving = reflect_above_facet(direction, p.normal, p.facet);
    density = 0.0;
    float part = 0.0, survival = 0.0, u = 0.0, v = 0.0;
    if (traces_lobes != 0u) sample_pattern_point(path_pixel, path_sample, bounce, path_seed, u, v);
    if (traces_paths != 0u) sample_pattern_point(path_pixel, path_sample, kPartDimensions + bounce, path_seed, part, survival);
    bool has_specular = traces_paths == 0u || part < parts.specular_share;
    vec3 lobe_weight = vec3(1);
    bool is_drawn = !has_specular || draws_from_lobe() && sample_specular_lobe(direction, p.facet, u, v, lobe_weight, leaving);
    if (is_drawn) {
        if (!has_specular) leaving = sample_diffuse_direction(p, parts, u, v);
        vec3 reflected = evaluate_reflection(p, parts, direction, leaving, density);
        // The weight of a drawn lobe direction is exact for lobes of any width, but the quotient of lobe and density is
        // not.
        if (traces_paths == 0u || parts.specular_share == 1.0) weight *= lobe_weight;
        else weight *= density > 0.0 ? reflected / density : vec3(0);
    } else {
        weight *= traces_paths == 0u ? parts.mirrored : parts.mirrored / parts.specular_share;
    }
    if (traces_paths != 0u && bounce >= kBouncesBeforeRoulette) {
        float probability = min(largest_vector_component(weight), 1.0);
        weight = survival < probability ? weight / probability : vec3(0);
    }
    return is_drawn;
}

#endif
