// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Mathematics of lights, Lambertian surfaces, mirror reflection and sRGB encoding.

// Computes the geometric factor of a light's contribution: max(0, -w.n_l) / t^2 * max(0, n.w). Here w is the direction
// to the light, t the distance to the light, n the surface's normal, and n_l the light's normal. A zero light_normal
// means that the light has no cosine factor. Returns false, with factor 0, if a cosine is not positive or the light is
// at the point. The caller then needs no shadow ray.
INLINE bool compute_point_light_factor(vec3 position, vec3 normal, vec3 light_position, vec3 light_normal,
                       OUT(vec3) direction, OUT(real) distance, OUT(real) factor) {
    vec3 to_light = light_position - position;
    distance = length(to_light);
    direction = vec3(real(0));
    factor = real(0);
    if (!(distance > real(0) && distance <= kLargestFloat)) return false;
    direction = to_light / distance;
    real at_light = dot(light_normal, light_normal) > real(0) ? -dot(direction, light_normal)
                                                              : real(1);
    real at_surface = dot(normal, direction);
    if (!(at_light > real(0) && at_surface > real(0))) return false;
    factor = (at_light / distance) * (at_surface / distance);
    return true;
}

// The sine of 6 degrees, the angle above a facet's plane within which the light of a facet fades. Meshes whose vertex
// normals differ from their facets' normals by at most this angle are lit by their vertex normals alone.
const real kFacetFadeSine = real(0.10452846326765347);

// Returns the facet's normal, turned to the side on which the shading normal lies.
INLINE vec3 facet_normal_on_shading_side(vec3 normal, vec3 facet) { return dot(normal, facet) < real(0) ? -facet : facet; }

// Returns the share of a light that a facet receives, 0 to 1. The unit `direction` points to the light, which is in
// front of the unit shading normal. The share is 0 below the facet's plane. It is 1 from 6 degrees above the facet's
// plane, or from the light's angle above the shading normal's plane if that is smaller. `facet` points along the
// facet's normal and has any length.
INLINE real facet_light_share(vec3 direction, vec3 normal, vec3 facet) {
    real sine = dot(direction, facet_normal_on_shading_side(normal, facet)) / length(facet);
    real t = clamp(sine / min(kFacetFadeSine, dot(direction, normal)), real(0), real(1));
    return t * t * (real(3) - real(2) * t);
}

// Returns the mean of facet_light_share over directions around the shading normal with the density cosine / pi, within
// .0004. `cosine`: between the shading normal and the facet's normal on its side. The share of directions below the facet
// is (1 - cosine) / 2; the rest is what fades above it (fitted to a numerical integral).
INLINE real mean_facet_light_share(real cosine) {
    real sine = sqrt(max(real(1) - cosine * cosine, real(0)));
    return (real(1) + cosine) / real(2) - real(.0333) * sine - min(real(.02) * sine, real(.0014) * cosine);
}

// Returns the mean |cosine| between a lamp's facets and a direction. `cosines` holds this mean for three orthogonal
// axes.
INLINE real mean_lamp_facet_cosine(vec3 direction, vec3 right, vec3 down, vec3 forward, vec3 cosines) {
    return length(cosines * vec3(dot(right, direction), dot(down, direction), dot(forward, direction)));
}

// Returns the attenuation at a distance of a light without a surface, as in KHR_lights_punctual: 1 close to the light,
// 0 from its range on. `reach` is 1 / range, or 0 for an infinite range.
INLINE real range_attenuation(real distance, real reach) {
    real part = distance * reach;
    real square = part * part;
    return clamp(real(1) - square * square, real(0), real(1));
}

// Returns the share of its intensity that a spot light emits at an angle with this cosine to its axis. `sharpness` is
// 1 / max(.001, cos inner - cos outer).
INLINE real spot_attenuation(real cosine, real cos_outer, real sharpness) {
    real t = clamp((cosine - cos_outer) * sharpness, real(0), real(1));
    return t * t;
}

// Computes the factor of a directional light that shines along the unit `axis`: the cosine at the surface. Returns
// whether the factor is positive.
INLINE bool compute_directional_light_factor(vec3 normal, vec3 axis, OUT(vec3) direction, OUT(real) distance,
    OUT(real) factor) {
    direction = -axis;
    distance = kLargestFloat;
    factor = max(real(0), dot(normal, direction));
    return factor > real(0);
}

// Converts a density per area at a point with the unit normal `normal` to a density per steradian, as seen from
// -`to_point` away. Infinite for a point seen edge-on.
INLINE real solid_angle_density(real area_density, vec3 to_point, vec3 normal) {
    real square = dot(to_point, to_point);
    return area_density * square * sqrt(square) / abs(dot(normal, to_point));
}

// Returns the radiance of a Lambertian surface. `direct` is the sum over all lights of intensity * factor * visible.
INLINE vec3 lambertian_radiance(vec3 emission, vec3 albedo, vec3 direct, real ambient) {
    return emission + albedo / kPi * direct + albedo * ambient;
}

// Reflects the unit direction `d` about the interpolated normal. If the reflection points below the facet, as seen from
// the side from which `d` comes, it is mirrored to above the facet.
INLINE vec3 reflect_above_facet(vec3 d, vec3 n_shading, vec3 n_geometric) {
    vec3 facet = dot(d, n_geometric) > real(0) ? -n_geometric : n_geometric;
    vec3 r = d - real(2) * dot(d, n_shading) * n_shading;
    real height = dot(r, facet);
    return height < real(0) ? normalize(r - real(2) * height * facet) : r;
}

// Encodes linear light, 0 to 1, by the sRGB curve (IEC 61966-2-1), 0 to 1. NaN becomes 0.
INLINE real srgb_from_linear_channel(real linear) {
    if (!(linear > real(0))) return real(0);
    if (linear >= real(1)) return real(1);
    if (linear <= real(0.0031308)) return real(12.92) * linear;
    return real(1.055) * pow(linear, real(1) / real(2.4)) - real(0.055);
}
