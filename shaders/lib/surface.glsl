// What the fragment shaders of captures and view share: inputs, outputs, and how a distance is stored.
#ifndef CATOPTRIC_SURFACE_GLSL
#define CATOPTRIC_SURFACE_GLSL

#include "lib/constants.glsl"
#include "lib/drawn.glsl"
#include "lib/eye.glsl"
#include "lib/material.glsl"

layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 from_eye; // position - eye
layout(location = 3) in vec4 in_uv; // see Attribute
layout(location = 4) in vec4 in_colour;

layout(location = 0) out vec4 out_colour;
// Captures that hold distances keep them. A view that leaves pixels to tracing keeps which tracer takes each, from 1;
// there distance_scale is 0.
layout(location = 1) out float out_distance;
// Views keep where a mirror looked: direction; 1 + state + 4 layer + 8 mirror + residual, as a number; else 0.
// Some captures keep the surface: mirror n as n, from 1, any other object as a negative number; its normal.
layout(location = 2) out vec4 out_more;

// Where the surface is. A perspective interpolation errs along the ray from the eye, by a part of its length: the floor
// that a low eye sees stays a floor. Interpolated itself, the position would err towards the origin instead.
vec3 surface_position() { return eye() + from_eye; }

// The way that who looks looks here, of any length.
vec3 seen_along() { return orthographic != 0u ? views[draw.first_view].forward : from_eye; }

// How far that may be off along a unit normal. No specification bounds what a rasteriser's interpolation may do:
// 2^-16 of the way along the ray and 2^-20 across it are some ten times what was seen (docs/extremes.md).
float surface_error(vec3 n) {
    return (abs(dot(n, from_eye)) + length(from_eye) / 16.0) / 65536.0 + dot(abs(n), gamma_bound(2) * abs(eye() + from_eye));
}

// 1 stores scene units; unorm8 stores distance / range.
layout(constant_id = DISTANCE_SCALE_CONSTANT) const float distance_scale = 1.0;

layout(constant_id = KEEPS_SURFACE_CONSTANT) const uint keeps_surface = 0u;

#ifdef PEEL
// Rounding of a stored distance, beside the relative one.
layout(constant_id = HALF_STEP_CONSTANT) const float half_step = 0.0;
layout(set = 0, binding = FIRST_LAYER_BINDING) uniform sampler2DArray first_layer; // distances of this capture

// Depth peeling keeps only what faces the capture's centre behind the first layer. 2^-10 lies above the
// relative rounding of a binary16 and of an interpolated distance.
bool is_peeled() {
    float first = texelFetch(first_layer, ivec3(gl_FragCoord.xy, view_layer()), 0).r;
    return !(length(from_eye) * distance_scale > first * (1.0 + 1.0 / 1024.0) + half_step) || !(dot(normal, from_eye) < 0.0);
}
#endif

// Before anything is written, after the derivatives.
void leave_out_what_is_cut() {
    if (masks != 0u && fails_alpha_test(drawn_detail(), Attribute(in_uv, in_colour))) discard;
}

// The object's surface here. `facet`: along its triangle's normal.
Surface surface_here(inout vec3 n, vec3 facet) {
    Surface surface = drawn_surface();
    if (details != 0u) {
        vec3 direction = normalize(seen_along());
        n = turned_normal(surface.detail, n, facet, direction);
        evaluate(surface, Attribute(in_uv, in_colour), -dot(n, direction));
    }
    return surface;
}

// Exact as a half; objects that far apart in the scene's list may share one.
float surface_number() {
    return drawn_mirror() != 0u ? float(drawn_mirror()) : -1.0 - float(drawn_object() % 2047u);
}

// Of the format. Colour saturates there, so that no capture ever holds an infinity.
layout(constant_id = LARGEST_COLOUR_CONSTANT) const float largest_colour = 3.402823466e38;

void write_surface(vec3 colour) {
    out_colour = vec4(min(colour, vec3(largest_colour)), 1);
    out_distance = length(from_eye) * distance_scale;
    out_more = vec4(0); // an output that is not written is not zero, it is undefined
    if (keeps_surface != 0u) out_more = vec4(surface_number(), normalize(normal));
}

#endif
