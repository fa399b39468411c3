// Part of lib/math.glsl, which alone includes it.
// Where a texture's texels are, and how much a sharp surface reflects.

const uint kWrapRepeat = 0u, kWrapMirrored = 1u, kWrapClamp = 2u;

// The texel of an axis with `size` texels that number `i` stands for.
INLINE int wrapped_texel(int i, int size, uint wrap) {
    if (wrap == kWrapClamp) return i < 0 ? 0 : i < size ? i : size - 1;
    int period = wrap == kWrapMirrored ? 2 * size : size;
    i = i % period;
    if (i < 0) i += period;
    return i < size ? i : 2 * size - 1 - i;
}

// A place along an axis, in texels from the outer edge of the first: near enough to 0 to be whole numbers.
INLINE real texel_place(real u, int size, uint wrap) {
    if (wrap == kWrapClamp) return min(max(u, real(-1)), real(2)) * real(size);
    return (u - real(2) * floor(u / real(2))) * real(size);
}

INLINE int nearest_texel(real u, int size, uint wrap) {
    return wrapped_texel(int(floor(texel_place(u, size, wrap))), size, wrap);
}

// The two texels whose centres, (i + .5) / size, lie around u, and the share of the second.
INLINE void texels_around(real u, int size, uint wrap, OUT(int) first, OUT(int) second, OUT(real) share) {
    real place = texel_place(u, size, wrap) - real(0.5);
    real below = floor(place);
    share = place - below;
    first = wrapped_texel(int(below), size, wrap);
    second = wrapped_texel(int(below) + 1, size, wrap);
}

// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering".
INLINE vec3 schlick(vec3 f0, vec3 f90, real cosine) {
    real away = real(1) - min(max(cosine, real(0)), real(1));
    real squared = away * away;
    return f0 + (f90 - f0) * (squared * squared * away);
}
