// Vertex shader of meshes in object space. Object space keeps meshes precise that are small and far from the scene's
// origin.
#version 460
#ifdef LAYERED
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#extension GL_GOOGLE_include_directive : require
#define PLACED
#include "lib/vertex.glsl"
