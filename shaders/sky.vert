// Draws the environment as one triangle that covers the whole picture behind all surfaces.
#version 460
#ifdef LAYERED
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#extension GL_GOOGLE_include_directive : require
#define VERTEX_STAGE
#include "lib/drawn.glsl"
#include "lib/eye.glsl"

layout(location = 0) in vec3 corner; // triangle corner in clip space; the picture reaches from -1 to 1
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_from_eye;
layout(location = 3) out vec4 out_uv;
layout(location = 4) out vec4 out_colour;

const float kSkyDepth = 1e-36; // reversed depth behind all surfaces, but in front of the clear value 0

void main() {
    View view = views[draw.first_view + drawn_view_layer()];
    gl_Position = vec4(corner.xy, kSkyDepth, 1);
#ifdef LAYERED
    gl_Layer = int(drawn_view_layer());
#endif
    write_drawn_object(view, Surface(vec3(0), vec3(0), vec3(0), 0u, 0u, vec3(0), 0.0));
    out_normal = vec3(0);
    out_from_eye = view.forward;
    if (orthographic == 0u)
        out_from_eye += corner.x * view.right / dot(view.right, view.right) + corner.y * view.down / dot(view.down, view.down);
    out_uv = vec4(0);
    out_colour = vec4(1);
}
