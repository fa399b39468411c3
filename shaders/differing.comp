// Tests whether a capture that was drawn again equals, bit for bit, the capture of the frame before. Compares colour
// and distance, because captures drawn later read only these two. One invocation compares one texel of one cube face.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20) uniform sampler2DArray colour_before;
layout(set = 0, binding = 21) uniform sampler2DArray colour_after;
layout(set = 0, binding = 22) uniform sampler2DArray distance_before;
layout(set = 0, binding = 23) uniform sampler2DArray distance_after;
layout(set = 0, binding = 24, scalar) buffer Differing { uint differing[]; };
layout(push_constant, scalar) uniform Push { uint first_before, first_after, mirror; };

bool have_equal_pixel_values(vec4 a, vec4 b) { return floatBitsToUint(a) == floatBitsToUint(b); }

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at.xy, textureSize(colour_after, 0).xy)) || differing[mirror] != 0u) return;
    ivec3 before = at + ivec3(0, 0, first_before), after = at + ivec3(0, 0, first_after);
    if (!have_equal_pixel_values(texelFetch(colour_before, before, 0), texelFetch(colour_after, after, 0)) ||
        !have_equal_pixel_values(texelFetch(distance_before, before, 0), texelFetch(distance_after, after, 0)))
        differing[mirror] = 1u; // invocations may write this word at the same time: all write 1
}
