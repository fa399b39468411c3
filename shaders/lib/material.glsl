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
// List of words for textures. The list holds a table that maps an sRGB byte to linear light as a float, then the table
// of lobe_albedo_terms, then the texels of all textures, red in the low byte.
TEXEL_LIST(TEXELS_BINDING, texture_words, uint, usamplerBuffer, false)

// Returns four words of a MaterialParameters.
uvec4 read_material_word_quad(uint detail, uint quad) { return detail_quads_at(kQuadsPerMaterial * detail + quad); }
uint read_material_word(uint detail, uint word) { return read_material_word_quad(detail, word / 4u)[word % 4u]; }

// Reads a MaterialParameters. The compiler removes reads of members that the caller does not use.
MaterialParameters read_material_parameters(uint detail) {
    uvec4 q0 = read_material_word_quad(detail, 0), q1 = read_material_word_quad(detail, 1), q2 = read_material_word_quad(detail, 2), q3 = read_material_word_quad(detail, 3);
    uvec4 q4 = read_material_word_quad(detail, 4), q5 = read_material_word_quad(detail, 5), q6 = read_material_word_quad(detail, 6), q7 = read_material_word_quad(detail, 7);
    uvec4 q8 = read_material_word_quad(detail, 8), q9 = read_material_word_quad(detail, 9), q10 = read_material_word_quad(detail, 10), q11 = read_material_word_quad(detail, 11);
    vec4 f12 = uintBitsToFloat(read_material_word_quad(detail, 12));
    vec4 f0 = uintBitsToFloat(q0), f1 = uintBitsToFloat(q1), f2 = uintBitsToFloat(q2), f4 = uintBitsToFloat(q4);
    vec4 f5 = uintBitsToFloat(q5), f7 = uintBitsToFloat(q7), f9 = uintBitsToFloat(q9), f11 = uintBitsToFloat(q11);
    MaterialParameters result;
    result.flags = q0.x, result.first_attribute = q0.y;
    result.max_specular_roughness = f0.z, result.alpha = f0.w, result.alpha_cutoff = f1.x;
    result.f0 = f1.yzw, result.f90 = f2.xyz;
    result.albedo = TextureUse(q2.w, q3.x, q3.y, vec3(uintBitsToFloat(q3.zw), f4.x), f4.yzw);
    result.emission = TextureUse(q5.x, q5.y, q5.z, vec3(f5.w, uintBitsToFloat(q6.xy)), vec3(uintBitsToFloat(q6.zw), f7.x));
    result.rough = TextureUse(q7.y, q7.z, q7.w, uintBitsToFloat(q8.xyz), vec3(uintBitsToFloat(q8.w), f9.xy));
    result.normal = TextureUse(q9.z, q9.w, q10.x, uintBitsToFloat(q10.yzw), f11.xyz);
    result.normal_scale = f11.w;
    result.absorption = f12.xyz, result.ior = f12.w;
    uint word = kMaterialWordsBeforeFactors;
#define READ_FACTOR(name, extension, key, gltf_default, largest) result.name = uintBitsToFloat(read_material_word(detail, word++));
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
    count_work_once(kWorkTextureLookups);
    vec3 place = vec3((use.how & kTextureSecondUvFlag) != 0u ? uv.zw : uv.xy, 1);
    float u = dot(use.u_row, place), v = dot(use.v_row, place);
    int width = int(use.size & 0xffffu), height = int(use.size >> 16u);
    uint wrap_u = use.how & 3u, wrap_v = use.how >> 2u & 3u;
    if ((use.how & kTextureNearestFlag) != 0u)
        return read_texel_colour(use, nearest_texel_index(u, width, wrap_u), nearest_texel_index(v, height, wrap_v));
    int left, right, top, bottom;
    float across, down;
    find_bilinear_texels(u, width, wrap_u, left, right, across);
    find_bilinear_texels(v, height, wrap_v, top, bottom, down);
    return mix(mix(read_texel_colour(use, left, top), read_texel_colour(use, right, top), across),
               mix(read_texel_colour(use, left, bottom), read_texel_colour(use, right, bottom), across), down);
}

