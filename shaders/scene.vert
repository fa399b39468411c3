// Every raster pass: world triangles into the view of this layer. With LAYERED the layer is written
// here; otherwise the pass draws one layer at a time. gl_InstanceIndex is the layer either way.
#version 460
#ifdef LAYERED
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"

layout(push_constant, scalar) uniform Push { Draw draw; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) flat out vec3 out_eye;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_from_eye;
layout(location = 3) flat out uint out_layer;

invariant gl_Position;

void main() {
    View view = views[draw.first_view + gl_InstanceIndex];
    vec3 v = position - view.eye;
    gl_Position = vec4(dot(view.right, v), dot(view.down, v), view.near, dot(view.forward, v));
#ifdef LAYERED
    gl_Layer = gl_InstanceIndex;
#endif
    out_eye = view.eye;
    out_normal = normal;
    out_from_eye = v;
    out_layer = uint(gl_InstanceIndex);
}
