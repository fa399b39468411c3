// How the camera sees: from its eye, or along parallel lines.
#ifndef CATOPTRIC_EYE_GLSL
#define CATOPTRIC_EYE_GLSL

#include "lib/constants.glsl"

// 1: the view that is drawn, or that the rays begin in, is orthographic.
layout(constant_id = ORTHOGRAPHIC_CONSTANT) const uint orthographic = 0u;

#endif
