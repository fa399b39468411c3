// Shadow map of a point light: a cube of depth faces around it in its own frame, face +Z along the
// light's normal (face -Z is left out when every light is one-sided: nothing is lit there).
#ifndef CATOPTRIC_SHADOW_GLSL
#define CATOPTRIC_SHADOW_GLSL

#include "lib/bindings.glsl"
#include "lib/lights.glsl"

// Four taps lie within one texel of the looked-up point along each axis. A plane tilted by theta
// against the face then shades itself unless the point is lifted off it by sqrt(2) texels * sin(theta);
// the rest up to 1.5 covers that the texel is a ray, not a column.
const float kLiftTexels = 1.5;
// Depth is interpolated, too: it is off by some roundings of the largest depth that the receiver's plane has in the
// face. 2^-20 is 16 of them.
const float kDepthError = 1.0 / 1048576.0;

vec3 in_light_frame(uint light, vec3 v) {
    return vec3(dot(light_at(light).right, v), -dot(light_at(light).down, v), dot(light_at(light).forward, v));
}

// The same of a directional light: two windows of its map around one axis, the second over all that casts a shadow.
float parallel_map_visible(uint light, vec3 position, vec3 normal, float error) {
    float edge = float(textureSize(shadow_map, 0).x);
    for (uint window = 0u; window < 2u; ++window) {
        View view = views[1u + 6u * frame.value.mirror_count + shadow_face_count() * light + window];
        float texel = 2.0 / (edge * min(length(view.right), length(view.down)));
        float cosine = dot(normal, view.forward), sine = sqrt(max(0.0, 1.0 - cosine * cosine));
        vec3 v = position - view.eye + normal * (kLiftTexels * texel * sine + error);
        vec2 place = vec2(dot(view.right, v), dot(view.down, v));
        if (max(abs(place.x), abs(place.y)) > 1.0 - 2.0 / edge) continue;
        // By as much depth as the receiver's plane has in the window: that is interpolated.
        float slack = kDepthError * (1.0 + view.near * edge * texel * sine / max(abs(cosine), kDepthError));
        float depth = 1.0 - view.near * dot(view.forward, v) + slack;
        return texture(shadow_map, vec4(place * 0.5 + 0.5, float(light * shadow_face_count() + window), depth));
    }
    return 1.0;
}

// Share of the light that reaches the point, 0 to 1 (2x2 percentage-closer filtering). `normal` faces the light;
// `error`: how far the point may be off along it.
float shadow_map_visible(uint light, vec3 position, vec3 normal, float error) {
    if (is_directional(light)) return parallel_map_visible(light, position, normal, error);
    vec3 v = in_light_frame(light, position - light_at(light).position);
    vec3 n = in_light_frame(light, normal);
    int face = cube_face(v);
    if (uint(face) >= shadow_face_count()) return 0.0;
    vec3 n_face = cube_coordinates(face, n);
    float texel = 2.0 * cube_coordinates(face, v).z / float(textureSize(shadow_map, 0).x);
    v += n * (kLiftTexels * texel * sqrt(max(0.0, 1.0 - n_face.z * n_face.z)) + error);
    vec3 place = cube_coordinates(face, v);
    // Depth is near / z, and linear over the plane dot(n, p) = -height: nowhere in the face above
    // near * (|n.x| + |n.y| + |n.z|) / height.
    float height = abs(dot(n, v));
    float slack = kDepthError * (1.0 + place.z * dot(abs(n), vec3(1)) / height);
    float layer = float(light * shadow_face_count() + uint(face));
    return texture(shadow_map, vec4(place.xy / place.z * 0.5 + 0.5, layer, light_at(light).near / place.z * (1.0 + slack)));
}

#endif