// Returns the alpha of the surface at a point. `number` is the index of its MaterialParameters.
float surface_alpha(uint number, VertexAttribute at) {
    MaterialParameters detail = read_material_parameters(number);
    return detail.alpha * at.colour.a * sample_texture(detail.albedo, at.uv).a;
}

// Returns whether the alpha test cuts the surface out at a point.
bool fails_alpha_test(uint number, VertexAttribute at) {
    float cutoff = read_material_parameters(number).alpha_cutoff;
    return cutoff > 0.0 && !(surface_alpha(number, at) >= cutoff);
}

// 1: some surface is blended: it covers the share `alpha` of the light that comes from behind it.
layout(constant_id = HAS_BLENDING_CONSTANT) const uint has_blending = 0u;
const float kOpaqueAlpha = 511.0 / 512.0; // a blended surface with at least this alpha counts as opaque
bool is_blended(uint detail) {
    return has_blending != 0u && (read_material_parameters(detail).flags & kMaterialBlendedFlag) != 0u;
}

// Returns the shading normal. For a two-sided material, the normal is turned to the side of the facet from which
// `direction` comes.
vec3 turn_shading_normal_to_viewer(uint detail, vec3 normal, vec3 facet, vec3 direction) {
    if ((read_material_parameters(detail).flags & kMaterialTwoSidedFlag) == 0u) return normal;
    return dot(normal, facet) * dot(direction, facet) > 0.0 ? -normal : normal;
}

// 1: some material has a texture of normals.
layout(constant_id = HAS_NORMAL_TEXTURES_CONSTANT) const uint has_normal_textures = 0u;

// Two vectors in a triangle's plane, and the differences of both sets of texture coordinates along them.
struct TriangleTextureSides {
    vec3 a, b;
    vec4 uv_a, uv_b;
};

// Returns the unit normal that the material's texture of normals describes, around the unit shading normal. The tangent
// is the direction in which the texture's u grows along the triangle, so the frame needs no data for each vertex (Mikkelsen,
// "Surface Gradient-Based Bump Mapping Framework", 2020, derives frames in this way). As glTF defines it, green grows
// against v. Texels of 128, 128, 255 leave the normal as it is.
vec3 apply_normal_texture(uint detail, VertexAttribute at, vec3 normal, TriangleTextureSides sides) {
    TextureUse use = read_material_parameters(detail).normal;
    if (use.size == 0u) return normal;
    const float kFlat = 1e-4; // below this tilt a normal counts as flat; a texel's step, 1 / 127, is far larger
    vec3 bend = sample_texture(use, at.uv).xyz * 255.0;
    bend = vec3((bend.xy - 128.0) / 127.0 * read_material_parameters(detail).normal_scale, bend.z / 127.5 - 1.0);
    bool is_second = (use.how & kTextureSecondUvFlag) != 0u;
    vec2 uv_a = is_second ? sides.uv_a.zw : sides.uv_a.xy, uv_b = is_second ? sides.uv_b.zw : sides.uv_b.xy;
    vec2 a = vec2(dot(use.u_row.xy, uv_a), dot(use.v_row.xy, uv_a)), b = vec2(dot(use.u_row.xy, uv_b), dot(use.v_row.xy, uv_b));
    float side = a.x * b.y - b.x * a.y < 0.0 ? -1.0 : 1.0;
    vec3 tangent = side * (b.y * sides.a - a.y * sides.b), against_v = side * (b.x * sides.a - a.x * sides.b);
    tangent -= dot(tangent, normal) * normal;
    float size = length(tangent);
    if (!(size > 0.0 && size <= kLargestFloat) || largest_vector_component(abs(vec3(bend.xy, 0))) < kFlat) return normal;
    tangent /= size;
    vec3 bitangent = cross(normal, tangent);
    if (dot(bitangent, against_v) < 0.0) bitangent = -bitangent;
    vec3 bent = bend.x * tangent + bend.y * bitangent + bend.z * normal;
    return dot(bent, bent) > 0.0 ? normalize(bent) : normal;
}

// Returns the facet normal for shade_surface, or zero if the mesh's vertex normals agree with its facet normals
// everywhere.
vec3 find_facet_normal_for_shading(uint detail, vec3 facet) {
    if (details == 0u || (read_material_parameters(detail).flags & kMaterialTestsFacetSideFlag) == 0u) return vec3(0);
    return facet;
}

