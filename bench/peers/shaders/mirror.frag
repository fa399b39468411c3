#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
layout(set = 0, binding = 2) uniform samplerCubeArray colours;
layout(set = 0, binding = 3) uniform samplerCubeArray distances;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;

void main() {
    vec3 seen = position - draw.eye.xyz;
    vec3 along = reflect(normalize(seen), normalize(normal));
    vec3 offset = position - draw.centre.xyz;
    // One step of parallax correction: the surface that the centre sees in the reflected direction is assumed to be a
    // plane perpendicular to that direction.
    float distance = textureLod(distances, vec4(along, draw.cube), 0.0).r;
    vec3 corrected = offset + along * (distance - dot(offset, along));
    out_colour = vec4(draw.albedo.rgb * textureLod(colours, vec4(corrected, draw.cube), 0.0).rgb, 1);
    out_distance = length(seen);
}
