// Part of lib/math.glsl; only lib/math.glsl includes this file.
// The specular lobe of a rough surface: GGX distribution, height-correlated Smith shadowing, Schlick's Fresnel
// reflectance, single scattering. Directions are unit vectors in tangent space, whose z axis is the normal, and point
// away from the surface. `to_eye` is the direction to the viewer and has z > 0, `to_light` the direction of the light.

// The density of normals is at most 1 / (pi alpha^2). A float holds numbers up to 3.4e38, so an alpha under 3.1e-20
// overflows it. 1e-7 also keeps the product of two such densities finite.
const real kMinAlpha = real(1e-7);

// Returns the lobe's width `alpha` for a roughness from 0 to 1, as glTF defines it.
INLINE real roughness_to_alpha(real roughness) { return max(roughness * roughness, kMinAlpha); }

// Returns the density of microfacet normals around `half_way`, per steradian: D of Walter et al., "Microfacet Models for
// Refraction through Rough Surfaces", 2007. Written with x and y, because 1 - z^2 loses digits near the normal.
INLINE real ggx_density(real alpha, vec3 half_way) {
    real slope_x = half_way.x / alpha, slope_y = half_way.y / alpha;
    real s = slope_x * slope_x + slope_y * slope_y + half_way.z * half_way.z;
    return real(1) / (kPi * alpha * alpha * s * s);
}

// Computes two unit vectors that form a right-handed frame with the unit normal (Duff et al., "Building an Orthonormal
// Basis, Revisited", 2017).
INLINE void tangent_frame(vec3 normal, OUT(vec3) tangent, OUT(vec3) bitangent) {
    real side = normal.z < real(0) ? real(-1) : real(1);
    real a = real(-1) / (side + normal.z), b = normal.x * normal.y * a;
    tangent = vec3(real(1) + side * normal.x * normal.x * a, side * b, -side * normal.x);
    bitangent = vec3(b, side + normal.y * normal.y * a, -normal.y);
}

// Returns the length of a direction that is stretched by alpha along the surface.
INLINE real length_stretched_by_alpha(real alpha, vec3 direction) {
    real x = alpha * direction.x, y = alpha * direction.y;
    return sqrt(x * x + y * y + direction.z * direction.z);
}

// Returns G2 / (4 z_eye z_light) for the height-correlated shadowing and masking G2 (Heitz, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs", 2014, equation 99). Both directions have z > 0.
INLINE real smith_visibility(real alpha, vec3 to_eye, vec3 to_light) {
    return real(0.5) / (to_light.z * length_stretched_by_alpha(alpha, to_eye) + to_eye.z * length_stretched_by_alpha(alpha, to_light));
}

// Returns the unit vector half-way between two directions, or the normal if they are opposite.
INLINE vec3 half_vector_between(vec3 a, vec3 b) {
    vec3 sum = a + b;
    real size = length(sum);
    return size > real(0) ? sum / size : vec3(real(0), real(0), real(1));
}

// Returns the reflectance of the lobe times the cosine of the light, per steradian. `f0` and `f90` are the reflectances
// at normal and at grazing incidence. Returns 0 for a light below the surface.
INLINE vec3 evaluate_lobe(real alpha, vec3 f0, vec3 f90, vec3 to_eye, vec3 to_light) {
    if (!(to_eye.z > real(0)) || !(to_light.z > real(0))) return vec3(real(0));
    vec3 half_way = half_vector_between(to_eye, to_light);
    real density = ggx_density(alpha, half_way) * smith_visibility(alpha, to_eye, to_light) * to_light.z;
    return schlick_fresnel(f0, f90, dot(to_eye, half_way)) * density;
}

// Returns the factor k by which bounded sampling limits the visible normals (Eto and Tokuyoshi, "Bounded VNDF Sampling
// for Smith-GGX Reflections", 2023).
INLINE real visible_normal_sampling_bound(real alpha, vec3 to_eye) {
    real a = min(alpha, real(1));
    real s = real(1) + sqrt(to_eye.x * to_eye.x + to_eye.y * to_eye.y);
    real s2 = s * s, a2 = a * a;
    return (real(1) - a2) * s2 / (s2 + a2 * to_eye.z * to_eye.z);
}

