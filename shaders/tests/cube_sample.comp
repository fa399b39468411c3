// Shader of tests/gpu/cube_face_test.cpp: samples the colour and distance cubes of a mirror (w) in a direction (xyz).
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform samplerCubeArray colour_cubes;
layout(set = 0, binding = 1) uniform samplerCubeArray distance_cubes;
layout(set = 0, binding = 2, std430) readonly buffer Directions { vec4 directions[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Found { vec4 found[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= directions.length()) return;
    found[i] = vec4(textureLod(colour_cubes, directions[i], 0).rgb, textureLod(distance_cubes, directions[i], 0).r);
}
