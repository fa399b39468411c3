// What all shaders of the prototype with captures see.
layout(set = 0, binding = 0) uniform Frame {
    mat4 clip_from_scene[30]; // camera, six faces of each mirror, five of the light
    vec4 light;               // ambient
    vec4 light_normal;        // near plane of its faces
    vec4 intensity;
} frame;
layout(push_constant) uniform Push {
    vec4 eye;
    vec4 albedo;      // of a mirror its reflectance
    vec4 emission;
    vec4 centre;      // of the mirror's capture
    uint first_view;
    float cube;       // that shows what the mirror shows
} draw;
