// How the camera's view tells the ray tracer which triangle it drew: the words of a triangle take the place of the
// pixel's colour, until the tracer writes the colour.
#ifndef CATOPTRIC_FIRST_HIT_GLSL
#define CATOPTRIC_FIRST_HIT_GLSL

#include "lib/math.glsl"

// Returns the texel of a pixel that the view leaves to ray tracer number `tracer`, from 1. The pixel shows a triangle,
// given by its number in the object, of mirror `mirror`, from 1, or of no mirror (0). A tag bit keeps a word that is
// read as a float from being denormal, infinite or NaN. The alpha is negative, which distinguishes the texel from a
// colour.
vec4 make_first_hit_words(uint triangle, uint object, uint mirror, uint tracer) {
    return vec4(uintBitsToFloat(triangle | kBvhNormalFloatBit), uintBitsToFloat(object | kBvhNormalFloatBit), mirror,
        -float(tracer));
}
bool is_first_hit(vec4 words) { return words.w < 0.0; }
bool is_first_hit_for_tracer(vec4 words, uint tracer) { return words.w == -float(tracer); }
bool is_first_hit_on_mirror(vec4 words) { return is_first_hit(words) && words.z > 0.0; }
uint read_first_hit_triangle(vec4 words) { return floatBitsToUint(words.x) & kBvhIdMask; }
uint read_first_hit_object(vec4 words) { return floatBitsToUint(words.y) & kBvhIdMask; }

#endif