// 1: some surface reflects in a lobe.
layout(constant_id = HAS_LOBES_CONSTANT) const uint has_lobes = 0u;

// The specular lobe of the surface that was evaluated last: its roughness, and the reflectance seen head-on and at
// grazing angle. A roughness of 0 is a perfect mirror.
struct SpecularLobe {
    float roughness;
    vec3 f0, f90;
    // Albedo of a diffuse surface that stands in for the metal where nothing shows the lamps and surfaces that the lobe
    // reflects.
    vec3 stand_in;
    vec3 gain; // factor of the whole lobe, for multiple scattering
};
SpecularLobe specular_lobe = SpecularLobe(0.0, vec3(0), vec3(1), vec3(0), vec3(1));

// Returns whether the surface that was evaluated last reflects in a lobe instead of a single direction.
bool has_rough_lobe() { return details != 0u && has_lobes != 0u && specular_lobe.roughness > kMaxSharpRoughness; }

// Draws the direction in which light leaves the rough surface that was evaluated last. `direction` is that of the
// arriving ray, and `leaving` at first that of the perfect mirror. Multiplies the weight by the lobe's weight. Returns
// false without a change if the ray arrives from behind. `u` and `v` are uniform in [0, 1). The lobe's normal is
// half-way between both directions, because reflect_above_facet keeps the mirrored ray above the facet at the outlines of
// smooth bodies.
bool sample_specular_lobe(vec3 direction, vec3 facet, float u, float v, inout vec3 weight, inout vec3 leaving) {
    vec3 tangent, bitangent;
    vec3 normal = normalize(leaving - direction);
    tangent_frame(normal, tangent, bitangent);
    vec3 to_eye = -vec3(dot(tangent, direction), dot(bitangent, direction), dot(normal, direction));
    if (!(to_eye.z > 0.0)) return false;
    float alpha = roughness_to_alpha(specular_lobe.roughness);
    vec3 drawn = sample_lobe(alpha, to_eye, u, v);
    weight *= specular_lobe.gain * lobe_sample_weight(alpha, specular_lobe.f0, specular_lobe.f90, to_eye, drawn);
    leaving = drawn.x * tangent + drawn.y * bitangent + drawn.z * normal;
    // Light from below the facet's plane cannot reach the surface.
    if (!(dot(leaving, facet_normal_on_shading_side(normal, facet)) > 0.0)) weight = vec3(0);
    return true;
}

// Returns the share of light, per steradian, that the rough surface evaluated last reflects from `leaving` to where the
// ray comes from, and the density with which sample_specular_lobe draws `leaving`. `mirrored` is the direction of the
// perfect mirror. Returns 0 if the ray arrives from behind, or for light from below the facet's plane.
vec3 evaluate_specular_lobe(vec3 direction, vec3 mirrored, vec3 facet, vec3 leaving, out float density) {
    vec3 tangent, bitangent;
    vec3 normal = normalize(mirrored - direction);
    tangent_frame(normal, tangent, bitangent);
    vec3 to_eye = -vec3(dot(tangent, direction), dot(bitangent, direction), dot(normal, direction));
    vec3 to_light = vec3(dot(tangent, leaving), dot(bitangent, leaving), dot(normal, leaving));
    float alpha = roughness_to_alpha(specular_lobe.roughness);
    density = lobe_pdf(alpha, to_eye, to_light);
    if (!(dot(leaving, facet_normal_on_shading_side(normal, facet)) > 0.0)) return vec3(0);
    return specular_lobe.gain * evaluate_lobe(alpha, specular_lobe.f0, specular_lobe.f90, to_eye, to_light);
}

// Returns entry (x, y) of the table of lobe_albedo_terms.
vec2 read_lobe_albedo(int x, int y) {
    return unpackUnorm2x16(texture_words_at(kSrgbTableWords + uint(y) * kLobeTableEdge + uint(x)));
}

