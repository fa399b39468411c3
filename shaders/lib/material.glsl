// Materials that vary over a surface: textures, vertex colours, alpha tests, and the reflectance of smooth surfaces.
// The rasteriser and the ray tracer share this code. Specialisation constants remove it for scenes without such
// materials.
#ifndef CATOPTRIC_MATERIAL_GLSL
#define CATOPTRIC_MATERIAL_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

layout(constant_id = DETAILS_CONSTANT) const uint details = 0u; // 1: some material needs its MaterialParameters
layout(constant_id = MASKS_CONSTANT) const uint masks = 0u;     // 1: some material has an alpha test
TEXEL_LIST(DETAILS_BINDING, detail_quads, uvec4, usamplerBuffer, false) // list of MaterialParameters
TEXEL_LIST(ATTRIBUTES_BINDING, attribute_texels, vec4, samplerBuffer, false) // two texels for each attribute
// List of words: first a table that maps an sRGB byte to linear light as a float, then the table of lobe_albedo_terms,
// then all texels, red in the low byte.
TEXEL_LIST(TEXELS_BINDING, texture_words, uint, usamplerBuffer, false)

// Returns four words of a MaterialParameters.
uvec4 detail_quad(uint detail, uint quad) { return detail_quads_at(kQuadsPerMaterial * detail + quad); }
uint detail_word(uint detail, uint word) { return detail_quad(detail, word / 4u)[word % 4u]; }

// Reads a MaterialParameters. The compiler removes reads of members that the caller does not use.
MaterialParameters read_material_parameters(uint detail) {
    uvec4 q0 = detail_quad(detail, 0), q1 = detail_quad(detail, 1), q2 = detail_quad(detail, 2), q3 = detail_quad(detail, 3);
    uvec4 q4 = detail_quad(detail, 4), q5 = detail_quad(detail, 5), q6 = detail_quad(detail, 6), q7 = detail_quad(detail, 7);
    uvec4 q8 = detail_quad(detail, 8), q9 = detail_quad(detail, 9);
    vec4 f0 = uintBitsToFloat(q0), f1 = uintBitsToFloat(q1), f2 = uintBitsToFloat(q2), f4 = uintBitsToFloat(q4);
    vec4 f5 = uintBitsToFloat(q5), f7 = uintBitsToFloat(q7), f9 = uintBitsToFloat(q9);
    MaterialParameters result;
    result.flags = q0.x, result.first_attribute = q0.y;
    result.max_specular_roughness = f0.z, result.alpha = f0.w, result.alpha_cutoff = f1.x;
    result.f0 = f1.yzw, result.f90 = f2.xyz;
    result.albedo = TextureUse(q2.w, q3.x, q3.y, vec3(uintBitsToFloat(q3.zw), f4.x), f4.yzw);
    result.emission = TextureUse(q5.x, q5.y, q5.z, vec3(f5.w, uintBitsToFloat(q6.xy)), vec3(uintBitsToFloat(q6.zw), f7.x));
    result.rough = TextureUse(q7.y, q7.z, q7.w, uintBitsToFloat(q8.xyz), vec3(uintBitsToFloat(q8.w), f9.xy));
    uint word = kMaterialWordsBeforeFactors;
#define READ_FACTOR(name) result.name = uintBitsToFloat(detail_word(detail, word++));
    MATERIAL_FACTORS(READ_FACTOR)
#undef READ_FACTOR
    return result;
}
VertexAttribute read_vertex_attribute(uint vertex) {
    return VertexAttribute(attribute_texels_at(2u * vertex), attribute_texels_at(2u * vertex + 1u));
}

const VertexAttribute kNoAttribute = VertexAttribute(vec4(0), vec4(1));

