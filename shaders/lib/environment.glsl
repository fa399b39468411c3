// The environment: its radiance for rays that leave the scene, and its light on surfaces.
#ifndef CATOPTRIC_ENVIRONMENT_GLSL
#define CATOPTRIC_ENVIRONMENT_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

const uint kNoEnvironment = 0u, kMapEnvironment = 1u, kStudioEnvironment = 2u;
layout(constant_id = ENVIRONMENT_CONSTANT) const uint environment_kind = kNoEnvironment;
layout(set = 0, binding = 28, scalar) uniform SkyBuffer { Sky value; } sky;
TEXEL_LIST(29, sky_texels, vec4, samplerBuffer, false) // the environment map's texels, row by row

vec3 read_sky_texel(uint column, uint row) { return sky_texels_at(row * sky.value.size.x + column).rgb; }

// Returns the environment's radiance in a unit direction.
vec3 environment_radiance(vec3 direction) {
    if (environment_kind == kNoEnvironment) return vec3(0);
    vec3 d = rotate_to_environment_axes(direction, sky.value.turn.x, sky.value.turn.y);
    if (environment_kind == kStudioEnvironment) return vec3(sky.value.scale * studio_radiance(d));
    count_work_once(kWorkTextureLookups);
    EnvironmentMapPosition at = direction_to_environment_map(d, sky.value.size.x, sky.value.size.y);
    return sky.value.scale * mix(mix(read_sky_texel(at.left, at.above), read_sky_texel(at.right, at.above), at.across),
                                 mix(read_sky_texel(at.left, at.below), read_sky_texel(at.right, at.below), at.across), at.down);
}

// Returns the environment's radiance in a unit direction, and the density per steradian with which
// draw_environment_cell_direction draws the direction; 0 if there are no cells.
vec3 environment_radiance_and_density(vec3 direction, out float density) {
    density = 0.0;
    if (environment_kind != kMapEnvironment || sky.value.cell_count == 0u) return environment_radiance(direction);
    vec3 d = rotate_to_environment_axes(direction, sky.value.turn.x, sky.value.turn.y);
    count_work_once(kWorkTextureLookups);
    EnvironmentCell cell = direction_to_environment_cell(d, sky.value.size.x, sky.value.size.y);
    vec3 a = read_sky_texel(cell.left, cell.above), b = read_sky_texel(cell.right, cell.above),
         c = read_sky_texel(cell.left, cell.below), e = read_sky_texel(cell.right, cell.below);
    float mean = dot(a + b + c + e, vec3(0.25));
    density = max(mean - sky.value.cell_threshold, 0.0) * cell.sine_ratio * sky.value.cell_density;
    return sky.value.scale * mix(mix(a, b, cell.across), mix(c, e, cell.across), cell.down);
}

// Draws a unit direction towards the part of the environment that is brighter than its mean (MIS compensation: Karlik et
// al., "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", 2019). `cell` and `alias` are
// uniform in [0, 1) and choose the cell (alias method, as in lib/lamps.glsl); `across` and `down` place the direction in it.
vec3 draw_environment_cell_direction(float cell, float alias, float across, float down) {
    uint i = min(uint(cell * float(sky.value.cell_count)), sky.value.cell_count - 1u);
    vec4 entry = sky_texels_at(sky.value.cell_first + i);
    if (alias >= entry.x) entry = sky_texels_at(sky.value.cell_first + (floatBitsToUint(entry.y) & kBvhIdMask));
    vec3 d = environment_cell_direction(floatBitsToUint(entry.z) & kBvhIdMask, across, down, sky.value.size.x, sky.value.size.y);
    return rotate_to_environment_axes(d, sky.value.turn.x, -sky.value.turn.y);
}

// Returns the radiance in a unit direction of level `level`, from 1, of the environment (Sky::level_first).
vec3 environment_level_radiance(vec3 direction, uint level) {
    uint width = sky.value.level_width[level - 1u], first = sky.value.level_first[level - 1u];
    count_work_once(kWorkTextureLookups);
    vec3 d = rotate_to_environment_axes(direction, sky.value.turn.x, sky.value.turn.y);
    EnvironmentMapPosition at = direction_to_environment_map(d, width, width / 2u);
    uint above = first + at.above * width, below = first + at.below * width;
    return sky.value.scale * mix(mix(sky_texels_at(above + at.left).rgb, sky_texels_at(above + at.right).rgb, at.across),
                                 mix(sky_texels_at(below + at.left).rgb, sky_texels_at(below + at.right).rgb, at.across),
                                 at.down);
}

// Returns the mean radiance that a lobe of this roughness around a unit direction reflects from the environment.
vec3 environment_lobe_radiance(vec3 direction, float roughness) {
    float level = clamp(roughness, 0.0, 1.0) * float(SKY_LEVEL_COUNT);
    uint lower = min(uint(level), SKY_LEVEL_COUNT - 1u);
    vec3 sharper = lower == 0u ? environment_radiance(direction) : environment_level_radiance(direction, lower);
    return mix(sharper, environment_level_radiance(direction, lower + 1u), level - float(lower));
}

// Returns the environment's irradiance on a surface with the given unit normal. Objects do not occlude this light.
vec3 environment_irradiance(vec3 normal) {
    return environment_kind == kNoEnvironment ? vec3(0) : irradiance_from_harmonics(sky.value.irradiance, normal);
}

#endif
