// Part of lib/math.glsl, which alone includes it.
// Light and what becomes of it: lamps and other lights, Lambertian surfaces, mirrors, screens.

// The part of a light's contribution that is geometry: max(0, -w.n_l) / t^2 * max(0, n.w), with w
// the direction and t the distance to the light. light_normal zero: no cosine at the light.
// False, factor 0: a cosine is not positive (or the light is at the point): no shadow ray needed.
INLINE bool light_term(vec3 position, vec3 normal, vec3 light_position, vec3 light_normal,
                       OUT(vec3) direction, OUT(real) distance, OUT(real) factor) {
    vec3 to_light = light_position - position;
    distance = length(to_light);
    direction = vec3(real(0));
    factor = real(0);
    if (!(distance > real(0) && distance <= kLargest)) return false;
    direction = to_light / distance;
    real at_light = dot(light_normal, light_normal) > real(0) ? -dot(direction, light_normal)
                                                              : real(1);
    real at_surface = dot(normal, direction);
    if (!(at_light > real(0) && at_surface > real(0))) return false;
    factor = (at_light / distance) * (at_surface / distance);
    return true;
}

// Sine of the angle above a facet's plane within which light fades, 6 degrees; and the most by which the normals of
// what is lit by its normals alone leave those of its facets.
const real kFacetFade = real(0.10452846326765347);

// The side of a facet on which the shading normal lies.
INLINE vec3 facet_side(vec3 normal, vec3 facet) { return dot(normal, facet) < real(0) ? -facet : facet; }

// What a facet takes of a light in a unit direction that is in front of the unit `normal`: nothing from below its
// plane, all from 6 degrees above it, or from as high as above the normal's own. `facet`: along its normal, of any length.
INLINE real facet_share(vec3 direction, vec3 normal, vec3 facet) {
    real sine = dot(direction, facet_side(normal, facet)) / length(facet);
    real t = clamp(sine / min(kFacetFade, dot(direction, normal)), real(0), real(1));
    return t * t * (real(3) - real(2) * t);
}

// Mean |cosine| of a lamp's facets to a direction. `cosines`: the same to three orthogonal axes.
INLINE real mean_cosine(vec3 direction, vec3 right, vec3 down, vec3 forward, vec3 cosines) {
    return length(cosines * vec3(dot(right, direction), dot(down, direction), dot(forward, direction)));
}

// What is left of a light without a surface at a distance, as KHR_lights_punctual has it: 1 near by, 0 from its
// range on. `reach`: one over the range; 0 without one.
INLINE real range_share(real distance, real reach) {
    real part = distance * reach;
    real square = part * part;
    return clamp(real(1) - square * square, real(0), real(1));
}

// What a spot sends in a direction at this cosine to its axis. `sharpness`: 1 / max(.001, cos inner - cos outer).
INLINE real cone_share(real cosine, real cos_outer, real sharpness) {
    real t = clamp((cosine - cos_outer) * sharpness, real(0), real(1));
    return t * t;
}

// light_term of a directional light that shines along the unit `axis`: the cosine at the surface.
INLINE bool parallel_term(vec3 normal, vec3 axis, OUT(vec3) direction, OUT(real) distance, OUT(real) factor) {
    direction = -axis;
    distance = kLargest;
    factor = max(real(0), dot(normal, direction));
    return factor > real(0);
}

// Radiance of a Lambertian surface; `direct` = sum over lights of intensity * factor * visible.
INLINE vec3 lambert(vec3 emission, vec3 albedo, vec3 direct, real ambient) {
    return emission + albedo / kPi * direct + albedo * ambient;
}

// Reflection of the unit direction d about the interpolated normal; where that points below the
// facet (seen from the side d comes from), it is folded back above it.
INLINE vec3 mirror_direction(vec3 d, vec3 n_shading, vec3 n_geometric) {
    vec3 facet = dot(d, n_geometric) > real(0) ? -n_geometric : n_geometric;
    vec3 r = d - real(2) * dot(d, n_shading) * n_shading;
    real height = dot(r, facet);
    return height < real(0) ? normalize(r - real(2) * height * facet) : r;
}

// The sRGB curve (IEC 61966-2-1) of linear light, both in [0, 1]; NaN is black.
INLINE real srgb_encoded(real linear) {
    if (!(linear > real(0))) return real(0);
    if (linear >= real(1)) return real(1);
    if (linear <= real(0.0031308)) return real(12.92) * linear;
    return real(1.055) * pow(linear, real(1) / real(2.4)) - real(0.055);
}
