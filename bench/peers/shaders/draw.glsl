// Uniforms and push constants of all shaders of the capture prototype.
layout(set = 0, binding = 0) uniform Frame {
    mat4 clip_from_scene[30]; // views: the camera, six faces of each mirror's capture, five shadow faces of the light
    vec4 light;               // position of the light; w: ambient light
    vec4 light_normal;        // normal of the light; w: near distance of the shadow faces
    vec4 intensity;
} frame;
layout(push_constant) uniform Push {
    vec4 eye;
    vec4 albedo;      // albedo, or the reflectance of a mirror
    vec4 emission;
    vec4 centre;      // centre of the mirror's capture
    uint first_view;
    float cube;       // index of the cube map that is the mirror's capture
} draw;
