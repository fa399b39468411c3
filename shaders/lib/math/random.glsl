// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Random numbers that are a function of pixel, sample, dimension and seed, so that no order of the work changes them.

// Mixes four words so that each bit of the results depends on all words (PCG4D: Jarzynski and Olano, "Hash Functions for
// GPU Rendering", 2020).
INLINE void hash_four_words(INOUT(uint) a, INOUT(uint) b, INOUT(uint) c, INOUT(uint) d) {
    a = a * 1664525u + 1013904223u;
    b = b * 1664525u + 1013904223u;
    c = c * 1664525u + 1013904223u;
    d = d * 1664525u + 1013904223u;
    a += b * d;
    b += c * a;
    c += a * b;
    d += b * c;
    a ^= a >> 16u;
    b ^= b >> 16u;
    c ^= c >> 16u;
    d ^= d >> 16u;
    a += b * d;
    b += c * a;
    c += a * b;
    d += b * c;
}

// Returns a word whose bits are in reverse order.
INLINE uint reverse_bits_of_word(uint x) {
    x = (x >> 1u & 0x55555555u) | (x & 0x55555555u) << 1u;
    x = (x >> 2u & 0x33333333u) | (x & 0x33333333u) << 2u;
    x = (x >> 4u & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4u;
    x = (x >> 8u & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8u;
    return x >> 16u | x << 16u;
}

// Scrambles the bits of a point's coordinate so that each bit depends on all higher bits, which keeps the point set's
// stratification (Owen's nested uniform scrambling by a hash: Burley, "Practical Hash-based Owen Scrambling", 2020).
INLINE uint owen_scramble(uint x, uint seed) {
    x = reverse_bits_of_word(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16u | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits_of_word(x);
}

// Returns the second coordinate of point `index` of Sobol's sequence, as a fraction of 2^32. The first coordinate is
// reverse_bits_of_word(index).
INLINE uint sobol_second_dimension(uint index) {
    uint result = 0u, direction = 0x80000000u;
    while (index != 0u) {
        if ((index & 1u) != 0u) result ^= direction;
        index >>= 1u;
        direction ^= direction >> 1u;
    }
    return result;
}

// Converts a word to a number in [0, 1) by its upper 24 bits, which a float holds exactly.
INLINE real word_to_unit_fraction(uint word) { return real(word >> 8u) * (real(1) / real(16777216)); }

// Computes point `sample_index` of the sample pattern of a pixel, in [0, 1)^2. Each pair of dimensions has a pattern of
// its own, Owen-scrambled points of Sobol's sequence in an order of its own. The first 2^k points of each pattern have
// one point in each elementary interval of area 2^-k. `pixel` is any number that differs from pixel to pixel.
INLINE void sample_pattern_point(uint pixel, uint sample_index, uint dimension_pair, uint seed, OUT(real) u, OUT(real) v) {
    uint a = pixel, b = dimension_pair, c = seed, d = 0x9e3779b9u;
    hash_four_words(a, b, c, d);
    uint index = owen_scramble(sample_index, a);
    u = word_to_unit_fraction(owen_scramble(reverse_bits_of_word(index), b));
    v = word_to_unit_fraction(owen_scramble(sobol_second_dimension(index), c));
}
