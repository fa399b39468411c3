// Computes the visible share of the environment in each pixel from the solid angles of the pixels around it that show the
// same surface (occlusion/share.comp). The pixels at the sides of a block of 5x5 count by half, so that each pixel of the
// 4x4 pattern of slices counts once.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "occlusion/surfaces.glsl"

layout(set = 0, binding = 21) uniform sampler2D solid_angles;
layout(set = 0, binding = 22, r32f) writeonly uniform image2D shares;

// Cosine between the normals of a surface that counts fully, and of one that does not count.
const float kSameNormal = 0.95, kOtherNormal = 0.8;
// Height above the tangent plane, in pixels at the distance of the surface, above which another surface does not count.
const float kMaxHeight = 2.0;

void main() {
    prepare_camera_view();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= picture_size.x || pixel.y >= picture_size.y) return;
    SeenSurface surface = read_seen_surface(pixel);
    float share = 1.0;
    if (surface.exists) {
        float size = max(length(pixel_across), length(pixel_down));
        if (orthographic == 0u) size *= dot(camera_view.forward, surface.position);
        vec2 sum = vec2(0);
        int place = 0;
        do {
            ivec2 step = ivec2(place % 5, place / 5) - 2, at = pixel + step;
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, picture_size))) continue;
            SeenSurface other = read_seen_surface(at);
            if (!other.exists) continue;
            float weight = (abs(step.x) == 2 ? 0.5 : 1.0) * (abs(step.y) == 2 ? 0.5 : 1.0);
            weight *= smoothstep(kOtherNormal, kSameNormal, dot(surface.normal, other.normal));
            weight *= clamp(2.0 - abs(dot(other.position - surface.position, surface.normal)) * (2.0 / (kMaxHeight * size)), 0.0, 1.0);
            if (!(weight > 0.0)) continue;
            count_work_once(kWorkTextureLookups);
            sum += weight * texelFetch(solid_angles, at, 0).xy;
        } while (++place < 25);
        if (sum.y > 0.0) share = clamp(sum.x / sum.y, 0.0, 1.0);
    }
    imageStore(shares, pixel, vec4(share));
}
