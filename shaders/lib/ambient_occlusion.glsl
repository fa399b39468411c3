// The share of the hemisphere above a drawn surface that near surfaces leave visible, weighted by the cosine, in pictures of
// the camera's view (knob `ao=screen`). engine/render/ambient_occlusion.cpp computes the share of each pixel.
#ifndef CATOPTRIC_AMBIENT_OCCLUSION_GLSL
#define CATOPTRIC_AMBIENT_OCCLUSION_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: the share is known for the surface in each pixel.
layout(constant_id = HAS_AMBIENT_OCCLUSION_CONSTANT) const uint has_ambient_occlusion = 0u;
layout(set = 0, binding = AMBIENT_OCCLUSION_BINDING) uniform sampler2D ambient_occlusion;

// Returns the visible share of the hemisphere above the surface in a pixel, 0 to 1.
float visible_hemisphere_share(ivec2 pixel) {
    count_work_once(kWorkTextureLookups);
    return texelFetch(ambient_occlusion, pixel, 0).r;
}

#endif
