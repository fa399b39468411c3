// Code that the fragment shaders of captures and of the camera's view share: inputs, outputs and stored distances.
#ifndef CATOPTRIC_SURFACE_GLSL
#define CATOPTRIC_SURFACE_GLSL

#include "lib/constants.glsl"
#include "lib/drawn.glsl"
#include "lib/eye.glsl"
#include "lib/material.glsl"

layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 from_eye; // vector from the eye to the surface: position - eye
layout(location = 3) in vec4 in_uv; // VertexAttribute::uv, two sets of texture coordinates
layout(location = 4) in vec4 in_colour;

layout(location = 0) out vec4 out_colour;
// Output of a distance. A capture stores the distance from its centre. A camera view that leaves pixels to ray tracing
// stores instead the number, from 1, of the tracer that takes the pixel. In such a view distance_scale is 0.
layout(location = 1) out float out_distance;
// The camera's view stores the lookup of a mirror: its direction, and 1 + state + 4 layer + 8 mirror + residual as one
// number. Pixels without a mirror store 0.
// Some captures store the surface: the number of a mirror, from 1, or a negative number for another object; its normal.
layout(location = 2) out vec4 out_more;

// Returns the position of the surface, scene units. `from_eye` is interpolated instead of the position, because its
// error lies along the ray from the eye. An interpolated position would have an error towards the origin, off the
// surface.
vec3 fragment_surface_position() { return camera_position() + from_eye; }

// Returns the direction from the viewer to the surface, of any length.
vec3 direction_from_viewer() { return orthographic != 0u ? views[draw.first_view].forward : from_eye; }

// Returns the largest error of fragment_surface_position along a unit normal. No specification bounds the error of a
// rasteriser's interpolation. The assumed 2^-16 of the distance along the ray and 2^-20 across the ray are about ten
// times the measured errors (docs/extremes.md).
float fragment_position_error(vec3 n) {
    return (abs(dot(n, from_eye)) + length(from_eye) / 16.0) / 65536.0 + dot(abs(n),
        rounding_error_gamma_bound(2) * abs(camera_position() + from_eye));
}

// The factor from distance to stored distance: 1 stores scene units, and unorm8 stores distance / range.
layout(constant_id = DISTANCE_SCALE_CONSTANT) const float distance_scale = 1.0;

// 1: mirrors show their diffuse and emitted light, too.
layout(constant_id = LIGHTS_MIRRORS_CONSTANT) const uint lights_mirrors = 0u;

layout(constant_id = KEEPS_SURFACE_CONSTANT) const uint keeps_surface = 0u;

// 1: the pass draws the second layer of a capture (depth peeling).
layout(constant_id = PEELS_CONSTANT) const uint peels = 0u;
// The largest absolute rounding error of a stored distance, in addition to the relative error.
layout(constant_id = STORED_ROUNDING_CONSTANT) const float stored_rounding = 0.0;
// The margin for relative rounding errors of a stored and of an interpolated distance, as a share of the distance.
layout(constant_id = PEEL_MARGIN_CONSTANT) const float peel_margin = 1.0 / 1024.0;
// Distances of the capture's first layer.
layout(set = 0, binding = FIRST_LAYER_BINDING) uniform sampler2DArray first_layer;

// Returns whether depth peeling removes the fragment from the second layer. The second layer keeps only surfaces behind
// the first layer that face the capture's centre.
bool is_peeled_from_second_layer() {
    count_distance_lookup();
    float first = texelFetch(first_layer, ivec3(gl_FragCoord.xy, rendered_view_layer()), 0).r;
    return !(length(from_eye) * distance_scale > first * (1.0 + peel_margin) + stored_rounding) || !(dot(normal, from_eye) < 0.0);
}

layout(constant_id = DRAWN_PARTS_CONSTANT) const uint drawn_parts = kDrawOpaqueParts;

float fragment_alpha() { return surface_alpha(drawn_material_parameters(), VertexAttribute(in_uv, in_colour)); }

// Discards fragments that are cut out or belong to another pass. Shaders call this function after their derivatives, before
// any output.
void discard_cut_out_fragments() {
    if (masks == 0u) return;
    if (has_blending != 0u && is_blended(drawn_material_parameters())) {
        float alpha = fragment_alpha();
        if (!(alpha > 0.0) || (drawn_parts != kDrawAllParts && (alpha >= kOpaqueAlpha) != (drawn_parts == kDrawOpaqueParts)))
            discard;
    } else if (fails_alpha_test(drawn_material_parameters(), VertexAttribute(in_uv, in_colour))) {
        discard;
    }
}

// The triangle's sides between neighbouring fragments. Derivatives come before any discard.
TriangleTextureSides fragment_sides = has_normal_textures == 0u
    ? TriangleTextureSides(vec3(0), vec3(0), vec4(0), vec4(0))
    : TriangleTextureSides(dFdx(from_eye), dFdy(from_eye), dFdx(in_uv), dFdy(in_uv));

// Returns the object's surface at the fragment. Bends the normal `n` by the material's texture of normals, and turns the
// normal of a two-sided material to the viewer's side. `facet` points along the triangle's normal.
Surface find_surface_at_fragment(inout vec3 n, vec3 facet) {
    Surface surface = read_drawn_surface();
    if (details != 0u) {
        vec3 direction = normalize(direction_from_viewer());
        VertexAttribute at = VertexAttribute(in_uv, in_colour);
        vec3 turned = turn_shading_normal_to_viewer(surface.detail, n, facet, direction);
        if (has_normal_textures != 0u) {
            vec3 bent = apply_normal_texture(surface.detail, at, n, fragment_sides);
            turned = turned == n ? bent : -bent;
        }
        n = turned;
        evaluate_material(surface, at, -dot(n, direction));
        if (has_clear_coats != 0u) cover_with_clear_coat(surface);
    }
    return surface;
}

// The number that captures store for a blended surface, which belongs to no object.
const float kBlendedSurface = -4096.0;

// Returns the number that captures store for the surface. A 16-bit float holds the number exactly. Two objects that are
// no mirrors may share a number if they are far apart in the scene's list.
float captured_surface_number() {
    return drawn_mirror_number() != 0u ? float(drawn_mirror_number()) : -1.0 - float(drawn_object_index() % 2047u);
}

// The largest colour of the image format. Colours are clamped to this value, so that no capture holds an infinity.
layout(constant_id = LARGEST_COLOUR_CONSTANT) const float largest_colour = 3.402823466e38;

void write_fragment_outputs(vec3 colour) {
    out_colour = vec4(min(colour, vec3(largest_colour)), 1);
    out_distance = length(from_eye) * distance_scale;
    out_more = vec4(0); // an output that is not written would be undefined
    if (keeps_surface != 0u) out_more = vec4(captured_surface_number(), normalize(normal));
}

#endif
