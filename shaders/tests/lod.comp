// Shader of tests/gpu/lifetimes_test.cpp: samples the middle of an image at a level of detail.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D before;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D after;
layout(push_constant) uniform Push { float number; };

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, imageSize(after)))) return;
    imageStore(after, place, vec4(textureLod(before, vec2(0.5), number).r));
}
