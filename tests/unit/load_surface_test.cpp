// Tests of loading glTF materials: the surface that each factor, texture and extension gives.
#include "core/image_codec.hpp"
#include "import/file_options.hpp"
#include "import/image_file.hpp"
#include "scene/build.hpp"
#include "scene/material_facts.hpp"
#include "support/refusal.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>

namespace {

using namespace test::loading;
using testing::ElementsAre;

std::string encode_as_base64(const std::string& bytes) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t j = 0; j < 3; ++j)
            three = three << 8 | (i + j < bytes.size() ? std::uint8_t(bytes[i + j]) : 0);
        for (int j = 3; j >= 0; --j) text += digits[three >> (6 * j) & 63];
    }
    const std::size_t missing = (3 - bytes.size() % 3) % 3;
    return text.substr(0, text.size() - missing) + std::string(missing, '=');
}

/// A picture of 3 x 2 texels, which are all different.
const Image kLoadSurfacePicture{
    .name = "p",
    .size = {3, 2},
    .texels = {0xff0000ff, 0xff00ff00, 0xffff0000, 0x80402010, 0x00ffffff, 0xffffffff}};

class LoadSurfaceTest : public Load {
protected:
    /// Builds a glTF file with a triangle of the given material, and two textures that show
    /// kLoadSurfacePicture.
    static GltfFileBuilder make_gltf_with_material(const Json& material) {
        GltfFileBuilder gltf = make_small_gltf();
        gltf.root["materials"] = {material};
        gltf.root["meshes"][0]["primitives"][0]["material"] = 0;
        gltf.root["images"] = {{{"uri", "data:image/png;base64," +
                                            encode_as_base64(encode_png(kLoadSurfacePicture))}}};
        gltf.root["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}};
        gltf.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
        return gltf;
    }
    Scene load_surface_gltf(const GltfFileBuilder& gltf) const {
        return load_gltf(write_loaded_file("x.glb", gltf.glb_bytes()));
    }
    Material load_gltf_material(const Json& material) const {
        return load_surface_gltf(make_gltf_with_material(material)).materials.at(0);
    }
    static std::vector<std::string> list_unsupported_feature_ids(const Scene& scene) {
        std::vector<std::string> list;
        for (const UnsupportedFeature& gap : scene.unsupported) list.push_back(gap.id);
        return list;
    }
};

TEST_F(LoadSurfaceTest, MaterialFactorsAndSidesAreRead) {
    const Material plain = load_gltf_material(Json::object());
    EXPECT_EQ(plain.albedo, vec3(1));
    EXPECT_EQ(plain.metallic, 1);
    EXPECT_EQ(plain.roughness, 1);
    EXPECT_TRUE(plain.front_only);
    EXPECT_FALSE(plain.two_sided || plain.mirror || has_alpha_mask(plain));
    const Material gold = load_gltf_material({{"doubleSided", true},
                                              {"pbrMetallicRoughness",
                                               {{"baseColorFactor", {1, .5, .25, .75}},
                                                {"metallicFactor", 1},
                                                {"roughnessFactor", 0}}}});
    EXPECT_EQ(gold.albedo, vec3(1, .5f, .25f));
    EXPECT_EQ(gold.alpha, .75f);
    EXPECT_EQ(gold.metallic, 1);
    EXPECT_EQ(gold.roughness, 0);
    EXPECT_FALSE(gold.mirror) << "by its angle, as Schlick has it";
    EXPECT_TRUE(gold.two_sided);
    EXPECT_FALSE(gold.front_only);
    const Material perfect = load_gltf_material(
        {{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
    EXPECT_TRUE(perfect.mirror);
    EXPECT_EQ(perfect.reflectance, vec3(1));
    const Material out_of_range = load_gltf_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 7}, {"baseColorFactor", {2, -1, 0, 9}}}}});
    EXPECT_EQ(out_of_range.metallic, 1);
    EXPECT_EQ(out_of_range.albedo, vec3(1, 0, 0));
}

