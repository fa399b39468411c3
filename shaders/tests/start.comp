// Shader of tests/gpu/previous_test.cpp: fills an image with a pattern.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D after;
layout(push_constant) uniform Push { float number; };

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(after);
    if (any(greaterThanEqual(place, size))) return;
    imageStore(after, place, vec4(number * float(1 + place.x + size.x * place.y)));
}
