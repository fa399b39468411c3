// Tests of invalid .gltf, .glb and .obj files, each with one error. The message names place,
// expected and found value.
#include "unit/load_fixture.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace {

using namespace test::loading;

class LoadRefusalTest : public Load {
protected:
    using Change = std::function<void(GltfFileBuilder&)>;
    std::string load_broken_gltf(const Change& change) const {
        GltfFileBuilder gltf = make_small_gltf();
        change(gltf);
        return load_error_text("x.glb", gltf.glb_bytes());
    }
    /// Loads the small file with `value` put at the JSON pointer, and returns the error message.
    std::string load_broken_gltf(const char* pointer, const Json& value) const {
        return load_broken_gltf(
            [&](GltfFileBuilder& gltf) { gltf.root[Json::json_pointer(pointer)] = value; });
    }
};

TEST_F(LoadRefusalTest, UnchangedSmallFileLoads) {
    EXPECT_EQ(triangle_count(load(write_loaded_file("x.glb", make_small_gltf().glb_bytes()))), 1u);
}

TEST_F(LoadRefusalTest, IndicesOutOfRangeAreRefused) {
    EXPECT_THAT(load_broken_gltf("/scene", 1),
                HasSubstr("scene: wanted an index below 1, found 1"));
    EXPECT_THAT(load_broken_gltf("/scenes/0/nodes/0", 7),
                HasSubstr("scenes[0]: nodes: wanted an index below 1"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/mesh", 1),
                HasSubstr("nodes[0] 'n': mesh: wanted an index below 1"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/camera", 0),
                HasSubstr("camera: wanted an index below 0, found 0"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/children", {3}),
                HasSubstr("children: wanted an index below 1"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/skin", 0), HasSubstr("skin: wanted an index below 0"));
    EXPECT_THAT(load_broken_gltf("/meshes/0/primitives/0/material", 0),
                HasSubstr("meshes[0] 'm': primitives[0]: material: wanted an index below 0"));
    EXPECT_THAT(load_broken_gltf("/meshes/0/primitives/0/indices", 2),
                HasSubstr("wanted an index below 2"));
    EXPECT_THAT(load_broken_gltf("/meshes/0/primitives/0/attributes/POSITION", 9),
                HasSubstr("found 9"));
    EXPECT_THAT(load_broken_gltf("/meshes/0/primitives/0/attributes/TEXCOORD_0", 9),
                HasSubstr("TEXCOORD_0"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/bufferView", 9),
                HasSubstr("accessors[0]: bufferView"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/buffer", 9), HasSubstr("bufferViews[0]: buffer"));
    EXPECT_THAT(load_broken_gltf("/textures", {{{"source", 0}}}), HasSubstr("textures[0]: source"));
    EXPECT_THAT(load_broken_gltf("/images", {{{"bufferView", 9}}}),
                HasSubstr("images[0]: bufferView"));
    EXPECT_THAT(load_broken_gltf("/skins", {{{"joints", {4}}}}), HasSubstr("skins[0]: joints"));
    EXPECT_THAT(load_broken_gltf("/materials", {{{"normalTexture", {{"index", 0}}}}}),
                HasSubstr("materials[0]: normalTexture: index: wanted an index below 0"));
}

TEST_F(LoadRefusalTest, ValuesOfTheWrongKindAreRefused) {
    EXPECT_THAT(load_broken_gltf("/nodes/0/mesh", "0"),
                HasSubstr("wanted a whole number of at least 0, found \"0\""));
    EXPECT_THAT(load_broken_gltf("/nodes/0/mesh", -1), HasSubstr("found -1"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/mesh", .5), HasSubstr("found 0.5"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/name", 5), HasSubstr("wanted a text, found 5"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/scale", {1, 1}), HasSubstr("wanted 3 numbers, found 2"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/scale", {1, 1, "1"}),
                HasSubstr("wanted numbers, found \"1\""));
    EXPECT_THAT(load_broken_gltf("/nodes/0/matrix", {1, 2, 3}),
                HasSubstr("wanted 16 numbers, found 3"));
    EXPECT_THAT(load_broken_gltf("/nodes/0", 3), HasSubstr("nodes[0]: wanted an object, found 3"));
    EXPECT_THAT(load_broken_gltf("/nodes", Json::object()),
                HasSubstr("nodes: wanted an array, found an object"));
    EXPECT_THAT(load_broken_gltf("/meshes/0/primitives/0/mode", 7),
                HasSubstr("mode: wanted 0 to 6, found 7"));
    EXPECT_THAT(load_broken_gltf("/materials", {{{"alphaMode", "GLOW"}}}),
                HasSubstr("found \"GLOW\""));
    EXPECT_THAT(load_broken_gltf("/extensionsRequired", {"KHR_x\x1b"}),
                HasSubstr("found \"KHR_x\\x1b\""));
    EXPECT_THAT(load_broken_gltf("/extensionsRequired", 3),
                HasSubstr("extensionsRequired: wanted an array"));
    EXPECT_THAT(load_error_text("x.gltf", "[]"), HasSubstr("wanted an object, found an array"));
    EXPECT_THAT(load_error_text("x.gltf", "{\"asset\":{\"version\":\"2.0\"},\"x\":1e999}"),
                HasSubstr("wanted a number that a double can hold, found '1e999'"));
    const std::string endless = load_error_text("x.gltf", "{\"" + std::string(1 << 20, 'x'));
    EXPECT_LT(endless.size(), 500u) << "a message, not the file";
}

TEST_F(LoadRefusalTest, NodesThatFormNoForestAreRefused) {
    const auto nodes = [&](const Json& list, const Json& roots = {0}) {
        return load_broken_gltf([&](GltfFileBuilder& gltf) {
            gltf.root["nodes"] = list, gltf.root["scenes"][0]["nodes"] = roots;
        });
    };
    const Json leaf = {{"mesh", 0}};
    const auto above = [](const Json& children) { return Json{{"children", children}}; };
    EXPECT_THAT(nodes({above({2}), above({2}), leaf}),
                HasSubstr("nodes[2]: wanted one parent at most, found nodes[0] and nodes[1]"));
    EXPECT_THAT(nodes({above({1, 1}), leaf}), HasSubstr("found nodes[0] and nodes[0]"));
    EXPECT_THAT(nodes({leaf, above({2}), above({1})}), HasSubstr("nodes[1]: wanted a tree"));
    EXPECT_THAT(nodes({above({1}), leaf}, {0, 1}), HasSubstr("second way"));
}

TEST_F(LoadRefusalTest, TooDeeplyNestedNodesAreRefused) {
    const auto chain = [&](std::size_t depth) {
        GltfFileBuilder gltf = make_small_gltf();
        for (std::size_t i = 0; i + 1 < depth; ++i) gltf.root["nodes"][i] = {{"children", {i + 1}}};
        gltf.root["nodes"][depth - 1] = {{"mesh", 0}};
        return gltf.glb_bytes();
    };
    EXPECT_EQ(load(write_loaded_file("x.glb", chain(4096))).objects.size(), 1u);
    for (const std::size_t depth : {4097, 20000})
        EXPECT_THAT(load_error_text("x.glb", chain(depth)),
                    HasSubstr("nodes[4096]: wanted at most 4096 nodes one in another"));
}

TEST_F(LoadRefusalTest, RotationsWithoutAFiniteLengthAreRefused) {
    EXPECT_THAT(load_broken_gltf("/nodes/0/rotation", {0, 0, 0, 0}),
                AllOf(HasSubstr("nodes[0] 'n': rotation: wanted a quaternion with a length"),
                      HasSubstr("found 0")));
    EXPECT_THAT(load_broken_gltf("/nodes/0/rotation", {1e308, 1e308, 1e308, 1e308}),
                HasSubstr("rotation"));
}

TEST_F(LoadRefusalTest, InvalidAccessorsAndBufferViewsAreRefused) {
    EXPECT_THAT(load_broken_gltf("/accessors/0/count", 0),
                HasSubstr("count: wanted at least 1, found 0"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/count", 5), HasSubstr("wanted 5 elements"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/count", 1ull << 62), HasSubstr("holds 4"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/byteOffset", 4), HasSubstr("holds 3"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/byteOffset", ~0ull), HasSubstr("holds 0"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/type", "VEC5"), HasSubstr("found \"VEC5\""));
    EXPECT_THAT(load_broken_gltf("/accessors/0/type", "VEC2"),
                HasSubstr("POSITION: wanted an accessor of VEC3, found VEC2"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/componentType", 5127), HasSubstr("found 5127"));
    EXPECT_THAT(load_broken_gltf("/accessors/0/componentType", 5125),
                HasSubstr("wanted floats, found component type 5125"));
    EXPECT_THAT(load_broken_gltf("/accessors/1/componentType", 5122),
                HasSubstr("wanted component type 5121, 5123 or 5125"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/byteLength", 4096),
                HasSubstr("wanted 4096 bytes"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/byteOffset", ~0ull),
                HasSubstr("found a buffer of"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/byteLength", 0), HasSubstr("at least 1"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/byteStride", 8), HasSubstr("wanted 4 elements"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/byteStride", 3),
                HasSubstr("multiple of 4 from 4 to 252, found 3"));
    EXPECT_THAT(load_broken_gltf("/bufferViews/0/byteStride", 256), HasSubstr("found 256"));
    EXPECT_THAT(load_broken_gltf("/buffers", {{{"byteLength", 4096}}}),
                HasSubstr("buffers[0]: byteLength: wanted 1 to"));
    EXPECT_THAT(load_broken_gltf("/buffers", {{{"byteLength", 0}}}), HasSubstr("found 0"));
    EXPECT_THAT(load_broken_gltf([](GltfFileBuilder& gltf) {
                    gltf.root["buffers"] = {{{"byteLength", 56}}, {{"byteLength", 4}}};
                }),
                HasSubstr("buffers[1]: wanted a uri"));
    EXPECT_THAT(load_broken_gltf([](GltfFileBuilder& gltf) {
                    gltf.add_accessor<float>({1}, "SCALAR", 5126),
                        gltf.root["accessors"][2]["count"] = 2;
                }),
                HasSubstr("accessors[2]: wanted 2 elements"))
        << "though nothing uses it";
}

TEST_F(LoadRefusalTest, InvalidSparseAccessorsAreRefused) {
    const auto sparse = [&](const Json& is) {
        return load_broken_gltf(
            [&](GltfFileBuilder& gltf) { gltf.root["accessors"][0]["sparse"] = is; });
    };
    const Json indices = {{"bufferView", 1}, {"componentType", 5123}}, values = {{"bufferView", 0}};
    EXPECT_THAT(sparse({{"count", 0}, {"indices", indices}, {"values", values}}),
                HasSubstr("wanted 1 to 4"));
    EXPECT_THAT(sparse({{"count", 5}, {"indices", indices}, {"values", values}}),
                HasSubstr("wanted 1 to 4"));
    EXPECT_THAT(sparse({{"count", 4}, {"indices", indices}, {"values", values}}),
                HasSubstr("holds 3"));
    EXPECT_THAT(sparse({{"count", 1}}), HasSubstr("wanted indices and values"));
    EXPECT_THAT(load_broken_gltf([](GltfFileBuilder& gltf) {
                    const std::size_t places = gltf.add_accessor<std::uint16_t>({4}, "SCALAR",
                                                                                5123);
                    gltf.root["accessors"][0]["sparse"] = {
                        {"count", 1},
                        {"indices",
                         {{"bufferView", gltf.root["accessors"][places]["bufferView"]},
                          {"componentType", 5123}}},
                        {"values", {{"bufferView", 0}}}};
                }),
                HasSubstr("accessors[0]: sparse: indices: wanted places below 4, found 4"));
    EXPECT_THAT(load_broken_gltf([](GltfFileBuilder& gltf) {
                    gltf.root["accessors"][0].erase("bufferView");
                    gltf.root["accessors"][0]["count"] = 4'000'000'000;
                }),
                HasSubstr("accessors[0]: wanted at most 134217728 bytes of sparse accessors"));
}

TEST_F(LoadRefusalTest, AttributesOfTheWrongTypeOrCountAreRefused) {
    const auto attribute = [&](const char* name, std::size_t accessor) {
        return load_broken_gltf(("/meshes/0/primitives/0/attributes/" + std::string(name)).c_str(),
                                accessor);
    };
    EXPECT_THAT(attribute("NORMAL", 1),
                HasSubstr("NORMAL: wanted an accessor of VEC3, found SCALAR"));
    EXPECT_THAT(attribute("TEXCOORD_0", 0),
                HasSubstr("TEXCOORD_0: wanted an accessor of VEC2, found VEC3"));
    EXPECT_THAT(attribute("TANGENT", 1), HasSubstr("TANGENT: wanted an accessor of VEC4"));
    EXPECT_THAT(attribute("COLOR_0", 1), HasSubstr("COLOR_0"));
    EXPECT_THAT(load_broken_gltf([](GltfFileBuilder& gltf) {
                    const std::size_t normals = gltf.add_accessor<float>({0, 0, 1}, "VEC3", 5126);
                    gltf.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
                }),
                HasSubstr("wanted 4 normals, one for each position, found 1"));
    EXPECT_THAT(load_broken_gltf("/meshes/0/primitives/0/attributes", Json::object()),
                HasSubstr("found none")); // the only primitive is left out
}

TEST_F(LoadRefusalTest, IndexValuesWithoutAVertexAreRefused) {
    const auto indices = [&](auto values, int component) {
        return load_broken_gltf([&](GltfFileBuilder& gltf) {
            gltf.root["meshes"][0]["primitives"][0]["indices"] = gltf.add_accessor(values, "SCALAR",
                                                                                   component);
        });
    };
    EXPECT_THAT(indices(std::vector<std::uint16_t>{0, 1, 4}, 5123),
                HasSubstr("meshes[0] 'm': indices: wanted indices below 4, found 4"));
    EXPECT_THAT(indices(std::vector<std::uint32_t>{0, 1, 4294967295u}, 5125),
                HasSubstr("found 4294967295"));
    EXPECT_THAT(indices(std::vector<std::uint8_t>{0, 1, 255}, 5121), HasSubstr("found 255"));
    EXPECT_THAT(indices(std::vector<std::uint16_t>{0, 1}, 5123), HasSubstr("three corners"));
    // In glTF, the largest value of an index type restarts the primitive, and is no vertex number.
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = gltf.add_accessor(
        std::vector<float>(3 * 256), "VEC3", 5126);
    gltf.root["meshes"][0]["primitives"][0]["indices"] = gltf.add_accessor(
        std::vector<std::uint8_t>{0, 1, 255}, "SCALAR", 5121);
    EXPECT_THAT(
        load_error_text("x.glb", gltf.glb_bytes()),
        HasSubstr(
            "meshes[0] 'm': indices: wanted a vertex, found 255, which begins a new primitive"));
}

TEST_F(LoadRefusalTest, NonFiniteNumbersAreRefused) {
    for (const float number : {std::numeric_limits<float>::quiet_NaN(), HUGE_VALF})
        for (const char* name : {"POSITION", "NORMAL"})
            EXPECT_THAT(load_broken_gltf([&](GltfFileBuilder& gltf) {
                            gltf.root["meshes"][0]["primitives"][0]["attributes"][name] =
                                gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, number, 1},
                                                         "VEC3", 5126);
                        }),
                        AllOf(HasSubstr(name), HasSubstr("element 3: wanted finite numbers")));
}

TEST_F(LoadRefusalTest, InvalidMeshesThatNoNodeShowsAreRefused) {
    EXPECT_THAT(
        load_broken_gltf([](GltfFileBuilder& gltf) {
            const std::size_t wrong = gltf.add_accessor<std::uint16_t>({0, 1, 9}, "SCALAR", 5123);
            gltf.root["meshes"].push_back(
                {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", wrong}}}}});
        }),
        HasSubstr("meshes[1]: indices: wanted indices below 4, found 9"));
}

TEST_F(LoadRefusalTest, InvalidCamerasAreRefused) {
    const auto camera = [&](const Json& is) {
        return load_broken_gltf([&](GltfFileBuilder& gltf) { gltf.root["cameras"] = {is}; });
    };
    const auto angle = [](const Json& yfov) {
        return Json{{"type", "perspective"}, {"perspective", {{"yfov", yfov}}}};
    };
    EXPECT_THAT(
        camera(angle(0)),
        HasSubstr("cameras[0]: perspective: yfov: wanted an angle between 0 and pi, found 0"));
    EXPECT_THAT(camera(angle(3.1416)), HasSubstr("found 3.1416"));
    EXPECT_THAT(camera(angle(-1)), HasSubstr("found -1"));
    EXPECT_THAT(camera({{"type", "fisheye"}}), HasSubstr("perspective or orthographic"));
    EXPECT_THAT(camera({{"type", "perspective"}}), HasSubstr("perspective or orthographic"));
    EXPECT_THAT(
        load_broken_gltf([&](GltfFileBuilder& gltf) {
            gltf.root["cameras"] = {angle(1)};
            gltf.root["nodes"].push_back({{"name", "c"}, {"camera", 0}, {"scale", {1, 0, 1}}});
            gltf.root["scenes"][0]["nodes"].push_back(1);
        }),
        HasSubstr("nodes[1] 'c': wanted a camera's node with three axes"));
}

TEST_F(LoadRefusalTest, InvalidAnimationsAreRefused) {
    const auto animated = [&](const std::vector<float>& times, const std::vector<float>& values,
                              const Json& sampler = {}, const Json& channel = {}) {
        return load_broken_gltf([&](GltfFileBuilder& gltf) {
            Json its = {{"input", gltf.add_accessor(times, "SCALAR", 5126)},
                        {"output", gltf.add_accessor(values, "VEC3", 5126)}};
            its.update(sampler.is_null() ? Json::object() : sampler);
            Json to = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
            to.update(channel.is_null() ? Json::object() : channel);
            gltf.root["animations"] = {{{"samplers", {its}}, {"channels", {to}}}};
        });
    };
    const std::vector<float> times = {0, 1}, values(6);
    EXPECT_THAT(animated({0, 0}, values),
                HasSubstr("animations[0]: samplers[0]: input: wanted increasing times"));
    EXPECT_THAT(animated({-1, 0}, values), HasSubstr("found -1"));
    EXPECT_THAT(animated({0, NAN}, values), HasSubstr("wanted finite numbers"));
    EXPECT_THAT(animated(times, {0, 0, 0}),
                HasSubstr("wanted 1 values for each of 2 keys, found 1"));
    EXPECT_THAT(animated(times, values, {{"interpolation", "CUBICSPLINE"}}),
                HasSubstr("wanted 3 values"));
    EXPECT_THAT(animated(times, values, {{"interpolation", "SMOOTH"}}),
                HasSubstr("found \"SMOOTH\""));
    EXPECT_THAT(animated(times, values, {{"output", 1}}),
                HasSubstr("output: wanted an accessor of VEC3"));
    EXPECT_THAT(animated(times, values, {{"input", 9}}),
                HasSubstr("input: wanted an index below 4"));
    EXPECT_THAT(animated(times, values, {}, {{"sampler", 1}}),
                HasSubstr("channels[0]: sampler: wanted an index below 1"));
    EXPECT_THAT(animated(times, values, {}, {{"target", {{"node", 5}, {"path", "translation"}}}}),
                HasSubstr("target: node: wanted an index below 1"));
    EXPECT_THAT(animated(times, values, {}, {{"target", {{"node", 0}, {"path", "rotation"}}}}),
                HasSubstr("output: wanted an accessor of VEC4, found VEC3"));
    EXPECT_THAT(load_broken_gltf([](GltfFileBuilder& gltf) {
                    const std::size_t input = gltf.add_accessor<float>({0}, "SCALAR", 5126);
                    const std::size_t output = gltf.add_accessor<float>({0, 0, 0, 0}, "VEC4", 5126);
                    gltf.root["animations"] = {
                        {{"samplers", {{{"input", input}, {"output", output}}}},
                         {"channels",
                          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
                }),
                HasSubstr("samplers[0]: output: wanted quaternions with a length, found 0"));
}

TEST_F(LoadRefusalTest, UnknownAnimationNameIsRefused) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["animations"] = {
        {{"name", "walk"}, {"samplers", Json::array()}, {"channels", Json::array()}}};
    EXPECT_THAT(load_error_text("x.glb", gltf.glb_bytes(), Failure::usage, {.animation = "wolk"}),
                AllOf(HasSubstr("has no animation 'wolk': wanted none or one of 'walk'"),
                      HasSubstr("did you mean 'walk'")));
}

TEST_F(LoadRefusalTest, RequiredCompressionAndUnknownExtensionsAreRefused) {
    const auto required = [&](const char* name) {
        return load_broken_gltf("/extensionsRequired", Json::array({name}));
    };
    EXPECT_THAT(required("KHR_texture_basisu"),
                AllOf(HasSubstr("textures compressed by Basis Universal are not read"),
                      HasSubstr("python3 samples/scenes/unpack_ktx2.py FILE")));
    EXPECT_THAT(required("EXT_texture_avif"), HasSubstr("AVIF textures are not read"));
    EXPECT_THAT(required("MSFT_texture_dds"), HasSubstr("DDS textures are not read"));
    EXPECT_THAT(required("KHR_node_visibility"),
                AllOf(HasSubstr("extensionsRequired: wanted KHR_materials_*"),
                      HasSubstr("found \"KHR_node_visibility\"")));
    for (const char* name : {"KHR_materials_clearcoat", "KHR_texture_transform",
                             "KHR_mesh_quantization", "KHR_lights_punctual"}) {
        GltfFileBuilder gltf = make_small_gltf();
        gltf.root["extensionsRequired"] = {name};
        EXPECT_EQ(triangle_count(load(write_loaded_file("x.glb", gltf.glb_bytes()))), 1u) << name;
    }
}

TEST_F(LoadRefusalTest, InvalidLightsAreRefused) {
    const auto light = [&](const Json& is) {
        return load_broken_gltf([&](GltfFileBuilder& gltf) {
            gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {is};
        });
    };
    EXPECT_THAT(light({{"type", "lava"}}),
                HasSubstr("extensions: KHR_lights_punctual: lights[0]: type: wanted point, spot or "
                          "directional, found \"lava\""));
    EXPECT_THAT(light({{"type", "point"}, {"intensity", -1}}), HasSubstr("at least 0"));
    EXPECT_THAT(light({{"type", "point"}, {"range", 0}}),
                HasSubstr("range: wanted a number above 0, found 0"));
    EXPECT_THAT(
        light({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}, {"outerConeAngle", .5}}}}),
        HasSubstr("spot: wanted angles with 0 <= inner <= outer <= pi / 2, found 1 and 0.5"));
    EXPECT_THAT(load_broken_gltf("/nodes/0/extensions", {{"KHR_lights_punctual", {{"light", 0}}}}),
                HasSubstr("KHR_lights_punctual: light: wanted an index below 0, found 0"));
}

TEST_F(LoadRefusalTest, InvalidMaterialsAndImagesAreRefused) {
    const auto material = [&](const Json& is) {
        return load_broken_gltf([&](GltfFileBuilder& gltf) {
            gltf.root["materials"] = {is};
            gltf.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
            gltf.root["samplers"] = {{{"wrapS", 5}}};
            gltf.root["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgoAAAA="}}};
        });
    };
    const Json use = {{"index", 0}};
    EXPECT_THAT(material({{"pbrMetallicRoughness", {{"baseColorTexture", use}}}}),
                HasSubstr("samplers[0]: wrapS: wanted 10497, 33071 or 33648, found 5"));
    EXPECT_THAT(material({{"alphaCutoff", -1}}), HasSubstr("alphaCutoff: wanted at least 0"));
    EXPECT_THAT(material({{"emissiveFactor", {-1, 0, 0}}}),
                HasSubstr("materials[0]: wanted an emission of at least 0"));
    EXPECT_THAT(material({{"extensions", {{"KHR_materials_ior", {{"ior", .5}}}}}}),
                HasSubstr("wanted an ior of 0 or from 1 on, found 0.5"));
    EXPECT_THAT(
        load_broken_gltf([&](GltfFileBuilder& gltf) {
            gltf.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", use}}}}};
            gltf.root["textures"] = {{{"source", 0}}};
            gltf.root["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgoAAAA="}}};
        }),
        HasSubstr("images[0]: cannot be decoded"));
}

TEST_F(LoadRefusalTest, ExposuresOutOfRangeAreRefused) {
    EXPECT_THAT(load_broken_gltf("/scenes/0/extras", Json{{"catoptric", {{"exposure", 65}}}}),
                HasSubstr("exposure: wanted -64 to 64, found 65"));
    EXPECT_THAT(load_error_text("x.obj", "# catoptric exposure -1e9\n"),
                HasSubstr("x.obj:1: exposure wants -64 to 64, found -1e+09"));
}

TEST_F(LoadRefusalTest, GlbHeadersThatContradictTheFileAreRefused) {
    const std::string whole = make_small_gltf().glb_bytes();
    const auto with = [&](std::size_t at, std::uint32_t word) {
        std::string bytes = whole;
        std::memcpy(bytes.data() + at, &word, 4);
        return load_error_text("x.glb", bytes);
    };
    std::uint32_t length = 0;
    std::memcpy(&length, whole.data() + 12, 4);
    EXPECT_THAT(with(4, 1), HasSubstr("wanted GLB version 2, found 1"));
    EXPECT_THAT(with(8, 12), HasSubstr("header: wanted 12 bytes"));
    EXPECT_THAT(with(12, ~0u),
                HasSubstr("first chunk: wanted JSON of at most " +
                          std::to_string(whole.size() - 20) + " bytes, found 4294967295"));
    EXPECT_THAT(with(16, 7), HasSubstr("first chunk"));
    EXPECT_THAT(with(20 + length, ~0u), HasSubstr("second chunk"));
    EXPECT_THAT(with(20 + length + 4, 7), HasSubstr("neither")) << "no binary chunk";
    EXPECT_THAT(load_error_text("x.glb", whole.substr(0, whole.size() - 4)),
                HasSubstr("header: wanted"));
    EXPECT_THAT(load(write_loaded_file("x.glb", whole + "1234")).warnings,
                testing::Contains(HasSubstr("bytes after the end that the header gives, left out: "
                                            "4")));
}

TEST_F(LoadRefusalTest, ObjFacesOfInvalidIndicesOrSizesAreRefused) {
    EXPECT_THAT(load_error_text("a.obj", kTriangle + "f 1 2 4294967295\n"),
                HasSubstr("found 4294967295"));
    EXPECT_THAT(load_error_text("b.obj", kTriangle + "f 1 2 4294967296\n"),
                HasSubstr("found 4294967296"));
    EXPECT_THAT(load_error_text("c.obj", kTriangle + "f 1 2 9223372036854775807\n"),
                HasSubstr("found 9223372036854775807"));
    EXPECT_THAT(load_error_text("d.obj", kTriangle + "f 1 2 -9223372036854775808\n"),
                HasSubstr("found -9223372036854775808"));
    EXPECT_THAT(load_error_text("e.obj", kTriangle + "vn 0 0 1\nf 1//1 2//1 3//4294967295\n"),
                HasSubstr("one of 1 normals"));
    EXPECT_THAT(load_error_text("f.obj", kTriangle + "f 1 2 3\\\n \\\n 9\n"),
                HasSubstr("f.obj:4: face wants one of 3 vertices, found 9"));
    EXPECT_THAT(load_error_text("g.obj", "v 1e200 0 0\nv 0 1e200 0\nv 0 0 1e200\nf 1 2 3\n"),
                HasSubstr("up to 1e150, found an overflow"));
    EXPECT_THAT(load_error_text("h.obj", "v 1e-200 0 0\nv 0 1e-200 0\nv 0 0 1e-200\nf 1 2 3\n"),
                HasSubstr("area"));
}

} // namespace
