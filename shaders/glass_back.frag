// Draws the back faces of bodies of glass, where light leaves them (lib/refraction.glsl). A pixel stores x and y of the
// unit normal, which points outwards; the distance along the view's axis, negative if the normal's z is negative; and
// the body's mirror number.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/drawn.glsl"
#include "lib/eye.glsl"
#include "lib/glass_shadow.glsl"

layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 from_eye;

layout(location = 0) out vec4 out_back;

void main() {
    // A sheet has no back, and would hide the backs of bodies behind the sheet.
    if (!is_solid_glass(drawn_material_parameters())) discard;
    View view = views[draw.first_view];
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    if (dot(facet, normal) < 0.0) facet = -facet;
    if (!(dot(facet, orthographic != 0u ? view.forward : from_eye) > 0.0)) discard;
    vec3 n = normalize(normal);
    float along = dot(view.forward, from_eye);
    out_back = vec4(n.xy, n.z < 0.0 ? -along : along, drawn_mirror_number());
}