// Returns the probability density, per steradian, with which sample_lobe draws `to_light`.
INLINE real lobe_pdf(real alpha, vec3 to_eye, vec3 to_light) {
    if (!(to_eye.z > real(0))) return real(0);
    real k = visible_normal_sampling_bound(alpha, to_eye);
    return ggx_density(alpha, half_vector_between(to_eye, to_light)) /
           (real(2) * (k * to_eye.z + length_stretched_by_alpha(alpha, to_eye)));
}

// Draws a microfacet's normal among those visible to the viewer, which are points on a spherical cap (Dupuy and Benyoub,
// "Sampling Visible GGX Normals with Spherical Caps", 2023). `u` and `v` are uniform in [0, 1). `bound` is 1, or
// visible_normal_sampling_bound for normals that reflect light from above the surface.
INLINE vec3 sample_visible_normal(real alpha, vec3 to_eye, real bound, real u, real v) {
    vec3 stretched = vec3(alpha * to_eye.x, alpha * to_eye.y, to_eye.z) / length_stretched_by_alpha(alpha, to_eye);
    real lowest = bound * stretched.z;
    real angle = real(2) * kPi * u;
    real z = (real(1) - v) * (real(1) + lowest) - lowest;
    real size = sqrt(max(real(0), real(1) - z * z));
    vec3 normal = vec3(size * cos(angle), size * sin(angle), z) + stretched;
    return normalize(vec3(alpha * normal.x, alpha * normal.y, normal.z));
}

// Returns a direction of light, drawn by bounded sampling of the visible normals. `u` and `v` are uniform in [0, 1). The
// direction may lie below the surface, where the lobe is 0.
INLINE vec3 sample_lobe(real alpha, vec3 to_eye, real u, real v) {
    vec3 normal = sample_visible_normal(alpha, to_eye, visible_normal_sampling_bound(alpha, to_eye), u, v);
    return real(2) * dot(to_eye, normal) * normal - to_eye;
}

// Returns the lobe divided by the density with which sample_lobe draws `to_light`: the weight of the radiance that
// arrives from there. Returns 0 below the surface. The distribution cancels, so the weight is finite for each alpha.
INLINE vec3 lobe_sample_weight(real alpha, vec3 f0, vec3 f90, vec3 to_eye, vec3 to_light) {
    if (!(to_eye.z > real(0)) || !(to_light.z > real(0))) return vec3(real(0));
    real k = visible_normal_sampling_bound(alpha, to_eye);
    real weight = real(2) * (k * to_eye.z + length_stretched_by_alpha(alpha, to_eye)) *
                  smith_visibility(alpha, to_eye, to_light) * to_light.z;
    return schlick_fresnel(f0, f90, dot(to_eye, half_vector_between(to_eye, to_light))) * weight;
}

// Computes the albedo of the lobe as f0 * `head_on` + f90 * `grazing`, for a viewer at the angle `cosine` to the normal,
// from the mean weight of edge x edge samples. The lobe is symmetric about the plane of incidence, so one half of the
// samples is enough.
INLINE void lobe_albedo_terms(real alpha, real cosine, int edge, OUT(real) head_on, OUT(real) grazing) {
    vec3 to_eye = vec3(sqrt(max(real(0), real(1) - cosine * cosine)), real(0), cosine);
    vec3 sum = vec3(real(0));
    int half_edge = edge / 2;
    for (int i = 0; i < half_edge * edge; ++i) {
        vec3 to_light = sample_lobe(alpha, to_eye, (real(i % half_edge) + real(0.5)) / real(edge),
                                    (real(i / half_edge) + real(0.5)) / real(edge));
        sum += lobe_sample_weight(alpha, vec3(real(1), real(0), real(0)), vec3(real(0), real(1), real(0)), to_eye,
                                  to_light);
    }
    head_on = sum.x / real(half_edge * edge);
    grazing = sum.y / real(half_edge * edge);
}
