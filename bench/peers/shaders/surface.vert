// Transforms triangles into the faces of a cube map, or into the one layer of the camera's view.
#version 460
#extension GL_ARB_shader_viewport_layer_array : require
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;

void main() {
    gl_Position = frame.clip_from_scene[draw.first_view + gl_InstanceIndex] * vec4(position, 1);
    gl_Layer = gl_InstanceIndex;
    out_position = position;
    out_normal = normal;
}
