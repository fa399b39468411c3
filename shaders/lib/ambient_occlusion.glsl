// The share of the light of the environment, or of light probes, that near surfaces leave to a drawn surface, in pictures of
// the camera's view (knob `ao=screen`). engine/render/ambient_occlusion.cpp computes the visible share of each pixel.
#ifndef CATOPTRIC_AMBIENT_OCCLUSION_GLSL
#define CATOPTRIC_AMBIENT_OCCLUSION_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: the visible share of the environment is known for the surface in each pixel.
layout(constant_id = HAS_AMBIENT_OCCLUSION_CONSTANT) const uint has_ambient_occlusion = 0u;
layout(set = 0, binding = AMBIENT_OCCLUSION_BINDING) uniform sampler2D ambient_occlusion;

// Returns the visible share of the environment at the surface in a pixel, 0 to 1.
float visible_share_of_environment(ivec2 pixel) {
    count_work_once(kWorkTextureLookups);
    return texelFetch(ambient_occlusion, pixel, 0).r;
}

#endif
