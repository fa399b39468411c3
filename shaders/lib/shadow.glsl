// Shadow map of a point light: a cube of depth faces around it in its own frame, face +Z along the
// light's normal (face -Z is left out when every light is one-sided: nothing is lit there).
#ifndef CATOPTRIC_SHADOW_GLSL
#define CATOPTRIC_SHADOW_GLSL

#include "lib/bindings.glsl"

// Four taps lie within one texel of the looked-up point along each axis. A plane tilted by theta
// against the face then shades itself unless the point is lifted off it by sqrt(2) texels * sin(theta);
// the rest up to 1.5 covers that the texel is a ray, not a column.
const float kLiftTexels = 1.5;
// Stored and looked-up depth are each rounded a few times from the same plane: 2^-20 is 16 roundings.
const float kDepthSlack = 1.0 + 1.0 / 1048576.0;

vec3 in_light_frame(uint light, vec3 v) {
    return vec3(dot(lights[light].right, v), -dot(lights[light].down, v), dot(lights[light].forward, v));
}

// Share of the light that reaches the point, 0 to 1 (2x2 percentage-closer filtering).
float shadow_map_visible(uint light, vec3 position, vec3 normal) {
    vec3 v = in_light_frame(light, position - lights[light].position);
    vec3 n = in_light_frame(light, normal);
    int face = cube_face(v);
    if (uint(face) >= frame.value.shadow_faces) return 0.0;
    float texel = 2.0 * cube_coordinates(face, v).z / float(textureSize(shadow_map, 0).x);
    float cosine = cube_coordinates(face, n).z;
    v += n * (kLiftTexels * texel * sqrt(max(0.0, 1.0 - cosine * cosine)));
    vec3 place = cube_coordinates(face, v);
    float layer = float(light * frame.value.shadow_faces + uint(face));
    return texture(shadow_map, vec4(place.xy / place.z * 0.5 + 0.5, layer, lights[light].near / place.z * kDepthSlack));
}

#endif
