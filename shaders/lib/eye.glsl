// The camera's kind of projection: perspective or orthographic.
#ifndef CATOPTRIC_EYE_GLSL
#define CATOPTRIC_EYE_GLSL

#include "lib/constants.glsl"

// 1: the drawn view, or the view whose camera rays are traced, is orthographic.
layout(constant_id = ORTHOGRAPHIC_CONSTANT) const uint orthographic = 0u;

#endif
