// Points drawn on lamps. A ray to such a point shows a rough surface a small lamp, which rays drawn from the surface's
// lobe seldom meet (next-event estimation). engine/render/lamp_table.cpp builds the list of the lamps' triangles.
#ifndef CATOPTRIC_LAMPS_GLSL
#define CATOPTRIC_LAMPS_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// 1: rays also leave rough surfaces towards points drawn on lamps.
layout(constant_id = SAMPLES_LAMPS_CONSTANT) const uint samples_lamps = 0u;

// Texel 0: x is 1 / the total power, where the power of a triangle is the sum of its emission's channels times its area;
// y is the number of triangles, as a word of engine/bvh/words.hpp.
// Triangle i has three texels from 1 + 3 i on. Their xyz are its first corner, and the sides from this corner to the
// second and to the third. Their w are the share of cell i of the alias table that belongs to triangle i, the triangle
// that has the rest of the cell, and the object.
TEXEL_LIST(LAMPS_BINDING, lamp_texels, vec4, samplerBuffer, false)

// A point on a triangle that emits light, in scene units, and the triangle's unit normal and object.
struct LampPoint {
    vec3 position, normal;
    uint object;
};

// Returns the density, per area, with which draw_lamp_point draws a point on the object. Textures of the lamp do not
// change the density.
float lamp_point_density(uint object) { return dot(read_surface(object).emission, vec3(1)) * lamp_texels_at(0u).x; }

// Draws a triangle by its power (alias method: Walker, "An Efficient Method for Generating Discrete Random
// Variables with General Distributions", 1977), and a uniform point on the triangle. `u` and `v` are uniform in [0, 1).
LampPoint draw_lamp_point(float u, float v) {
    uint count = floatBitsToUint(lamp_texels_at(0u).y) & kBvhIdMask;
    float cell = u * float(count);
    uint triangle = min(uint(cell), count - 1u);
    float rest = cell - float(triangle), share = lamp_texels_at(1u + 3u * triangle).w;
    bool is_alias = rest >= share;
    rest = is_alias ? (rest - share) / (1.0 - share) : rest / share;
    if (is_alias) triangle = floatBitsToUint(lamp_texels_at(2u + 3u * triangle).w) & kBvhIdMask;
    vec3 corner = lamp_texels_at(1u + 3u * triangle).xyz, second = lamp_texels_at(2u + 3u * triangle).xyz;
    vec4 third = lamp_texels_at(3u + 3u * triangle);
    float s = sqrt(clamp(rest, 0.0, 1.0));
    return LampPoint(corner + s * (1.0 - v) * second + s * v * third.xyz, normalize(cross(second, third.xyz)),
                     floatBitsToUint(third.w) & kBvhIdMask);
}

#endif
