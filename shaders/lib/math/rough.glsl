// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Levels of captures for rough reflections. Level 0 is the capture itself. Level m holds the capture filtered by a lobe
// whose width alpha is 2^(m + 1) times the angle of a texel of the capture. A lobe twice as wide is one level up.

const real kLargestHalf = real(65504); // largest finite 16-bit float

// Returns the angle of a texel in the middle of a cube face, in radians, if the face has `edge` texels along an edge.
INLINE real texel_angle_of_cube_face(real edge) { return kPi / (real(2) * edge); }

// Returns the width alpha of the lobe by which level `level`, from 1, of a capture is filtered.
INLINE real alpha_of_capture_level(real level, real edge) { return real(2) * texel_angle_of_cube_face(edge) * exp2(level); }

// Returns the level whose filter is as wide as a lobe of width `alpha`. Between two levels, the share of the upper level
// makes the mean square width of the mixed filters equal to that of the lobe. Level 0 counts as a filter of no width.
INLINE real capture_level_of_alpha(real alpha, real edge) {
    real in_firsts = alpha / alpha_of_capture_level(real(1), edge);
    if (!(in_firsts > real(1))) return max(real(0), in_firsts * in_firsts);
    real level = floor(log2(in_firsts));
    real above = in_firsts / exp2(level);
    return real(1) + level + (above * above - real(1)) / real(3);
}

// Returns the level of a chain of box-filtered pictures whose boxes are as wide as a lobe of width `alpha`. The half
// width of a reflected GGX lobe at half its height is 1.29 alpha, because the normals' is sqrt(sqrt(2) - 1) alpha. A
// bilinear look-up makes a box one and a half times as wide.
INLINE real box_level_of_alpha(real alpha, real edge) {
    return max(real(0), log2(real(2.57) * alpha / (real(1.5) * texel_angle_of_cube_face(edge))));
}

// Numbers of the distance laws: how the width of a filtered look-up follows from the distance of the reflected surface.
const uint kLawNone = 0u, kLawFrostbite = 1u, kLawSquare = 2u, kLawCone = 3u, kLawExact = 4u;

// Returns the width alpha of the look-up in a capture that shows what a lobe of the roughness `roughness` reflects. A
// capture's filter spreads from the capture's centre, but the lobe spreads from the surface. `ratio` is the distance
// from the surface to the reflected point, divided by the distance from the capture's centre to that point.
// `foreshortening` is the cosine at the reflected point between its normal and the direction to the capture's centre,
// divided by the cosine to the mirror's surface; only kLawExact uses it.
// kLawNone ignores distance. kLawFrostbite: Lagarde and de Rousiers, "Moving Frostbite to PBR", 2014, section 4.9.5.
// kLawSquare is a width in proportion to the distance, up to that of the lobe, as in the screen-space reflections of
// three.js. kLawCone: the lobe's cross section at the reflected point, as it appears from the centre. kLawExact: the
// lobe's solid angle as it appears from the centre, on a reflecting surface of any slope.
INLINE real lookup_alpha_by_distance_law(uint law, real roughness, real ratio, real foreshortening) {
    real alpha = roughness * roughness;
    if (law == kLawFrostbite) {
        real near = clamp(ratio * roughness, real(0), roughness);
        real result = mix(near, roughness, roughness);
        return result * result;
    }
    if (law == kLawSquare) return alpha * min(real(1), ratio);
    if (law == kLawCone) return min(real(1), alpha * ratio);
    if (law == kLawExact) return min(real(1), alpha * ratio * sqrt(foreshortening));
    return alpha;
}

// Returns point `index` of Hammersley's set of `count` points, in [0, 1)^2. The points are evenly spread.
INLINE void hammersley_point(uint index, uint count, OUT(real) u, OUT(real) v) {
    u = (real(index) + real(0.5)) / real(count);
    v = word_to_unit_fraction(reverse_bits_of_word(index));
}

// Returns a direction of light around the normal, drawn from the lobe of a surface that is seen along its normal: the
// mirror image of that view at a normal of the GGX distribution. `u` and `v` are uniform in [0, 1). The density per
// steradian is ggx_density / 4 of the normal half-way.
INLINE vec3 sample_lobe_seen_head_on(real alpha, real u, real v) {
    real cos2 = (real(1) - v) / (real(1) + (alpha * alpha - real(1)) * v);
    real cosine = sqrt(cos2), sine = sqrt(max(real(0), real(1) - cos2)), angle = real(2) * kPi * u;
    return vec3(real(2) * cosine * sine * cos(angle), real(2) * cosine * sine * sin(angle), real(2) * cos2 - real(1));
}
