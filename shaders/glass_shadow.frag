// Draws the optical depth of glass between a light and the surface that its shadow map shows (lib/glass_shadow.glsl). All
// fragments of a texel are summed up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/drawn.glsl"
#include "lib/eye.glsl"
#include "lib/glass_shadow.glsl"

layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 from_eye;
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_colour;

layout(location = 0) out vec4 out_depth;

layout(set = 0, binding = SHADOW_DEPTHS_BINDING) uniform sampler2DArray shadow_depths;

void main() {
    // The triangle's normal, turned to the side to which the vertex normals point. For a solid body, this is the
    // outside.
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    if (dot(facet, normal) < 0.0) facet = -facet;
    VertexAttribute at = VertexAttribute(in_uv, in_colour);
    uint detail = drawn_material_parameters();
    uint layer = draw.first_view + uint(rendered_view_layer()) - 1u - 6u * frame.value.mirror_count;
    float opaque = texelFetch(shadow_depths, ivec3(gl_FragCoord.xy, layer), 0).r;
    if (!(gl_FragCoord.z > opaque) || (masks != 0u && fails_alpha_test(detail, at))) discard;
    View view = views[draw.first_view + uint(rendered_view_layer())];
    vec3 direction = orthographic != 0u ? view.forward : normalize(from_eye);
    vec3 depth = glass_surface_depth(detail, read_drawn_surface().albedo, at, abs(dot(normalize(normal), direction)));
    if (is_solid_glass(detail)) {
        // The way from the drawn glass to the surface in the shadow map. If the map shows no surface there, the way
        // from the glass back to the light, which is negative.
        float way = orthographic != 0u ? (gl_FragCoord.z - opaque) / view.near
            : length(from_eye) * (opaque > 0.0 ? gl_FragCoord.z / opaque - 1.0 : -1.0);
        depth += read_material_parameters(detail).absorption * (dot(facet, direction) < 0.0 ? way : -way);
    }
    out_depth = vec4(depth, 1);
}
