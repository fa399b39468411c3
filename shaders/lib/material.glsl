// What surfaces are where they are more than one colour: textures, colours at vertices, parts that are cut out, and
// how much of it a sharp one reflects. The same for raster and rays; a scene without such surfaces pays nothing.
#ifndef CATOPTRIC_MATERIAL_GLSL
#define CATOPTRIC_MATERIAL_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

layout(constant_id = DETAILS_CONSTANT) const uint details = 0u; // 1: some surface is more than one colour, or has two sides
layout(constant_id = MASKS_CONSTANT) const uint masks = 0u;     // 1: something is cut out
TEXEL_LIST(DETAILS_BINDING, detail_quads, uvec4, usamplerBuffer, false) // see MaterialParameters
TEXEL_LIST(ATTRIBUTES_BINDING, attribute_texels, vec4, samplerBuffer, false) // two each
// First what 256 bytes of sRGB are in linear light, as floats; then texels, red in the low byte.
TEXEL_LIST(TEXELS_BINDING, texture_words, uint, usamplerBuffer, false)

// Four words of a MaterialParameters.
uvec4 detail_quad(uint detail, uint quad) { return detail_quads_at(kMaterialQuads * detail + quad); }

// What is not used is not read.
MaterialParameters detail_at(uint detail) {
    uvec4 q0 = detail_quad(detail, 0), q1 = detail_quad(detail, 1), q2 = detail_quad(detail, 2), q3 = detail_quad(detail, 3);
    uvec4 q4 = detail_quad(detail, 4), q5 = detail_quad(detail, 5), q6 = detail_quad(detail, 6), q7 = detail_quad(detail, 7);
    uvec4 q8 = detail_quad(detail, 8), q9 = detail_quad(detail, 9);
    vec4 f1 = uintBitsToFloat(q1), f2 = uintBitsToFloat(q2), f5 = uintBitsToFloat(q5), f9 = uintBitsToFloat(q9);
    return MaterialParameters(q0.x, q0.y, uintBitsToFloat(q0.z), uintBitsToFloat(q0.w), f1.x, f1.y, f1.z, vec3(f1.w, f2.xy),
                  vec3(f2.zw, uintBitsToFloat(q3.x)),
                  TextureUse(q3.y, q3.z, q3.w, uintBitsToFloat(q4.xyz), vec3(uintBitsToFloat(q4.w), f5.xy)),
                  TextureUse(q5.z, q5.w, q6.x, uintBitsToFloat(q6.yzw), uintBitsToFloat(q7.xyz)),
                  TextureUse(q7.w, q8.x, q8.y, vec3(uintBitsToFloat(q8.zw), f9.x), f9.yzw));
}
Attribute attribute_at_vertex(uint vertex) {
    return Attribute(attribute_texels_at(2u * vertex), attribute_texels_at(2u * vertex + 1u));
}

const Attribute kNoAttribute = Attribute(vec4(0), vec4(1));

vec4 texel_colour(TextureUse use, int x, int y) {
    uint texel = texture_words_at(use.first + uint(y) * (use.size & 0xffffu) + uint(x));
    if ((use.how & kTextureSrgb) == 0u) return unpackUnorm4x8(texel);
    return vec4(uintBitsToFloat(texture_words_at(texel & 0xffu)), uintBitsToFloat(texture_words_at(texel >> 8u & 0xffu)),
                uintBitsToFloat(texture_words_at(texel >> 16u & 0xffu)), float(texel >> 24u) / 255.0);
}

// `uv`: both texture spaces. White where there is no texture.
vec4 texture_colour(TextureUse use, vec4 uv) {
    if (use.size == 0u) return vec4(1);
    vec3 place = vec3((use.how & kTextureSecondUv) != 0u ? uv.zw : uv.xy, 1);
    float u = dot(use.u_row, place), v = dot(use.v_row, place);
    int width = int(use.size & 0xffffu), height = int(use.size >> 16u);
    uint wrap_u = use.how & 3u, wrap_v = use.how >> 2u & 3u;
    if ((use.how & kTextureNearest) != 0u)
        return texel_colour(use, nearest_texel(u, width, wrap_u), nearest_texel(v, height, wrap_v));
    int left, right, top, bottom;
    float across, down;
    texels_around(u, width, wrap_u, left, right, across);
    texels_around(v, height, wrap_v, top, bottom, down);
    return mix(mix(texel_colour(use, left, top), texel_colour(use, right, top), across),
               mix(texel_colour(use, left, bottom), texel_colour(use, right, bottom), across), down);
}

// Whether the surface is not there. `number`: of its MaterialParameters.
bool fails_alpha_test(uint number, Attribute at) {
    MaterialParameters detail = detail_at(number);
    float alpha = detail.alpha * at.colour.a;
    if (detail.alpha_cutoff <= 0.0) return false;
    return !(alpha * texture_colour(detail.albedo, at.uv).a >= detail.alpha_cutoff);
}

// The normal on the side of the facet that `direction` comes from, where the surface has two sides.
vec3 turned_normal(uint detail, vec3 normal, vec3 facet, vec3 direction) {
    if ((detail_at(detail).flags & kMaterialTurns) == 0u) return normal;
    return dot(normal, facet) * dot(direction, facet) > 0.0 ? -normal : normal;
}

// The facet as `shade` wants it: zero where the mesh's normals nowhere leave those of its facets.
vec3 lit_facet(uint detail, vec3 facet) {
    if (details == 0u || (detail_at(detail).flags & kMaterialFacets) == 0u) return vec3(0);
    return facet;
}

// What the surface is here: albedo becomes what is left for diffuse light, reflectance what a ray that is mirrored
// counts. `cosine`: between the normal and the direction to who looks.
void evaluate(inout Surface surface, Attribute at, float cosine) {
    MaterialParameters detail = detail_at(surface.detail);
    bool is_constant = (detail.flags & kMaterialConstant) != 0u;
    if (!is_constant) surface.reflectance = vec3(0);
    if ((detail.flags & kMaterialVaries) == 0u) return;
    vec3 colour = surface.albedo * at.colour.rgb * texture_colour(detail.albedo, at.uv).rgb;
    if ((detail.flags & kMaterialUnlit) != 0u) {
        surface.emission = colour;
        surface.albedo = surface.reflectance = vec3(0);
        return;
    }
    surface.emission *= texture_colour(detail.emission, at.uv).rgb;
    vec4 rough = texture_colour(detail.rough, at.uv);
    float metallic = detail.metallic * rough.b;
    bool is_sharp = detail.roughness * rough.g <= detail.max_specular_roughness;
    if (!is_constant && is_sharp)
        surface.reflectance = schlick(mix(detail.f0, colour, metallic), mix(detail.f90, vec3(1), metallic), cosine);
    // The metal part of what is rough is drawn as diffuse.
    if (is_constant || is_sharp) colour *= (1.0 - metallic) * (1.0 - surface.reflectance);
    surface.albedo = colour;
}

#endif
