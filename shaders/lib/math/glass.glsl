// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Light at a smooth surface between two dielectrics.

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

// Returns the direction of the light behind the surface (Snell's law). `direction` points to the surface, `normal` to the
// side from which it comes. Both are unit vectors, and the other arguments are those of fresnel_dielectric.
INLINE vec3 refract_direction(vec3 direction, vec3 normal, real cosine, real ratio, real cosine_behind) {
    return normalize(direction / ratio + (cosine / ratio - cosine_behind) * normal);
}