vec4 read_texel_colour(TextureUse use, int x, int y) {
    uint texel = texture_words_at(use.first + uint(y) * (use.size & 0xffffu) + uint(x));
    if ((use.how & kTextureSrgbFlag) == 0u) return unpackUnorm4x8(texel);
    return vec4(uintBitsToFloat(texture_words_at(texel & 0xffu)), uintBitsToFloat(texture_words_at(texel >> 8u & 0xffu)),
                uintBitsToFloat(texture_words_at(texel >> 16u & 0xffu)), float(texel >> 24u) / 255.0);
}

// Samples a texture. `uv` holds both sets of texture coordinates. Returns white if the material has no such texture.
vec4 sample_texture(TextureUse use, vec4 uv) {
    if (use.size == 0u) return vec4(1);
    count_once(kWorkTextureLookups);
    vec3 place = vec3((use.how & kTextureSecondUvFlag) != 0u ? uv.zw : uv.xy, 1);
    float u = dot(use.u_row, place), v = dot(use.v_row, place);
    int width = int(use.size & 0xffffu), height = int(use.size >> 16u);
    uint wrap_u = use.how & 3u, wrap_v = use.how >> 2u & 3u;
    if ((use.how & kTextureNearestFlag) != 0u)
        return read_texel_colour(use, nearest_texel(u, width, wrap_u), nearest_texel(v, height, wrap_v));
    int left, right, top, bottom;
    float across, down;
    bilinear_texels(u, width, wrap_u, left, right, across);
    bilinear_texels(v, height, wrap_v, top, bottom, down);
    return mix(mix(read_texel_colour(use, left, top), read_texel_colour(use, right, top), across),
               mix(read_texel_colour(use, left, bottom), read_texel_colour(use, right, bottom), across), down);
}

// Returns whether the alpha test cuts the surface out at a point. `number` is the index of its MaterialParameters.
bool fails_alpha_test(uint number, VertexAttribute at) {
    MaterialParameters detail = read_material_parameters(number);
    float alpha = detail.alpha * at.colour.a;
    if (detail.alpha_cutoff <= 0.0) return false;
    return !(alpha * sample_texture(detail.albedo, at.uv).a >= detail.alpha_cutoff);
}

// Returns the shading normal. For a two-sided material, the normal is turned to the side of the facet from which
// `direction` comes.
vec3 turn_normal_to_viewer(uint detail, vec3 normal, vec3 facet, vec3 direction) {
    if ((read_material_parameters(detail).flags & kMaterialTwoSidedFlag) == 0u) return normal;
    return dot(normal, facet) * dot(direction, facet) > 0.0 ? -normal : normal;
}

// Returns the facet normal for `shade`, or zero if the mesh's vertex normals agree with its facet normals everywhere.
vec3 facet_normal_for_shading(uint detail, vec3 facet) {
    if (details == 0u || (read_material_parameters(detail).flags & kMaterialTestsFacetSideFlag) == 0u) return vec3(0);
    return facet;
}

// The specular lobe of the surface that was evaluated last: its roughness, and the reflectance seen head-on and at
// grazing angle. A roughness of 0 is a perfect mirror.
struct SpecularLobe {
    float roughness;
    vec3 f0, f90;
};
SpecularLobe specular_lobe = SpecularLobe(0.0, vec3(0), vec3(1));

// Returns whether the surface that was evaluated last reflects in a lobe instead of a single direction.
bool has_rough_lobe() { return details != 0u && specular_lobe.roughness > kMaxSharpRoughness; }

