// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Light at a surface between two dielectrics.

// Returns the share of unpolarised light that the surface reflects (Fresnel's equations). `cosine` is that of the angle of
// incidence, 0 to 1. `ratio` is the index of refraction behind the surface divided by the one before it. Computes the
// cosine behind the surface, or 0 if all light is reflected.
INLINE real fresnel_dielectric(real cosine, real ratio, OUT(real) cosine_behind) {
    real square = real(1) - (real(1) - cosine * cosine) / (ratio * ratio);
    cosine_behind = real(0);
    if (!(square > real(0))) return real(1);
    cosine_behind = sqrt(square);
    real across = (cosine - ratio * cosine_behind) / (cosine + ratio * cosine_behind);
    real along = (ratio * cosine - cosine_behind) / (ratio * cosine + cosine_behind);
    return real(0.5) * (across * across + along * along);
}

// Returns the share of light that a sheet of glass reflects whose two surfaces each reflect this share: r + (1 - r)^2 r (1 +
// r^2 + r^4 + ...). The rest passes.
INLINE real sheet_reflectance(real surface) { return real(2) * surface / (real(1) + surface); }

// Returns the direction of the light behind the surface (Snell's law). `direction` points to the surface, `normal` to the
// side from which it comes. Both are unit vectors, and the other arguments are those of fresnel_dielectric.
INLINE vec3 refract_direction(vec3 direction, vec3 normal, real cosine, real ratio, real cosine_behind) {
    return normalize(direction / ratio + (cosine / ratio - cosine_behind) * normal);
}

// Rough glass consists of microfacets, each a smooth surface, whose normals have the density of a rough mirror's (Walter et
// al., "Microfacet Models for Refraction through Rough Surfaces", 2007). Cosines are between the mean normal and a direction.

// Returns the length of a unit direction that is stretched by alpha along the surface.
INLINE real stretched_length_of_cosine(real alpha, real cosine) {
    return sqrt(alpha * alpha * (real(1) - cosine * cosine) + cosine * cosine);
}

// Returns the share of visible microfacets whose reflected light no others block: G2 / G1 of height-correlated Smith masking.
INLINE real unblocked_reflected_share(real alpha, real eye_cosine, real light_cosine) {
    if (!(eye_cosine > real(0)) || !(light_cosine > real(0))) return real(0);
    real eye = stretched_length_of_cosine(alpha, eye_cosine), light = stretched_length_of_cosine(alpha, light_cosine);
    return light_cosine * (eye_cosine + eye) / (light_cosine * eye + eye_cosine * light);
}

// Returns the share of light behind the surface, at that positive cosine to the inner normal, that no microfacets block: G1.
INLINE real unblocked_passing_share(real alpha, real behind_cosine) {
    if (!(behind_cosine > real(0))) return real(0);
    return real(2) * behind_cosine / (behind_cosine + stretched_length_of_cosine(alpha, behind_cosine));
}
