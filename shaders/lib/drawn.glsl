// Data that is constant for one object in one view, passed from vertex to fragment shader as flat inputs. On a software
// driver a vertex shader reads a buffer once for all lanes, but a fragment shader reads it for each lane. A flat input
// costs the fragment shader nothing (docs/performance.md). VERTEX_STAGE selects the outputs of the vertex shader.
#ifndef CATOPTRIC_DRAWN_GLSL
#define CATOPTRIC_DRAWN_GLSL

#include "lib/bindings.glsl"

layout(push_constant, scalar) uniform Push { DrawParameters draw; };

#ifdef VERTEX_STAGE
#define DRAWN(place) layout(location = place) flat out
#else
#define DRAWN(place) layout(location = place) flat in
#endif

// Each location that a fragment shader uses costs time per triangle. Therefore the fourth component of a location holds
// an unrelated number, which the second half of the name describes.
DRAWN(0) vec4 eye_layer;
DRAWN(5) vec4 position_near; // position and near distance of the first light
DRAWN(6) vec4 normal_red;    // normal of the first light; red of the object's albedo
DRAWN(7) vec4 intensity_green;
DRAWN(8) vec4 right_blue;
DRAWN(9) vec4 down_ambient;
DRAWN(10) vec4 forward_faces; // forward axis of the first light; number of shadow faces of a light
DRAWN(11) vec4 emission_kind; // emission of the object; kind of the first light
DRAWN(12) vec3 light_share;   // reach, cos_outer and sharpness of the first light
// Index of the object; its mirror number from 1, or 0 if the object is no mirror; index of its MaterialParameters.
DRAWN(13) uvec3 drawn_numbers;

#ifdef VERTEX_STAGE

// Returns the layer of the view in which the object is drawn, from gl_InstanceIndex. drawn_object_index decodes the
// object.
uint drawn_view_layer() { return uint(gl_InstanceIndex) & ((1u << kInstanceLayerBits) - 1u); }
uint drawn_object_index() { return uint(gl_InstanceIndex) >> kInstanceLayerBits; }

void write_drawn_object(View view, Surface surface) {
    eye_layer = vec4(view.eye, drawn_view_layer());
    drawn_numbers = uvec3(drawn_object_index(), surface.mirror, surface.detail);
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

vec3 camera_position() { return eye_layer.xyz; }
int rendered_view_layer() { return int(eye_layer.w); }
uint drawn_object_index() { return drawn_numbers.x; }
uint drawn_mirror_number() { return drawn_numbers.y; }
uint drawn_material_parameters() { return drawn_numbers.z; }
Surface read_drawn_surface() {
    return Surface(vec3(normal_red.w, intensity_green.w, right_blue.w), emission_kind.xyz,
                   read_surface(drawn_object_index()).reflectance, drawn_mirror_number(), drawn_material_parameters(), vec3(0), 0.0);
}
Light read_first_light() {
    return Light(position_near.xyz, normal_red.xyz, intensity_green.xyz, right_blue.xyz, down_ambient.xyz, forward_faces.xyz,
                 position_near.w, light_share.x, light_share.y, light_share.z, uint(emission_kind.w));
}
float frame_ambient_light() { return down_ambient.w; }
uint shadow_face_count() { return uint(forward_faces.w); }

#endif
#endif
