// What is the same for all that one draw shows of one view, as flat outputs of its vertices. A vertex shader reads
// buffers once for all lanes of a software driver, a fragment shader lane by lane, wherever the place; a flat input
// costs it nothing (docs/performance.md). VERTEX_STAGE: the vertex shader's side.
#ifndef CATOPTRIC_DRAWN_GLSL
#define CATOPTRIC_DRAWN_GLSL

#include "lib/bindings.glsl"

layout(push_constant, scalar) uniform Push { Draw draw; };

#ifdef VERTEX_STAGE
#define DRAWN(place) layout(location = place) flat out
#else
#define DRAWN(place) layout(location = place) flat in
#endif

// Triangles carry each place that a fragment shader uses; the last of four numbers is another thing's.
DRAWN(0) vec4 eye_layer;
DRAWN(5) vec4 position_near; // of the first light, as what follows
DRAWN(6) vec4 normal_red;    // and the albedo of the object
DRAWN(7) vec4 intensity_green;
DRAWN(8) vec4 right_blue;
DRAWN(9) vec4 down_ambient;
DRAWN(10) vec4 forward_faces;        // and the shadow faces of a light
DRAWN(11) vec4 emission_kind; // of the object; of the light
DRAWN(12) vec3 light_share;          // reach, cos_outer, sharpness
DRAWN(13) uvec3 drawn_numbers; // index of the object; number of the mirror that it is, from 1, or 0; of its MaterialParameters

#ifdef VERTEX_STAGE

// The layer that this instance is drawn into, and the object that it shows.
uint drawn_layer() { return uint(gl_InstanceIndex) & ((1u << kLayerBits) - 1u); }
uint drawn_object() { return uint(gl_InstanceIndex) >> kLayerBits; }

void write_drawn(View view, Surface surface) {
    eye_layer = vec4(view.eye, drawn_layer());
    drawn_numbers = uvec3(drawn_object(), surface.mirror, surface.detail);
    Light light = lights[0];
    position_near = vec4(light.position, light.near);
    normal_red = vec4(light.normal, surface.albedo.r);
    intensity_green = vec4(light.intensity, surface.albedo.g);
    right_blue = vec4(light.right, surface.albedo.b);
    down_ambient = vec4(light.down, frame.value.ambient);
    forward_faces = vec4(light.forward, frame.value.shadow_faces);
    emission_kind = vec4(surface.emission, light.kind);
    light_share = vec3(light.reach, light.cos_outer, light.sharpness);
}

#else

vec3 eye() { return eye_layer.xyz; }
int view_layer() { return int(eye_layer.w); }
uint drawn_object() { return drawn_numbers.x; }
uint drawn_mirror() { return drawn_numbers.y; }
uint drawn_detail() { return drawn_numbers.z; }
Surface drawn_surface() {
    return Surface(vec3(normal_red.w, intensity_green.w, right_blue.w), emission_kind.xyz,
                   surface_of(drawn_object()).reflectance, drawn_mirror(), drawn_detail(), vec3(0), 0.0);
}
Light first_light() {
    return Light(position_near.xyz, normal_red.xyz, intensity_green.xyz, right_blue.xyz, down_ambient.xyz, forward_faces.xyz,
                 position_near.w, light_share.x, light_share.y, light_share.z, uint(emission_kind.w));
}
float ambient() { return down_ambient.w; }
uint shadow_face_count() { return uint(forward_faces.w); }

#endif
#endif
