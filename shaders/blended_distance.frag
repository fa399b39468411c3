// Stores the distance of blended surfaces in a capture once their colours are drawn over what is behind them. A search
// then ends on such a surface as on an opaque one. The number kBlendedSurface tells that the colour holds what is behind
// it, too, as seen from the capture's centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#include "lib/surface.glsl"

layout(constant_id = OWN_CONSTANTS) const float blended_alpha = 0.5;

void main() {
    if (!is_blended(drawn_material_parameters()) || !(fragment_alpha() > blended_alpha)) discard;
    write_fragment_outputs(vec3(0));
    if (keeps_surface != 0u) out_more.x = kBlendedSurface;
}
