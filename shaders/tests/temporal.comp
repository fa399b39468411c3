// Shader of tests/reflect/temporal_test.cpp: the mean of the frames that showed the surface of a pixel. The surface is found
// in the last frame by its place in the last view.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D traced;
layout(set = 0, binding = 1) uniform sampler2D normals_and_distances;
layout(set = 0, binding = 2) uniform sampler2D history; // alpha: number of frames in the mean
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2D mean;

struct Eye {
    vec3 place, right, down, forward; // as in View of shared.h
};
layout(push_constant, scalar) uniform Push { Eye now, before; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(mean);
    if (any(greaterThanEqual(pixel, size))) return;
    vec3 colour = texelFetch(traced, pixel, 0).rgb;
    float distance = texelFetch(normals_and_distances, pixel, 0).w, count = 1.0;
    vec2 seen = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec3 direction = normalize(now.forward + seen.x * now.right / dot(now.right, now.right) +
                               seen.y * now.down / dot(now.down, now.down));
    vec3 from_before = now.place + distance * direction - before.place;
    float depth = dot(from_before, before.forward);
    if (distance > 0.0 && depth > 0.0) {
        vec2 place = vec2(dot(from_before, before.right), dot(from_before, before.down)) / depth * 0.5 + 0.5;
        if (all(greaterThanEqual(place, vec2(0))) && all(lessThan(place, vec2(1)))) {
            vec4 last = texelFetch(history, ivec2(place * vec2(size)), 0);
            count = last.a + 1.0;
            colour = mix(last.rgb, colour, 1.0 / count);
        }
    }
    imageStore(mean, pixel, vec4(colour, count));
}
