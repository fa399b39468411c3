// Triangles in a space of their own: precise however small they are beside their distance from the origin.
#version 460
#ifdef LAYERED
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#extension GL_GOOGLE_include_directive : require
#define PLACED
#include "lib/vertex.glsl"