TEST_F(LoadSurfaceTest, PerfectMetalKeepsVertexColours) {
    GltfFileBuilder gltf = make_gltf_with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
    EXPECT_TRUE(load_surface_gltf(gltf).materials[0].mirror);
    const std::size_t colours = gltf.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1},
                                                         "VEC3", 5126);
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
    const Scene scene = load_surface_gltf(gltf);
    EXPECT_FALSE(scene.materials[0].mirror);
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_EQ(scene.meshes[0].colours.size(), 3u);
}

TEST_F(LoadSurfaceTest, DielectricReflectanceFollowsExtensions) {
    const auto with_extension = [&](const char* name, const Json& is) {
        return load_gltf_material({{"extensions", {{name, is}}}});
    };
    EXPECT_EQ(load_gltf_material(Json::object()).dielectric_f0, vec3(.04f));
    const Material diamond = with_extension("KHR_materials_ior", {{"ior", 2.4}});
    EXPECT_NEAR(diamond.dielectric_f0.x, std::pow(1.4 / 3.4, 2), 1e-6);
    EXPECT_EQ(with_extension("KHR_materials_ior", {{"ior", 0}}).dielectric_f0, vec3(1));
    const Material tinted = with_extension(
        "KHR_materials_specular", {{"specularFactor", .5}, {"specularColorFactor", {1, 2, 100}}});
    EXPECT_NEAR(tinted.dielectric_f0.x, .02, 1e-6);
    EXPECT_NEAR(tinted.dielectric_f0.y, .04, 1e-6);
    EXPECT_NEAR(tinted.dielectric_f0.z, .5, 1e-6) << "no more than 1 before its strength";
    EXPECT_EQ(tinted.dielectric_f90, vec3(.5f));
    const Material coated = with_extension(
        "KHR_materials_clearcoat", {{"clearcoatFactor", .5}, {"clearcoatRoughnessFactor", .25}});
    EXPECT_EQ(coated.clearcoat, .5f);
    EXPECT_EQ(coated.clearcoat_roughness, .25f);
    EXPECT_EQ(with_extension("KHR_materials_dispersion", {{"dispersion", 4.5}}).dispersion, 4.5f)
        << "may be above 1";
    const Material glossy = with_extension("KHR_materials_pbrSpecularGlossiness",
                                           {{"diffuseFactor", {.5, .25, 0, 1}},
                                            {"specularFactor", {.25, .5, 1}},
                                            {"glossinessFactor", .75},
                                            {"diffuseTexture", {{"index", 0}}}});
    EXPECT_EQ(glossy.albedo, vec3(.5f, .25f, 0));
    EXPECT_EQ(glossy.dielectric_f0, vec3(.25f, .5f, 1));
    EXPECT_EQ(glossy.roughness, .25f);
    EXPECT_EQ(glossy.metallic, 0);
    ASSERT_TRUE(glossy.albedo_texture);
    const Material flat = with_extension("KHR_materials_unlit", Json::object());
    EXPECT_TRUE(flat.unlit);
    EXPECT_EQ(emitted_radiance(flat), vec3(0));
}

TEST_F(LoadSurfaceTest, OnlyEmissionWithoutATextureLightsTheScene) {
    const Json strong = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}};
    const Material lamp = load_gltf_material(
        {{"emissiveFactor", {1, .5, 0}}, {"extensions", strong}});
    EXPECT_EQ(lamp.emission, vec3(4, 2, 0));
    EXPECT_EQ(emitted_radiance(lamp), vec3(4, 2, 0));
    const Material screen = load_gltf_material(
        {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 1}}}});
    ASSERT_TRUE(screen.emission_texture);
    EXPECT_TRUE(screen.emission_texture->srgb);
    EXPECT_EQ(emitted_radiance(screen), vec3(0)) << "what a texture varies lights nothing";
}

TEST_F(LoadSurfaceTest, AlphaModeDecidesTheCutoff) {
    EXPECT_EQ(load_gltf_material({{"alphaMode", "MASK"}}).alpha_cutoff, .5f);
    EXPECT_EQ(load_gltf_material({{"alphaMode", "MASK"}, {"alphaCutoff", .25}}).alpha_cutoff, .25f);
    EXPECT_EQ(load_gltf_material({{"alphaMode", "OPAQUE"}, {"alphaCutoff", .25}}).alpha_cutoff, 0);
    const Scene blended = load_surface_gltf(make_gltf_with_material({{"alphaMode", "BLEND"}}));
    EXPECT_EQ(blended.materials[0].alpha_cutoff, .5f);
    EXPECT_TRUE(blended.materials[0].blended);
    ASSERT_THAT(list_unsupported_feature_ids(blended), ElementsAre("blend-shadow"));
    EXPECT_EQ(blended.unsupported[0].first, "materials[0]");
    EXPECT_THAT(blended.unsupported[0].materials, ElementsAre(0));
}

