#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
layout(set = 0, binding = 1) uniform samplerCubeShadow shadow_map;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;

void main() {
    vec3 n = normalize(normal);
    vec3 to_light = frame.light.xyz - position;
    float distance = length(to_light);
    vec3 direction = to_light / distance;
    float cosines = max(-dot(direction, frame.light_normal.xyz), 0.0) * max(dot(direction, n), 0.0);
    vec3 size = abs(to_light);
    float depth = frame.light_normal.w / max(size.x, max(size.y, size.z));
    float visible = texture(shadow_map, vec4(-to_light, depth));
    vec3 direct = frame.intensity.rgb * (cosines * visible / (distance * distance * 3.14159265));
    out_colour = vec4(draw.emission.rgb + draw.albedo.rgb * (direct + frame.light.w), 1);
    out_distance = length(position - draw.eye.xyz);
}
