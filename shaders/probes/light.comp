// Computes what light probes give to surfaces from their captures (lib/light_probes.glsl): the irradiance, from nine
// coefficients of spherical harmonics, as a cube map over the normals, and the inverse of distances, which can be
// interpolated. One work group for each probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { LightProbeGrid grid; };
layout(set = 0, binding = 20) uniform sampler2DArray captured; // six faces for each probe
layout(set = 0, binding = 21) uniform sampler2DArray captured_distances;
layout(set = 0, binding = 22, rgba32f) writeonly uniform image2D grid_texels;
layout(set = 0, binding = 23, rgba16f) writeonly uniform image2DArray light;
layout(set = 0, binding = 24, rgba16f) writeonly uniform image2DArray distances;

shared vec3 sums[32][9];
shared float solid_angles[32];
shared vec3 coefficients[9];

// For each harmonic, its squared normalisation factor times the factor of its band in a cosine lobe: pi, 2 pi / 3, pi / 4.
const float kFactors[9] = float[9](0.25, 0.5, 0.5, 0.5, 0.9375, 0.9375, 0.078125, 0.9375, 0.234375);

void main() {
    uint probe = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    int edge = textureSize(captured, 0).x;
    vec3 sum[9];
    for (int i = 0; i < 9; ++i) sum[i] = vec3(0);
    float whole = 0.0;
    uint texels = 6u * uint(edge * edge), texel = lane;
    do {
        int face = int(texel) / (edge * edge), x = int(texel) % edge, y = int(texel) / edge % edge;
        ivec3 at = ivec3(x, y, 6 * int(probe) + face);
        vec2 place = (vec2(x, y) + 0.5) * (2.0 / float(edge)) - 1.0;
        vec3 d = normalize(cube_direction(face, vec3(place, 1.0)));
        float solid_angle = pow(1.0 + dot(place, place), -1.5);
        vec3 radiance = solid_angle * texelFetch(captured, at, 0).rgb;
        float of[9] = float[9](1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y);
        for (int i = 0; i < 9; ++i) sum[i] += of[i] * radiance;
        whole += solid_angle;
        imageStore(distances, at, vec4(min(1.0 / texelFetch(captured_distances, at, 0).r, kLargestHalf), 0, 0, 0));
        texel += 32u;
    } while (texel < texels);
    for (int i = 0; i < 9; ++i) sums[lane][i] = sum[i];
    solid_angles[lane] = whole;
    barrier();
    if (lane < 9u) {
        vec3 all = vec3(0);
        float sphere = 0.0;
        for (int i = 0; i < 32; ++i) {
            all += sums[i][lane];
            sphere += solid_angles[i];
        }
        coefficients[lane] = kFactors[lane] * (4.0 * kPi / sphere) * all;
    }
    barrier();
    for (int i = 0; i < 9; ++i) sum[i] = coefficients[i];
    edge = imageSize(light).x;
    texels = 6u * uint(edge * edge);
    texel = lane;
    do {
        int face = int(texel) / (edge * edge), x = int(texel) % edge, y = int(texel) / edge % edge;
        vec2 place = (vec2(x, y) + 0.5) * (2.0 / float(edge)) - 1.0;
        vec3 irradiance = irradiance_from_harmonics(sum, normalize(cube_direction(face, vec3(place, 1.0))));
        imageStore(light, ivec3(x, y, 6 * int(probe) + face), vec4(min(irradiance, vec3(kLargestHalf)), 1));
        texel += 32u;
    } while (texel < texels);
    if (probe == 0u && lane < 3u) {
        vec3 row = lane == 0u ? grid.first : lane == 1u ? grid.step : vec3(grid.counts);
        imageStore(grid_texels, ivec2(lane, 0), vec4(row, 0));
    }
}