TEST_F(LoadSurfaceTest, TexturesAndSamplersAreRead) {
    const Scene scene = load_surface_gltf(
        make_gltf_with_material({{"pbrMetallicRoughness",
                                  {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}},
                                   {"metallicRoughnessTexture", {{"index", 1}}}}}}));
    const Material& material = scene.materials[0];
    ASSERT_TRUE(material.albedo_texture && material.roughness_texture);
    const Texture &colour = *material.albedo_texture, &rough = *material.roughness_texture;
    EXPECT_EQ(colour.image, rough.image) << "decoded once";
    EXPECT_EQ(colour.image->size, uvec2(3, 2));
    EXPECT_EQ(colour.image->texels, kLoadSurfacePicture.texels)
        << "row by row from the top, alpha apart";
    EXPECT_TRUE(colour.nearest && colour.srgb);
    EXPECT_EQ(colour.wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(colour.wrap_v, Texture::Wrap::mirrored);
    EXPECT_EQ(colour.uv_set, 1u);
    EXPECT_FALSE(rough.nearest || rough.srgb);
    EXPECT_EQ(rough.wrap_u, Texture::Wrap::repeat);
    EXPECT_EQ(rough.uv_set, 0u);
    EXPECT_EQ(rough.u_row, vec3(1, 0, 0));
    EXPECT_EQ(rough.v_row, vec3(0, 1, 0));
}

TEST_F(LoadSurfaceTest, TextureTransformsAreRead) {
    const auto transformed = [&](const Json& transform) {
        return *load_gltf_material({{"pbrMetallicRoughness",
                                     {{"baseColorTexture",
                                       {{"index", 0},
                                        {"texCoord", 0},
                                        {"extensions", {{"KHR_texture_transform", transform}}}}}}}})
                    .albedo_texture;
    };
    const auto at = [](const Texture& texture, double u, double v) {
        return std::pair(glm::dot(texture.u_row, vec3(u, v, 1)),
                         glm::dot(texture.v_row, vec3(u, v, 1)));
    };
    const Texture moved = transformed({{"offset", {.5, .25}}, {"scale", {2, 3}}});
    EXPECT_EQ(at(moved, 1, 1), std::pair(2.5f, 3.25f));
    // A rotation maps (u, v) to (c u + s v, -s u + c v), so a quarter turn takes (1, 0) to (0, -1).
    const Texture turned = transformed(
        {{"rotation", M_PI / 2}, {"scale", {2, 1}}, {"offset", {0, 1}}, {"texCoord", 1}});
    EXPECT_NEAR(at(turned, 1, 0).first, 0, 1e-6);
    EXPECT_NEAR(at(turned, 1, 0).second, -1, 1e-6);
    EXPECT_NEAR(at(turned, 0, 1).first, 1, 1e-6);
    EXPECT_EQ(turned.uv_set, 1u) << "the transform's own set wins";
}

