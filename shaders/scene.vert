// Vertex shader of meshes whose vertices are in scene units.
#version 460
#ifdef LAYERED
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#extension GL_GOOGLE_include_directive : require
#include "lib/vertex.glsl"