// Returns the terms of the albedo of a lobe of that roughness, for a viewer at the angle `cosine` to the normal: the
// albedo is f0 times the first plus f90 times the second (Karis, "Real Shading in Unreal Engine 4", 2013). An interpolated
// normal that points away from the viewer counts as if it pointed to the viewer.
vec2 lobe_albedo_terms_of(float roughness, float cosine) {
    float x = sqrt(min(abs(cosine), 1.0)) * float(kLobeTableEdge - 1u);
    float y = clamp(roughness, 0.0, 1.0) * float(kLobeTableEdge - 1u);
    int left = min(int(x), int(kLobeTableEdge) - 2), top = min(int(y), int(kLobeTableEdge) - 2);
    return mix(mix(read_lobe_albedo(left, top), read_lobe_albedo(left + 1, top), x - float(left)),
               mix(read_lobe_albedo(left, top + 1), read_lobe_albedo(left + 1, top + 1), x - float(left)),
               y - float(top));
}

// Returns the share of light that the rough lobe evaluated last reflects to a viewer at the angle `cosine` to the
// normal, if equal light arrives from everywhere.
vec3 specular_lobe_albedo(float cosine) {
    vec2 terms = lobe_albedo_terms_of(specular_lobe.roughness, cosine);
    return specular_lobe.gain * (specular_lobe.f0 * terms.x + specular_lobe.f90 * terms.y);
}

// Returns the factor by which a lobe grows if light that hits several microfacets is not lost (Turquin, "Practical
// Multiple Scattering Compensation for Microfacet Models", 2019). The lobe is then no longer reciprocal.
vec3 lobe_multiple_scattering_gain(float cosine) {
    vec2 terms = lobe_albedo_terms_of(specular_lobe.roughness, cosine);
    float single = terms.x + terms.y; // albedo of a lobe whose microfacets reflect all light
    return 1.0 + specular_lobe.f0 * (1.0 - single) / single;
}

// 1: rays pass through some surface.
layout(constant_id = HAS_GLASS_CONSTANT) const uint has_glass = 0u;
vec3 glass_tint = vec3(1); // colour of the light that passes the glass that was evaluated last
// Returns whether rays pass through surfaces with these MaterialParameters.
bool is_glass(uint detail) {
    return has_glass != 0u && details != 0u && (read_material_parameters(detail).flags & kMaterialGlassFlag) != 0u;
}
// Returns whether a ray along `direction` meets the glass from inside a solid body. Facets of solid bodies point outwards.
bool is_inside_glass(uint detail, vec3 direction, vec3 outwards) {
    return has_glass != 0u && (read_material_parameters(detail).flags & kMaterialSolidFlag) != 0u && dot(direction, outwards) > 0.0;
}

// 1: some surface has a clear coat.
layout(constant_id = HAS_CLEAR_COATS_CONSTANT) const uint has_clear_coats = 0u;

// The clear coat of the surface that was evaluated last: a thin layer of varnish with the index of refraction 1.5, which
// reflects in a lobe of its own (KHR_materials_clearcoat). The surface below it loses the light that the coat reflects.
struct ClearCoat {
    float strength; // share of the surface that the coat covers; 0: there is no coat
    float roughness;
    float reflected;    // share of the light from the viewer's mirrored direction that the coat reflects
    bool is_shown;      // whether rays or captures show what the coat reflects
    bool is_base_shown; // whether rays or captures show what the surface below the coat reflects
};
ClearCoat clear_coat = ClearCoat(0.0, 0.0, 0.0, false, false);
const float kClearCoatF0 = 0.04;

// Returns Schlick's reflectance of the coat's material.
float clear_coat_fresnel(float cosine) { return schlick_fresnel(vec3(kClearCoatF0), vec3(1), cosine).x; }

// Returns the share of light that the coat reflects to a viewer at the angle `cosine`, if equal light arrives from everywhere.
float rough_clear_coat_albedo(float cosine) {
    vec2 terms = lobe_albedo_terms_of(clear_coat.roughness, cosine);
    return clear_coat.strength * (kClearCoatF0 * terms.x + terms.y);
}

// Puts the coat over the surface that was evaluated last. The surface's reflectance then includes a coat whose reflections
// rays or captures show.
void cover_with_clear_coat(inout Surface surface) {
    if (clear_coat.strength == 0.0) return;
    float below = 1.0 - clear_coat.reflected;
    surface.albedo *= below;
    surface.emission *= below;
    surface.reflectance *= below;
    specular_lobe.gain *= below;
    specular_lobe.stand_in *= below;
    if (clear_coat.is_shown) surface.reflectance += clear_coat.reflected;
}