TEST_F(LoadSurfaceTest, ImagesAreReadFromDataUrisFilesAndBufferViews) {
    const std::string png = encode_png(kLoadSurfacePicture);
    GltfFileBuilder gltf = make_gltf_with_material(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
    const auto texels = [&] {
        return load_surface_gltf(gltf).materials[0].albedo_texture->image->texels;
    };
    EXPECT_EQ(texels(), kLoadSurfacePicture.texels) << "a data URI";
    write_loaded_file("a b.png", png);
    gltf.root["images"] = {{{"uri", "a%20b.png"}}};
    EXPECT_EQ(texels(), kLoadSurfacePicture.texels) << "a file";
    EXPECT_EQ(load_surface_gltf(gltf).files.size(), 2u);
    gltf.root["images"] = {
        {{"bufferView", gltf.root["bufferViews"].size()}, {"mimeType", "image/png"}}};
    gltf.root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", gltf.data.size()}, {"byteLength", png.size()}});
    gltf.data += png;
    EXPECT_EQ(texels(), kLoadSurfacePicture.texels) << "a buffer view";
}

TEST_F(LoadSurfaceTest, GreyImagesWithAndWithoutAlphaAreDecoded) {
    const std::vector<std::uint8_t> grey = {0, 100, 255}, two = {10, 20, 30, 40};
    LoadAccount account({});
    const auto texels = [&](const ImageShape& shape, const std::vector<std::uint8_t>& values) {
        return decode_image(encode_png(shape, values), "", "x", account)->texels;
    };
    EXPECT_THAT(texels({{3, 1}, 1, {}}, grey), ElementsAre(0xff000000, 0xff646464, 0xffffffff));
    EXPECT_THAT(texels({{2, 1}, 2, {}}, two), ElementsAre(0x140a0a0a, 0x281e1e1e));
    EXPECT_EQ(decode_image("neither", "x.txt", "x", account), nullptr);
}

/// Returns a JPEG of two texels of the colour (200, 40, 10).
std::string make_two_texel_jpeg() {
    static constexpr char kJpegBytes[] =
        "\xff\xd8\xff\xe0\x00\x10\x4a\x46\x49\x46\x00\x01\x01\x00\x00\x01\x00\x01\x00\x00"
        "\xff\xdb\x00\x43\x00\x03\x02\x02\x03\x02\x02\x03\x03\x03\x03\x04\x03\x03\x04\x05"
        "\x08\x05\x05\x04\x04\x05\x0a\x07\x07\x06\x08\x0c\x0a\x0c\x0c\x0b\x0a\x0b\x0b\x0d"
        "\x0e\x12\x10\x0d\x0e\x11\x0e\x0b\x0b\x10\x16\x10\x11\x13\x14\x15\x15\x15\x0c\x0f"
        "\x17\x18\x16\x14\x18\x12\x14\x15\x14\xff\xdb\x00\x43\x01\x03\x04\x04\x05\x04\x05"
        "\x09\x05\x05\x09\x14\x0d\x0b\x0d\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14"
        "\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14"
        "\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\x14\xff\xc0"
        "\x00\x11\x08\x00\x01\x00\x02\x03\x01\x11\x00\x02\x11\x01\x03\x11\x01\xff\xc4\x00"
        "\x14\x00\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x07\xff"
        "\xc4\x00\x14\x10\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00"
        "\x00\xff\xc4\x00\x15\x01\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00"
        "\x00\x00\x07\x08\xff\xc4\x00\x14\x11\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00"
        "\x00\x00\x00\x00\x00\x00\xff\xda\x00\x0c\x03\x01\x00\x02\x11\x03\x11\x00\x3f\x00"
        "\x0a\x07\xad\xb7\xff\xd9";
    return {kJpegBytes, sizeof kJpegBytes - 1};
}

/// Returns a TIFF file of one texel, red 200, green 40, blue 10, alpha 128. The colours are not
/// multiplied by alpha.
std::string make_one_texel_tiff() {
    std::string bytes("II*\0\x08\0\0\0", 8);
    const auto add_word = [&](unsigned word) {
        bytes += static_cast<char>(word & 255U);
        bytes += static_cast<char>(word >> 8U);
    };
    constexpr unsigned kShort = 3, kLong = 4, kAfterTags = 8 + 2 + 10 * 12 + 4;
    const unsigned tags[10][4] = {{256, kLong, 1, 1},              // width
                                  {257, kLong, 1, 1},              // height
                                  {258, kShort, 4, kAfterTags},    // bits of each channel
                                  {259, kShort, 1, 1},             // no compression
                                  {262, kShort, 1, 2},             // RGB
                                  {273, kLong, 1, kAfterTags + 8}, // place of the texel
                                  {277, kShort, 1, 4},             // channels
                                  {278, kLong, 1, 1},              // rows
                                  {279, kLong, 1, 4},              // bytes
                                  {338, kShort, 1, 2}};            // alpha is unassociated
    add_word(10);
    for (const auto& [tag, type, count, value] : tags)
        for (const unsigned word : {tag, type, count, 0U, value, 0U}) add_word(word);
    add_word(0), add_word(0);
    for (int channel = 0; channel < 4; ++channel) add_word(8);
    return bytes + "\xc8\x28\x0a\x80";
}

TEST_F(LoadSurfaceTest, ColoursOfImagesAreNotMultipliedByAlpha) {
    LoadAccount account({});
    const std::shared_ptr<const Image> image = decode_image(make_one_texel_tiff(), "", "x",
                                                            account);
    ASSERT_TRUE(image);
    EXPECT_THAT(image->texels, testing::ElementsAre(0x800a28c8U));
}

TEST_F(LoadSurfaceTest, JpegImagesAreDecoded) {
    LoadAccount account({});
    const std::shared_ptr<const Image> image = decode_image(make_two_texel_jpeg(), "", "x",
                                                            account);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->size, uvec2(2, 1));
    for (const std::uint32_t texel : image->texels) {
        EXPECT_NEAR(texel & 255, 200, 3);
        EXPECT_NEAR(texel >> 8 & 255, 40, 3);
        EXPECT_NEAR(texel >> 16 & 255, 10, 3);
        EXPECT_EQ(texel >> 24, 255u);
    }
    std::string cut = make_two_texel_jpeg();
    cut.resize(cut.size() / 2);
    EXPECT_THAT(test::catch_error_text(Failure::bad_data,
                                       [&] { decode_image(cut, "cut.jpg", "x", account); }),
                HasSubstr("wanted a flat picture"));
}

