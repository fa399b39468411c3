// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Mathematics of texture coordinates and of Fresnel reflectance.

const uint kWrapRepeat = 0u, kWrapMirrored = 1u, kWrapClamp = 2u;

// Returns the texel index, 0 to size - 1, to which the wrap mode maps the index `i` of an axis with `size` texels. `i`
// is -1 or more, or any number if a coordinate is not finite. The remainder of a negative number is undefined in GLSL,
// so the function takes the remainder of an unsigned number.
INLINE int wrap_texel_index_by_mode(int i, int size, uint wrap) {
    if (wrap == kWrapClamp) return i < 0 ? 0 : i < size ? i : size - 1;
    int period = wrap == kWrapMirrored ? 2 * size : size;
    i = int((uint(i) + uint(period)) % uint(period));
    return i < size ? i : 2 * size - 1 - i;
}

// Converts a texture coordinate to texels from the outer edge of the first texel. The result is wrapped or clamped, so
// that it is small enough to convert to an integer.
INLINE real texel_position_of_coordinate(real u, int size, uint wrap) {
    if (wrap == kWrapClamp) return min(max(u, real(-1)), real(2)) * real(size);
    return (u - real(2) * floor(u / real(2))) * real(size);
}

INLINE int nearest_texel_index(real u, int size, uint wrap) {
    return wrap_texel_index_by_mode(int(floor(texel_position_of_coordinate(u, size, wrap))), size, wrap);
}

// Computes the two texels whose centres (i + .5) / size lie on both sides of `u`, and the weight of the second texel.
INLINE void find_bilinear_texels(real u, int size, uint wrap, OUT(int) first, OUT(int) second, OUT(real) share) {
    real place = texel_position_of_coordinate(u, size, wrap) - real(0.5);
    real below = floor(place);
    share = place - below;
    first = wrap_texel_index_by_mode(int(below), size, wrap);
    second = wrap_texel_index_by_mode(int(below) + 1, size, wrap);
}

// Returns Schlick's approximation of the Fresnel reflectance ("An Inexpensive BRDF Model for Physically-based
// Rendering", 1994).
INLINE vec3 schlick_fresnel(vec3 f0, vec3 f90, real cosine) {
    real away = real(1) - min(max(cosine, real(0)), real(1));
    real squared = away * away;
    return f0 + (f90 - f0) * (squared * squared * away);
}