// Replaces the surface that was evaluated last by its coat alone or by what is below the coat, each as often as it
// reflects light. The mean over `random`, uniform in [0, 1), is the coated surface. For rays that leave in drawn directions.
void choose_layer_of_clear_coat(float random, inout Surface surface) {
    if (random < clear_coat.reflected) {
        bool is_sharp = clear_coat.roughness <= kMaxSharpRoughness;
        surface.albedo = surface.emission = vec3(0);
        surface.reflectance = vec3(is_sharp ? 1.0 : 0.0);
        specular_lobe = SpecularLobe(clear_coat.roughness, vec3(kClearCoatF0), vec3(1), vec3(0),
                                     vec3(clear_coat.strength / clear_coat.reflected));
    }
    clear_coat.strength = 0.0;
}

// Evaluates the material at a point. Sets clear_coat and specular_lobe, and sets the surface's albedo to the diffuse part and its
// reflectance to the weight of a mirrored ray. The reflectance of a rough surface is 0 unless the surface is part of a
// mirror, because only mirrors have captures. `cosine` is the cosine between the normal and the direction to the viewer.
// The diffuse part is the light that the specular part does not reflect to the viewer: 1 minus the albedo of the lobe
// (or the reflectance of a perfect mirror). So a white surface in a white furnace reflects all light.
void evaluate_material(inout Surface surface, VertexAttribute at, float cosine) {
    count_work_once(kWorkMaterialReads);
    MaterialParameters detail = read_material_parameters(surface.detail);
    bool is_constant = (detail.flags & kMaterialConstantReflectanceFlag) != 0u;
    specular_lobe.roughness = 0.0;
    if (has_clear_coats != 0u) clear_coat.strength = 0.0;
    if (!is_constant) surface.reflectance = vec3(0);
    if ((detail.flags & kMaterialVariesFlag) == 0u) return;
    vec3 colour = surface.albedo * at.colour.rgb * sample_texture(detail.albedo, at.uv).rgb;
    if ((detail.flags & kMaterialUnlitFlag) != 0u) {
        surface.emission = colour;
        surface.albedo = surface.reflectance = vec3(0);
        return;
    }
    surface.emission *= sample_texture(detail.emission, at.uv).rgb;
    if (has_glass != 0u) glass_tint = colour;
    vec4 rough = sample_texture(detail.rough, at.uv);
    float metallic = detail.metallic * rough.b, roughness = detail.roughness * rough.g;
    if (!is_constant) {
        specular_lobe = SpecularLobe(roughness, mix(detail.f0, colour, metallic), mix(detail.f90, vec3(1), metallic),
                                     metallic * colour, vec3(1));
        if (has_lobes != 0u && (detail.flags & kMaterialMultipleScatteringFlag) != 0u && has_rough_lobe())
            specular_lobe.gain = lobe_multiple_scattering_gain(cosine);
        bool is_reflector = roughness <= kMaxSharpRoughness ||
                            surface.mirror != 0u && roughness <= detail.max_specular_roughness;
        if (is_reflector) surface.reflectance = schlick_fresnel(specular_lobe.f0, specular_lobe.f90, cosine);
    }
    vec3 specular_albedo = surface.reflectance;
    if (has_lobes != 0u && has_rough_lobe()) specular_albedo = specular_lobe_albedo(cosine);
    surface.albedo = colour * ((1.0 - metallic) * (1.0 - specular_albedo));
    if (has_clear_coats != 0u && !is_constant && (detail.flags & kMaterialGlassFlag) == 0u && detail.clearcoat > 0.0) {
        bool is_shown = detail.clearcoat_roughness <= kMaxSharpRoughness ||
                        surface.mirror != 0u && detail.clearcoat_roughness <= detail.max_specular_roughness;
        clear_coat = ClearCoat(detail.clearcoat, detail.clearcoat_roughness, detail.clearcoat * clear_coat_fresnel(cosine),
                               is_shown, surface.reflectance != vec3(0));
    }
}

#endif