TEST_F(LoadSurfaceTest, NormalTexturesAreReadWithTheirScale) {
    const Material plain = load_gltf_material(Json::object());
    EXPECT_FALSE(plain.normal_texture);
    EXPECT_EQ(plain.normal_scale, 1);
    GltfFileBuilder gltf = make_gltf_with_material(
        {{"normalTexture", {{"index", 0}, {"texCoord", 1}, {"scale", -2.5}}}});
    const Scene scene = load_surface_gltf(gltf);
    ASSERT_TRUE(scene.materials[0].normal_texture);
    EXPECT_FALSE(scene.materials[0].normal_texture->srgb);
    EXPECT_EQ(scene.materials[0].normal_texture->uv_set, 1u);
    EXPECT_EQ(scene.materials[0].normal_scale, -2.5f);
    EXPECT_THAT(list_unsupported_feature_ids(scene),
                testing::Not(testing::Contains("normal-texture")));
}

TEST_F(LoadSurfaceTest, ImagesWithSidesOver65535TexelsAreRefused) {
    LoadAccount account({});
    const auto decode = [&](uvec2 size) {
        const Image image{.size = size, .texels = std::vector<std::uint32_t>(size.x * size.y)};
        return decode_image(encode_png(image), "", "x", account)->size;
    };
    EXPECT_EQ(decode({65535, 1}), uvec2(65535, 1));
    EXPECT_THAT(test::catch_error_text(Failure::bad_data,
                                       [&] {
                                           decode({1, 65536});
                                       }),
                HasSubstr("x: wanted sides of at most 65535 texels, found 1x65536"));
}

TEST_F(LoadSurfaceTest, MissingImageIsListedAndTheColourFactorStays) {
    GltfFileBuilder gltf = make_gltf_with_material(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {.5, .5, .5, 1}}, {"baseColorTexture", {{"index", 0}}}}},
         {"emissiveTexture", {{"index", 0}}},
         {"emissiveFactor", {1, 1, 1}}});
    gltf.root["images"] = {{{"uri", "gone.png"}}};
    const Scene scene = load_surface_gltf(gltf);
    EXPECT_FALSE(scene.materials[0].albedo_texture);
    EXPECT_EQ(scene.materials[0].albedo, vec3(.5f));
    EXPECT_THAT(list_unsupported_feature_ids(scene), ElementsAre("missing-image"));
    EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("'gone.png' is not there")));
}

