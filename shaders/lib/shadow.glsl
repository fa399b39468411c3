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

// Share of the light that reaches the point, 0 to 1 (2x2 percentage-closer filtering).
float shadow_map_visible(uint light, vec3 position, vec3 normal) {
    uint first = frame.value.first_shadow_view + light * frame.value.shadow_faces;
    View main = views[first + 4u];
    vec3 v = position - main.eye;
    int face = cube_face(vec3(dot(main.right, v), -dot(main.down, v), dot(main.forward, v)));
    if (uint(face) >= frame.value.shadow_faces) return 0.0;
    View view = views[first + uint(face)];
    float texel = 2.0 * dot(view.forward, v) / float(textureSize(shadow_map, 0).x);
    float cosine = dot(normal, view.forward);
    v += normal * (kLiftTexels * texel * sqrt(max(0.0, 1.0 - cosine * cosine)));
    float along = dot(view.forward, v);
    vec2 place = vec2(dot(view.right, v), dot(view.down, v)) / along * 0.5 + 0.5;
    float layer = float(light * frame.value.shadow_faces + uint(face));
    return texture(shadow_map, vec4(place, layer, view.near / along * kDepthSlack));
}

#endif
