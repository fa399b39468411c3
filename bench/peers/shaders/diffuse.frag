#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
// The shadow map's layers are the cube faces +X, -X, -Y, +Z, -Z, because the light shines down. An array of layers is
// faster than a cube map.
layout(set = 0, binding = 1) uniform sampler2DArrayShadow shadow_map;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;

// Returns the shadow map layer of a direction from the light, the coordinates on that face, and the depth along its
// axis.
vec4 find_shadow_map_position(vec3 v) {
    vec3 size = abs(v);
    if (size.y >= size.x && size.y >= size.z) return vec4(2, v.x, -v.z, size.y);
    if (size.x >= size.z) return v.x > 0.0 ? vec4(0, -v.z, -v.y, size.x) : vec4(1, v.z, -v.y, size.x);
    return v.z > 0.0 ? vec4(3, v.x, -v.y, size.z) : vec4(4, -v.x, -v.y, size.z);
}

void main() {
    vec3 n = normalize(normal);
    vec3 to_light = frame.light.xyz - position;
    float distance = length(to_light);
    vec3 direction = to_light / distance;
    float cosines = max(-dot(direction, frame.light_normal.xyz), 0.0) * max(dot(direction, n), 0.0);
    vec4 face = find_shadow_map_position(-to_light);
    vec2 place = face.yz / face.w * 0.5 + 0.5;
    float visible = texture(shadow_map, vec4(place, face.x, frame.light_normal.w / face.w));
    vec3 direct = frame.intensity.rgb * (cosines * visible / (distance * distance * 3.14159265));
    out_colour = vec4(draw.emission.rgb + draw.albedo.rgb * (direct + frame.light.w), 1);
    out_distance = length(position - draw.eye.xyz);
}