TEST_F(LoadSurfaceTest, TexelBudgetIsCheckedBeforeDecoding) {
    // The PNG header claims 60000 x 60000 texels, for which the file has no data.
    const std::string png = encode_png(kLoadSurfacePicture);
    std::string huge = png;
    for (const std::size_t at : {16u, 20u}) huge.replace(at, 4, std::string("\0\0\xea\x60", 4));
    const auto crc = [](std::string_view bytes) {
        std::uint32_t state = ~0u;
        for (const char byte : bytes) {
            state ^= std::uint8_t(byte);
            for (int bit = 0; bit < 8; ++bit) state = state >> 1 ^ (state & 1 ? 0xedb88320u : 0);
        }
        return ~state;
    };
    const std::uint32_t sum = crc(std::string_view(huge).substr(12, 17));
    for (int i = 0; i < 4; ++i) huge[29 + std::size_t(i)] = static_cast<char>(sum >> (24 - 8 * i));
    GltfFileBuilder gltf = make_gltf_with_material(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    gltf.root["images"] = {{{"uri", "data:image/png;base64," + encode_as_base64(huge)}}};
    EXPECT_THAT(load_error_text("x.glb", gltf.glb_bytes()),
                HasSubstr("images[0]: wanted at most 67108864 texels in pictures, the budget of a "
                          "scene, found 3600000000"));
    EXPECT_THAT(load_error_text("x.glb",
                                make_gltf_with_material({{"pbrMetallicRoughness",
                                                          {{"baseColorTexture", {{"index", 0}}}}}})
                                    .glb_bytes(),
                                Failure::bad_data, {.budget = {.texels = 5}}),
                HasSubstr("wanted at most 5 texels in pictures"));
}

TEST_F(LoadSurfaceTest, UnsupportedMaterialFeaturesAreListed) {
    const Scene scene = load_surface_gltf(
        make_gltf_with_material({{"name", "all"},
                                 {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                 {"normalTexture", {{"index", 0}}},
                                 {"occlusionTexture", {{"index", 0}}},
                                 {"extensions",
                                  {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}},
                                   {"KHR_materials_sheen", Json::object()},
                                   {"KHR_materials_anisotropy", {{"anisotropyStrength", 1}}},
                                   {"KHR_materials_iridescence", {{"iridescenceFactor", 0}}},
                                   {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                   {"KHR_materials_volume", Json::object()},
                                   {"KHR_materials_dispersion", Json::object()}}}}));
    EXPECT_THAT(list_unsupported_feature_ids(scene),
                testing::UnorderedElementsAre("occlusion-texture", "clearcoat", "sheen",
                                              "anisotropy", "glass-approximated", "glass-shadow",
                                              "rough-glass"));
    for (const UnsupportedFeature& gap : scene.unsupported) {
        EXPECT_EQ(gap.first, "materials[0] 'all'");
        EXPECT_EQ(gap.count, 1u) << gap.id;
    }
}

TEST_F(LoadSurfaceTest, ClearCoatsThatAreLeftOutAreListed) {
    const auto gaps = [&](Json material, const Json& coat) {
        material["extensions"]["KHR_materials_clearcoat"] = coat;
        return list_unsupported_feature_ids(load_surface_gltf(make_gltf_with_material(material)));
    };
    using testing::ElementsAre, testing::IsEmpty;
    const Json full = {{"clearcoatFactor", 1}};
    EXPECT_THAT(gaps(Json::object(), full), IsEmpty());
    EXPECT_THAT(gaps({{"normalTexture", {{"index", 0}}}}, full), ElementsAre("clearcoat-texture"));
    EXPECT_THAT(gaps(Json::object(),
                     {{"clearcoatFactor", 1}, {"clearcoatRoughnessTexture", {{"index", 0}}}}),
                ElementsAre("clearcoat-texture"));
    const Json unlit = {{"extensions", {{"KHR_materials_unlit", Json::object()}}}};
    EXPECT_THAT(gaps(unlit, full), ElementsAre("clearcoat"));
    EXPECT_THAT(gaps(unlit, {{"clearcoatFactor", 0}}), IsEmpty()) << "there is no coat";
    EXPECT_THAT(gaps({{"extras", {{"catoptric", {{"reflectance", {1, 1, 1}}}}}}}, full),
                ElementsAre("clearcoat"));
    const Material metal = load_gltf_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}},
         {"extensions", {{"KHR_materials_clearcoat", full}}}});
    EXPECT_FALSE(metal.mirror) << "a mirror by its reflectance has no coat";
    EXPECT_TRUE(has_clear_coat(metal));
}

