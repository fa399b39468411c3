// Draws the surfaces of the camera's view for ambient occlusion (occlusion/share.comp). A pixel stores the unit normal,
// which points to the side of the facet that is seen, and the distance along the view's axis, scene units. Pixels without
// a surface keep a distance of 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/surface.glsl"

void main() {
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    discard_cut_out_fragments();
    vec3 n = normalize(normal);
    if (dot(facet, direction_from_viewer()) > 0.0) facet = -facet;
    if (dot(n, facet) < 0.0) n = -n;
    out_colour = vec4(n, dot(views[draw.first_view].forward, from_eye));
}
