// Draws a window's content: one picture, two pictures on the two sides of a divider, or the difference of two pictures.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Push { ScreenParameters screening; };
layout(set = 0, binding = 20) uniform sampler2D first;
layout(set = 0, binding = 21) uniform sampler2D second;
layout(set = 0, binding = 22, scalar) readonly buffer Canvas { uint canvas[]; };
layout(location = 0) out vec4 out_colour;

const vec3 kMarginColour = vec3(.08), kDividerColour = vec3(1, .8, .2);

vec3 read_canvas_pixel(ivec2 pixel) {
    return unpackUnorm4x8(canvas[uint(pixel.y) * screening.size.x + uint(pixel.x)]).rgb;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_colour = vec4(kMarginColour, 1);
    if (any(greaterThanEqual(pixel, ivec2(screening.size)))) return;
    vec3 a = (screening.from_canvas & 1u) != 0u ? read_canvas_pixel(pixel) : texelFetch(first, pixel, 0).rgb;
    out_colour = vec4(a, 1);
    if (screening.kind == kDisplayFirstPicture) return;
    vec3 b = (screening.from_canvas & 2u) != 0u ? read_canvas_pixel(pixel) : texelFetch(second, pixel, 0).rgb;
    if (screening.kind == kDisplayDifference) {
        out_colour = vec4(abs(a - b) * screening.gain, 1);
        return;
    }
    float from_divider = float(pixel.x) - floor(screening.divider);
    if (from_divider >= 0.0) out_colour = vec4(from_divider < 1.0 ? kDividerColour : b, 1);
}