TEST_F(LoadSurfaceTest, MetalWithTransmissionIsNoGlass) {
    const auto gaps = [&](const Json& pbr) {
        const Scene scene = load_surface_gltf(make_gltf_with_material(
            {{"pbrMetallicRoughness", pbr},
             {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}));
        EXPECT_EQ(is_glass(scene.materials[0]), list_unsupported_feature_ids(scene).size() >= 2);
        return list_unsupported_feature_ids(scene);
    };
    using testing::ElementsAre, testing::IsEmpty;
    EXPECT_THAT(gaps({{"metallicFactor", 1}}), IsEmpty());
    EXPECT_THAT(gaps(Json::object()), IsEmpty()) << "glTF's default is a metal";
    EXPECT_THAT(gaps({{"metallicFactor", .5}}), ElementsAre("partial-glass"));
    EXPECT_EQ(
        list_unsupported_feature_ids(load_surface_gltf(make_gltf_with_material(
            {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
             {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", .25}}}}}}))),
        std::vector<std::string>{"partial-glass"});
    EXPECT_THAT(gaps({{"metallicFactor", 0}}),
                ElementsAre("glass-approximated", "glass-shadow", "rough-glass"))
        << "roughness is 1";
    EXPECT_THAT(gaps({{"metallicFactor", 0}, {"roughnessFactor", 0}}),
                ElementsAre("glass-approximated", "glass-shadow"));
    const Material clear = load_gltf_material(
        {{"alphaMode", "BLEND"},
         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
         {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
    EXPECT_FALSE(clear.blended || has_alpha_mask(clear))
        << "light passes glass, whatever its alpha";
    EXPECT_THAT(gaps({{"metallicFactor", 1}, {"metallicRoughnessTexture", {{"index", 0}}}}),
                ElementsAre("partial-glass"))
        << "blue is below 1 in some texels";
}

TEST_F(LoadSurfaceTest, GlassIsReadAsAnIndexOfRefractionAndAnAbsorption) {
    const auto read = [&](const Json& volume) {
        return load_surface_gltf(
                   make_gltf_with_material(
                       {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                        {"extensions",
                         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                          {"KHR_materials_ior", {{"ior", 1.33}}},
                          {"KHR_materials_volume", volume}}}}))
            .materials[0];
    };
    const Material body = read(
        {{"thicknessFactor", .1}, {"attenuationDistance", 2}, {"attenuationColor", {1, .5, .25}}});
    EXPECT_FLOAT_EQ(body.ior, 1.33f);
    EXPECT_TRUE(body.solid);
    EXPECT_EQ(body.absorption.x, 0);
    EXPECT_NEAR(std::exp(-2 * body.absorption.y), .5, 1e-6);
    EXPECT_NEAR(std::exp(-2 * body.absorption.z), .25, 1e-6);
    EXPECT_FALSE(read({{"attenuationDistance", 2}}).solid) << "a thickness of 0 is a thin sheet";
    EXPECT_THROW(read({{"thicknessFactor", -1}}), Error);
    EXPECT_THROW(read({{"thicknessFactor", 1}, {"attenuationDistance", -1}}), Error);

    // Scene files of both formats, glTF and OBJ, keep the properties of glass.
    Scene scene{.name = "glass"};
    scene::add_quad(scene, "pane", scene::add_material(scene, body), {0, 0, 0}, {1, 0, 0},
                    {1, 1, 0}, {0, 1, 0});
    for (const char* file : {"glass.glb", "glass.obj"}) {
        const bool is_obj = std::string(file).ends_with("obj");
        if (is_obj)
            save_obj(scene, folder / file);
        else
            save_glb(scene, folder / file);
        const Material again = load((folder / file).string()).materials[0];
        EXPECT_TRUE(is_glass(again)) << file;
        EXPECT_FLOAT_EQ(again.ior, 1.33f) << file;
        EXPECT_TRUE(again.solid) << file;
        if (!is_obj) {
            EXPECT_LT(glm::length(again.absorption - body.absorption), 1e-6f);
        }
    }
}

} // namespace
