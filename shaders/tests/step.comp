// Shader of tests/gpu/previous_test.cpp: computes after = 3 * before + (index of the pixel) + number, modulo 2^20, in
// floats that hold whole numbers.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D before;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D after;
layout(push_constant) uniform Push { float number; };

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(after);
    if (any(greaterThanEqual(place, size))) return;
    float x = 3.0 * texelFetch(before, place, 0).r + float(place.x + size.x * place.y) + number;
    imageStore(after, place, vec4(mod(x, 1048576.0)));
}
