// The vertex shader of every raster pass. Transforms triangles into the view of a layer. gl_InstanceIndex encodes the
// layer and the object. LAYERED writes gl_Layer; without LAYERED the pass draws one layer at a time. PLACED reads
// vertices in object space. CLIPPED clips triangles at the view's clip plane.
#ifndef CATOPTRIC_VERTEX_GLSL
#define CATOPTRIC_VERTEX_GLSL

#define VERTEX_STAGE
#include "lib/drawn.glsl"
#include "lib/eye.glsl"
#include "lib/material.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_from_eye;
layout(location = 3) out vec4 out_uv;
layout(location = 4) out vec4 out_colour;

invariant gl_Position;

#ifdef PLACED
layout(set = 0, binding = PLACEMENTS_BINDING, scalar) readonly buffer Placements { Placement placements[]; };

// Transforms a normal from object space to the scene by the matrix's cofactors. The matrix is scaled first, so that
// small objects do not underflow.
vec3 transform_normal_to_scene(Placement placement, vec3 n) {
    float size = max(largest_vector_component(abs(placement.x)), max(largest_vector_component(abs(placement.y)), largest_vector_component(abs(placement.z))));
    vec3 x = placement.x / size, y = placement.y / size, z = placement.z / size;
    vec3 turned = n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y);
    return normalize(dot(x, cross(y, z)) < 0.0 ? -turned : turned);
}
#endif

void main() {
    View view = views[draw.first_view + drawn_view_layer()];
    Surface surface = read_surface(drawn_object_index());
#ifdef PLACED
    Placement placement = placements[drawn_object_index()];
    vec3 from_eye = subtract_split_vectors(placement.centre, placement.centre_low, view.eye, view.eye_low);
    vec3 v = from_eye + (placement.x * position.x + placement.y * position.y + placement.z * position.z);
#else
    vec3 v = position - view.eye;
#endif
    float along = dot(view.forward, v);
    gl_Position = vec4(dot(view.right, v), dot(view.down, v), view.near, along);
    if (orthographic != 0u) gl_Position.zw = vec2(1.0 - view.near * along, 1.0);
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(view.clip.xyz, v) + view.clip.w;
#endif
#ifdef LAYERED
    gl_Layer = int(drawn_view_layer());
#endif
    write_drawn_object(view, surface);
#ifdef PLACED
    out_normal = transform_normal_to_scene(placement, normal);
#else
    out_normal = normal;
#endif
    out_from_eye = v;
    VertexAttribute at = kNoAttribute;
    if (details != 0u && (read_material_parameters(surface.detail).flags & kMaterialHasAttributesFlag) != 0u)
        at = read_vertex_attribute(uint(gl_VertexIndex) + read_material_parameters(surface.detail).first_attribute);
    out_uv = at.uv;
    out_colour = at.colour;
}

#endif
