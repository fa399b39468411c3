// Light on surfaces, looked up in light probes: small captures at the points of a grid, each of which gives the
// irradiance at its place (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
// A surface takes the mean of the eight probes around it, weighted by distance, by the side of the surface on which they
// lie, and by whether they see it (Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", 2019). engine/render/light_probes.cpp draws the captures.
#ifndef CATOPTRIC_LIGHT_PROBES_GLSL
#define CATOPTRIC_LIGHT_PROBES_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"
#include "lib/environment.glsl"

// What light probes show: 0 (there are none), kLightProbesOfSurfaces or kLightProbesOfEnvironment.
layout(constant_id = LIGHT_PROBE_CONTENT_CONSTANT) const uint light_probe_content = 0u;
// The grid of light probes, a LightProbeGrid. All values are 0 in the first frame, in which no probe has been drawn
// yet.
layout(set = 0, binding = 34) uniform sampler2D probe_grid;
layout(set = 0, binding = 35) uniform samplerCubeArray probe_light;     // by the surface's normal: irradiance at each probe; visible share
layout(set = 0, binding = 36) uniform samplerCubeArray probe_distances; // 1 / distance from each probe, scene units; 0: sky

LightProbeGrid read_light_probe_grid() {
    return LightProbeGrid(texelFetch(probe_grid, ivec2(0, 0), 0).xyz, texelFetch(probe_grid, ivec2(1, 0), 0).xyz,
                          uvec3(texelFetch(probe_grid, ivec2(2, 0), 0).xyz));
}

uint light_probe_index(LightProbeGrid grid, uvec3 place) { return place.x + grid.counts.x * (place.y + grid.counts.y * place.z); }

vec4 light_at_light_probe(uint probe, vec3 normal) {
    count_work_once(kWorkColourLookups);
    return textureLod(probe_light, vec4(normal, float(probe)), 0.0);
}

// Returns how well the probe at `centre` sees the surface point, 0 to 1, times the cosine between the normal and the
// direction to the probe. Returns 0 if the probe lies behind the surface.
float light_probe_sight(uint probe, vec3 centre, vec3 position, vec3 normal) {
    vec3 to_point = position - centre;
    float height = -dot(to_point, normal), distance = length(to_point);
    if (!(height > 0.0)) return 0.0; // a probe in front of the surface also has a distance above 0
    float cosine = height / distance;
    // The inverse distance of a plane is the cosine of an angle, which is nearly linear between texels. At the outline of
    // an object the mean of inverses is near the smaller distance, which keeps light out rather than in. Beside the sky,
    // whose inverse distance is 0, the mean lets light in.
    float nearness = distance * textureLod(probe_distances, vec4(to_point, float(probe)), 0.0).r;
    const float kSlack = 0.02; // ten times the error of the interpolation, (texel angle)^2 / 8
    return cosine * (1.0 - smoothstep(1.0 + kSlack, 1.0 + 2.0 * kSlack, nearness));
}

// Returns whether the probe belongs to the layer around the scene's bounds, which only scenes with an environment have
// (make_probe_grid).
bool is_outer_light_probe(LightProbeGrid grid, uvec3 place) {
    return environment_kind != kNoEnvironment && (any(equal(place, uvec3(0))) || any(equal(place, grid.counts - 1u)));
}

// A weighted sum of the light at light probes that see a surface point.
struct LightProbeSum {
    vec4 light;
    float weight;
};

// Adds the light of a probe, weighted by `weight` and by how well the probe sees the surface point.
void add_light_of_probe(inout LightProbeSum sum, LightProbeGrid grid, uvec3 place, float weight, vec3 position, vec3 normal) {
    uint probe = light_probe_index(grid, place);
    float sight = light_probe_sight(probe, grid.first + vec3(place) * grid.step, position, normal);
    const float kLeastSight = 1e-3; // of a probe that is seen 0.06 degrees above the surface; rounding decides below
    if (!(sight > kLeastSight)) return;
    sum.light += weight * sight * light_at_light_probe(probe, normal);
    sum.weight += weight * sight;
}

// Returns the sum over the outer, or the other, of the eight probes around the point. Their weights are those of trilinear
// interpolation.
LightProbeSum sum_nearest_light_probes(LightProbeGrid grid, bool outer, vec3 position, vec3 normal) {
    vec3 cell = (position - grid.first) / grid.step;
    vec3 low = clamp(floor(cell), vec3(0), vec3(grid.counts) - 2.0);
    vec3 within = clamp(cell - low, vec3(0), vec3(1));
    LightProbeSum sum = LightProbeSum(vec4(0), 0.0);
    uint corner = 0u;
    do {
        uvec3 offset = uvec3(corner & 1u, corner >> 1u & 1u, corner >> 2u), place = uvec3(low) + offset;
        vec3 near = mix(1.0 - within, within, vec3(offset));
        float weight = near.x * near.y * near.z;
        if (weight > 0.0 && is_outer_light_probe(grid, place) == outer) add_light_of_probe(sum, grid, place, weight, position, normal);
    } while (++corner < 8u);
    return sum;
}

// Returns the sum over all outer, or all other, probes. Nearer probes count more.
LightProbeSum sum_all_light_probes(LightProbeGrid grid, bool outer, vec3 position, vec3 normal) {
    LightProbeSum sum = LightProbeSum(vec4(0), 0.0);
    uint probe = 0u, count = grid.counts.x * grid.counts.y * grid.counts.z;
    do {
        uvec3 place = uvec3(probe % grid.counts.x, probe / grid.counts.x % grid.counts.y, probe / (grid.counts.x * grid.counts.y));
        if (is_outer_light_probe(grid, place) != outer) continue;
        vec3 away = (position - grid.first) / grid.step - vec3(place);
        const float kLeastSquare = 1e-6; // probes nearer than a thousandth of a cell count alike
        float square = max(dot(away, away), kLeastSquare);
        add_light_of_probe(sum, grid, place, 1.0 / (square * square), position, normal);
    } while (++probe < count);
    return sum;
}

// Returns the irradiance at a surface point with the unit normal `normal`: from other surfaces and the environment, or from
// the environment alone. Returns in w the visible share of the environment (kLightProbesOfEnvironment only). If none of the
// eight probes around the point sees the point, all probes are asked. Outer probes count only if no other probe sees the
// point. At the outline of a closed room, their captured distances are interpolated between the room and the sky behind it,
// and walls inside the room then seem visible. Returns 0 if no probe sees the point.
vec4 interpolate_light_probes(vec3 position, vec3 normal) {
    LightProbeGrid grid = read_light_probe_grid();
    if (grid.counts.x == 0u) return vec4(0);
    // Share of the weights that all eight probes have if they see the surface head-on. Below this share, single texels
    // at the outlines of objects would decide the result.
    const float kLeastWeight = 1e-3;
    bool outer = false;
    do {
        LightProbeSum sum = sum_nearest_light_probes(grid, outer, position, normal);
        if (!(sum.weight > kLeastWeight)) sum = sum_all_light_probes(grid, outer, position, normal);
        if (sum.weight > 0.0) return sum.light / sum.weight;
        outer = !outer;
    } while (outer && environment_kind != kNoEnvironment);
    return vec4(0);
}

#endif
