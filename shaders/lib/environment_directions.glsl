// Random directions to the environment, for its light with shadows (option --environment-shadows). lib/lighting.glsl calls
// the functions of this file. Only lib/whitted.glsl includes it, after the state of the traced path (path_bounce,
// path_sample, path_pixel, path_seed).
#ifndef CATOPTRIC_ENVIRONMENT_DIRECTIONS_GLSL
#define CATOPTRIC_ENVIRONMENT_DIRECTIONS_GLSL

#define DRAWS_ENVIRONMENT_DIRECTIONS
// First dimension of sample_pattern_point for directions to the environment. Each reflection has four.
const uint kEnvironmentDimensions = 0x50000u;

uint environment_direction_count() { return path_bounce <= 1u ? environment_shadows : 1u; }

// Draws direction `i` of environment_direction_count(). If the map has bright cells, every second direction is drawn from
// them and the others by the cosine; both count by the mean of the two densities (one-sample multiple importance sampling).
bool draw_environment_direction(uint i, vec3 normal, out vec3 direction, out vec3 radiance) {
    uint first = kEnvironmentDimensions + 4u * path_bounce, count = environment_direction_count(), index = path_sample * count + i;
    float u, v;
    bool has_cells = environment_kind == kMapEnvironment && sky.value.cell_count > 0u, is_of_cell = false;
    if (has_cells) {
        // A random start makes each direction of either kind with probability 1/2, so that few directions have no bias.
        sample_pattern_point(path_pixel, 0u, first, path_seed, u, v);
        if (u < 0.5) ++index;
        is_of_cell = (index & 1u) != 0u;
        index >>= 1;
    }
    if (is_of_cell) {
        float across, down;
        sample_pattern_point(path_pixel, index, first + 1u, path_seed, u, v);
        sample_pattern_point(path_pixel, index, first + 2u, path_seed, across, down);
        direction = draw_environment_cell_direction(u, v, across, down);
    } else {
        sample_pattern_point(path_pixel, index, first + 3u, path_seed, u, v);
        direction = sample_cosine(normal, u, v);
    }
    float cosine = dot(normal, direction), density;
    radiance = environment_radiance_and_density(direction, density);
    density = has_cells ? 0.5 * (max(cosine, 0.0) / kPi + density) : max(cosine, 0.0) / kPi;
    radiance *= cosine / (density * float(count));
    return cosine > 0.0 && density > 0.0;
}

#endif