// Draws the direction in which light leaves the rough surface that was evaluated last. `direction` is that of the
// arriving ray, and `leaving` at first that of the perfect mirror. Multiplies the weight by the lobe's weight. Returns
// false without a change if the ray arrives from behind. `u` and `v` are uniform in [0, 1). The lobe's normal is
// half-way between both directions, because mirror_direction keeps the mirrored ray above the facet at the outlines of
// smooth bodies.
bool sample_specular_lobe(vec3 direction, vec3 facet, float u, float v, inout vec3 weight, inout vec3 leaving) {
    vec3 tangent, bitangent;
    vec3 normal = normalize(leaving - direction);
    tangent_frame(normal, tangent, bitangent);
    vec3 to_eye = -vec3(dot(tangent, direction), dot(bitangent, direction), dot(normal, direction));
    if (!(to_eye.z > 0.0)) return false;
    float alpha = roughness_to_alpha(specular_lobe.roughness);
    vec3 drawn = sample_lobe(alpha, to_eye, u, v);
    weight *= lobe_sample_weight(alpha, specular_lobe.f0, specular_lobe.f90, to_eye, drawn);
    leaving = drawn.x * tangent + drawn.y * bitangent + drawn.z * normal;
    // Light from below the facet's plane cannot reach the surface.
    if (!(dot(leaving, facet_side(normal, facet)) > 0.0)) weight = vec3(0);
    return true;
}

// Returns entry (x, y) of the table of lobe_albedo_terms.
vec2 read_lobe_albedo(int x, int y) {
    return unpackUnorm2x16(texture_words_at(kSrgbTableWords + uint(y) * kLobeTableEdge + uint(x)));
}

// Returns the share of light that the rough lobe evaluated last reflects to a viewer at the angle `cosine` to the
// normal, if equal light arrives from everywhere: f0 times the first term of the table plus f90 times the second (Karis,
// "Real Shading in Unreal Engine 4", 2013).
vec3 specular_lobe_albedo(float cosine) {
    float x = clamp(cosine, 0.0, 1.0) * float(kLobeTableEdge - 1u);
    float y = clamp(specular_lobe.roughness, 0.0, 1.0) * float(kLobeTableEdge - 1u);
    int left = min(int(x), int(kLobeTableEdge) - 2), top = min(int(y), int(kLobeTableEdge) - 2);
    vec2 terms = mix(mix(read_lobe_albedo(left, top), read_lobe_albedo(left + 1, top), x - float(left)),
                     mix(read_lobe_albedo(left, top + 1), read_lobe_albedo(left + 1, top + 1), x - float(left)),
                     y - float(top));
    return specular_lobe.f0 * terms.x + specular_lobe.f90 * terms.y;
}

// Evaluates the material at a point. Sets specular_lobe, and sets the surface's albedo to the diffuse part and its
// reflectance to the weight of a mirrored ray. `cosine` is the cosine between the normal and the direction to the
// viewer.
void evaluate_material(inout Surface surface, VertexAttribute at, float cosine) {
    count_once(kWorkMaterials);
    MaterialParameters detail = read_material_parameters(surface.detail);
    bool is_constant = (detail.flags & kMaterialConstantReflectanceFlag) != 0u;
    specular_lobe.roughness = 0.0;
    if (!is_constant) surface.reflectance = vec3(0);
    if ((detail.flags & kMaterialVariesFlag) == 0u) return;
    vec3 colour = surface.albedo * at.colour.rgb * sample_texture(detail.albedo, at.uv).rgb;
    if ((detail.flags & kMaterialUnlitFlag) != 0u) {
        surface.emission = colour;
        surface.albedo = surface.reflectance = vec3(0);
        return;
    }
    surface.emission *= sample_texture(detail.emission, at.uv).rgb;
    vec4 rough = sample_texture(detail.rough, at.uv);
    float metallic = detail.metallic * rough.b;
    bool is_sharp = detail.roughness * rough.g <= detail.max_specular_roughness;
    if (!is_constant && is_sharp) {
        specular_lobe = SpecularLobe(detail.roughness * rough.g, mix(detail.f0, colour, metallic), mix(detail.f90, vec3(1), metallic));
        surface.reflectance = schlick(specular_lobe.f0, specular_lobe.f90, cosine);
    }
    // A rough metal is drawn as if it were diffuse.
    if (is_constant || is_sharp) colour *= (1.0 - metallic) * (1.0 - surface.reflectance);
    surface.albedo = colour;
}

#endif
