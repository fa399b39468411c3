// Computes what light probes give to surfaces from their captures (lib/light_probes.glsl): the irradiance, from nine
// coefficients of spherical harmonics, as a cube map over the normals, and the inverse of distances, which can be
// interpolated. Probes of the environment count no light of surfaces, and store the visible share of a white environment
// beside the irradiance. One work group for each probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"

layout(local_size_x = 32) in;
// kLightProbesOfSurfaces or kLightProbesOfEnvironment.
layout(constant_id = LIGHT_PROBE_CONTENT_CONSTANT) const uint light_probe_content = kLightProbesOfSurfaces;
layout(push_constant, scalar) uniform Push {
    LightProbeGrid grid;
    float radius; // surfaces farther from a probe hide no ambient light, scene units
};
layout(set = 0, binding = 20) uniform sampler2DArray captured; // six faces for each probe
layout(set = 0, binding = 21) uniform sampler2DArray captured_distances;
layout(set = 0, binding = 22, rgba32f) writeonly uniform image2D grid_texels;
layout(set = 0, binding = 23, rgba16f) writeonly uniform image2DArray light;
layout(set = 0, binding = 24, rgba16f) writeonly uniform image2DArray distances;

shared vec4 sums[32][9];
shared float solid_angles[32];
shared vec4 coefficients[9];

// For each harmonic, its squared normalisation factor times the factor of its band in a cosine lobe: pi, 2 pi / 3, pi / 4.
const float kFactors[9] = float[9](0.25, 0.5, 0.5, 0.5, 0.9375, 0.9375, 0.078125, 0.9375, 0.234375);

// Part of the radius within which surfaces hide ambient light fully.
const float kFullRadius = 0.5;

void main() {
    uint probe = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    int edge = textureSize(captured, 0).x;
    vec4 sum[9];
    for (int i = 0; i < 9; ++i) sum[i] = vec4(0);
    float whole = 0.0;
    uint texels = 6u * uint(edge * edge), texel = lane;
    do {
        int face = int(texel) / (edge * edge), x = int(texel) % edge, y = int(texel) / edge % edge;
        ivec3 at = ivec3(x, y, 6 * int(probe) + face);
        vec2 place = (vec2(x, y) + 0.5) * (2.0 / float(edge)) - 1.0;
        vec3 d = normalize(cube_direction(face, vec3(place, 1.0)));
        float solid_angle = pow(1.0 + dot(place, place), -1.5);
        float distance = texelFetch(captured_distances, at, 0).r;
        vec4 radiance = solid_angle * vec4(texelFetch(captured, at, 0).rgb, 1);
        if (light_probe_content == kLightProbesOfEnvironment) {
            if (distance < kLargestFloat) radiance.rgb = vec3(0);
            radiance.w *= clamp((distance / radius - kFullRadius) / (1.0 - kFullRadius), 0.0, 1.0);
        }
        float of[9] = float[9](1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y);
        for (int i = 0; i < 9; ++i) sum[i] += of[i] * radiance;
        whole += solid_angle;
        imageStore(distances, at, vec4(min(1.0 / distance, kLargestHalf), 0, 0, 0));
        texel += 32u;
    } while (texel < texels);
    for (int i = 0; i < 9; ++i) sums[lane][i] = sum[i];
    solid_angles[lane] = whole;
    barrier();
    if (lane < 9u) {
        vec4 all = vec4(0);
        float sphere = 0.0;
        for (int i = 0; i < 32; ++i) {
            all += sums[i][lane];
            sphere += solid_angles[i];
        }
        coefficients[lane] = kFactors[lane] * (4.0 * kPi / sphere) * all;
    }
    barrier();
    vec3 of_light[9], of_share[9];
    for (int i = 0; i < 9; ++i) {
        of_light[i] = coefficients[i].rgb;
        of_share[i] = coefficients[i].www;
    }
    edge = imageSize(light).x;
    texels = 6u * uint(edge * edge);
    texel = lane;
    do {
        int face = int(texel) / (edge * edge), x = int(texel) % edge, y = int(texel) / edge % edge;
        vec2 place = (vec2(x, y) + 0.5) * (2.0 / float(edge)) - 1.0;
        vec3 normal = normalize(cube_direction(face, vec3(place, 1.0))), irradiance = irradiance_from_harmonics(of_light, normal);
        float share = 1.0;
        if (light_probe_content == kLightProbesOfEnvironment) share = min(irradiance_from_harmonics(of_share, normal).r / kPi, 1.0);
        imageStore(light, ivec3(x, y, 6 * int(probe) + face), vec4(min(irradiance, vec3(kLargestHalf)), share));
        texel += 32u;
    } while (texel < texels);
    if (probe == 0u && lane < 3u) {
        vec3 row = lane == 0u ? grid.first : lane == 1u ? grid.step : vec3(grid.counts);
        imageStore(grid_texels, ivec2(lane, 0), vec4(row, 0));
    }
}
