// Draws the environment where a view ray meets no surface, in captures and in the camera's view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/environment.glsl"
#include "lib/surface.glsl"

// 1: the picture has few texels, so each texel shows the mean of the environment around its direction, if the scene has
// filtered levels. A small sun would otherwise fall between the texels.
layout(constant_id = OWN_CONSTANTS) const uint blurs_sky = 0u;

void main() {
    const uint kLevel = 2u; // environment level filtered by a lobe about as wide as a texel of a light probe
    vec3 direction = normalize(from_eye);
    if (blurs_sky != 0u && sky.value.level_width[kLevel - 1u] > 0u) write_fragment_outputs(environment_level_radiance(direction, kLevel));
    else write_fragment_outputs(environment_radiance(direction));
    // The environment has no surface, so a capture stores the distance +infinity. The camera's view stores no distances
    // (distance_scale 0) but tracer numbers, and 0 means that no tracer takes the pixel.
    out_distance = distance_scale > 0.0 ? uintBitsToFloat(0x7f800000u) : 0.0;
    out_more = vec4(0);
}
