// Tests of loading glTF geometry in each form in which a file may store it.
#include "scene/transform.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>

namespace {

using namespace test::loading;
using testing::ElementsAre;

class LoadGeometryTest : public Load {
protected:
    Scene load_geometry_gltf(const GltfFileBuilder& gltf) const {
        return load(write_loaded_file("x.glb", gltf.glb_bytes()));
    }
    /// Returns the three corners of each triangle in world space, in order.
    static std::vector<std::array<dvec3, 3>> list_world_triangles(const Scene& scene) {
        std::vector<std::array<dvec3, 3>> list;
        for (const Object& object : scene.objects)
            for (const uvec3& t : scene.meshes[object.mesh].triangles) {
                std::array<dvec3, 3> corners;
                for (int i = 0; i < 3; ++i)
                    corners[std::size_t(i)] = transform_point(
                        object.world_from_object, scene.meshes[object.mesh].positions[t[i]]);
                list.push_back(corners);
            }
        return list;
    }
    static Json& first_primitive_json(GltfFileBuilder& gltf) {
        return gltf.root["meshes"][0]["primitives"][0];
    }
};

const dvec3 kTriangleCornerA(0, 0, 0), kB(1, 0, 0), kTriangleCornerC(0, 1, 0),
    kTriangleCornerD(1, 1, 0), kTriangleCornerE(0, 2, 0);
/// Builds a glTF file whose primitive has five corners, for strips and fans.
GltfFileBuilder make_five_corner_gltf() {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["meshes"][0]["primitives"][0] = {
        {"attributes",
         {{"POSITION", gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0},
                                                "VEC3", 5126)}}}};
    return gltf;
}

TEST_F(LoadGeometryTest, StripsReverseEverySecondTriangle) {
    GltfFileBuilder gltf = make_five_corner_gltf();
    first_primitive_json(gltf)["mode"] = 5;
    EXPECT_THAT(list_world_triangles(load_geometry_gltf(gltf)),
                ElementsAre(std::array{kTriangleCornerA, kB, kTriangleCornerC},
                            std::array{kB, kTriangleCornerD, kTriangleCornerC},
                            std::array{kTriangleCornerC, kTriangleCornerD, kTriangleCornerE}));
    first_primitive_json(gltf)["indices"] = gltf.add_accessor<std::uint8_t>({1, 3, 0, 2}, "SCALAR",
                                                                            5121);
    EXPECT_THAT(list_world_triangles(load_geometry_gltf(gltf)),
                ElementsAre(std::array{kB, kTriangleCornerD, kTriangleCornerA},
                            std::array{kTriangleCornerD, kTriangleCornerC, kTriangleCornerA}));
}

TEST_F(LoadGeometryTest, FanTrianglesEndAtTheSharedCorner) {
    GltfFileBuilder gltf = make_five_corner_gltf();
    first_primitive_json(gltf)["mode"] = 6;
    first_primitive_json(gltf)["indices"] = gltf.add_accessor<std::uint32_t>({0, 1, 3, 4}, "SCALAR",
                                                                             5125);
    EXPECT_THAT(list_world_triangles(load_geometry_gltf(gltf)),
                ElementsAre(std::array{kB, kTriangleCornerD, kTriangleCornerA},
                            std::array{kTriangleCornerD, kTriangleCornerE, kTriangleCornerA}));
}

TEST_F(LoadGeometryTest, PointsAndLinesAreListedAndStripsOfTwoCornersIgnored) {
    GltfFileBuilder gltf = make_five_corner_gltf();
    for (const int mode : {0, 1, 2, 3}) {
        gltf.root["meshes"][0]["primitives"].push_back(gltf.root["meshes"][0]["primitives"][0]);
        gltf.root["meshes"][0]["primitives"].back()["mode"] = mode;
    }
    first_primitive_json(gltf)["mode"] = 5;
    gltf.root["meshes"][0]["primitives"].push_back(first_primitive_json(gltf));
    gltf.root["meshes"][0]["primitives"].back()["indices"] = gltf.add_accessor<std::uint8_t>(
        {1, 3}, "SCALAR", 5121);
    const Scene scene = load_geometry_gltf(gltf);
    EXPECT_EQ(triangle_count(scene), 3u);
    ASSERT_EQ(scene.unsupported.size(), 1u);
    EXPECT_EQ(scene.unsupported[0].id, "points-lines");
    EXPECT_EQ(scene.unsupported[0].count, 4u);
    EXPECT_EQ(scene.unsupported[0].first, "meshes[0] 'm': primitives[1]");
}

TEST_F(LoadGeometryTest, SparseValuesReplaceStoredValuesOrZeros) {
    GltfFileBuilder gltf = make_small_gltf();
    const auto view_of = [&](std::size_t accessor) {
        return gltf.root["accessors"][accessor]["bufferView"];
    };
    const std::size_t places = gltf.add_accessor<std::uint16_t>({1, 2}, "SCALAR", 5123);
    const std::size_t values = gltf.add_accessor<float>({5, 0, 0, 0, 7, 0}, "VEC3", 5126);
    const Json sparse = {{"count", 2},
                         {"indices", {{"bufferView", view_of(places)}, {"componentType", 5123}}},
                         {"values", {{"bufferView", view_of(values)}}}};
    gltf.root["accessors"][0]["sparse"] = sparse;
    EXPECT_THAT(list_world_triangles(load_geometry_gltf(gltf)),
                ElementsAre(std::array{kTriangleCornerA, dvec3(5, 0, 0), dvec3(0, 7, 0)}));
    gltf.root["accessors"][0].erase("bufferView");
    EXPECT_THAT(list_world_triangles(load_geometry_gltf(gltf)),
                ElementsAre(std::array{kTriangleCornerA, dvec3(5, 0, 0), dvec3(0, 7, 0)}));
    EXPECT_THAT(
        load_error_text("y.glb", gltf.glb_bytes(), Failure::bad_data,
                        {.budget = {.made_bytes = 47}}),
        HasSubstr("accessors[0]: wanted at most 47 bytes of sparse accessors, the budget of "
                  "a scene, found 48"));
}

TEST_F(LoadGeometryTest, StridedAndQuantisedAttributesAreRead) {
    GltfFileBuilder gltf = make_small_gltf();
    // Each corner has x, y and z of 16 bits and two bytes of padding. Normals are stored as bytes.
    std::vector<std::int16_t> corners = {0, 0, 0, 99, 100, 0, 0, 99, 0, -200, 0, 99};
    const std::size_t positions = gltf.add_accessor(corners, "SCALAR", 5122);
    gltf.root["bufferViews"].back()["byteStride"] = 8;
    gltf.root["accessors"][positions].update(Json{{"type", "VEC3"}, {"count", 3}});
    const std::size_t normals = gltf.add_accessor<std::int8_t>(
        {0, 0, -127, 0, 0, 0, -128, 0, 0, 127, 0, 0}, "SCALAR", 5120);
    gltf.root["bufferViews"].back()["byteStride"] = 4;
    gltf.root["accessors"][normals].update(
        Json{{"type", "VEC3"}, {"count", 3}, {"normalized", true}});
    const std::size_t uv = gltf.add_accessor<std::uint16_t>({0, 65535, 13107, 0, 0, 0}, "VEC2",
                                                            5123);
    gltf.root["accessors"][uv]["normalized"] = true;
    first_primitive_json(gltf)["attributes"] = {
        {"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}};
    EXPECT_THAT(load_error_text("y.glb", gltf.glb_bytes()),
                HasSubstr("POSITION: wanted floats, found component type 5122"));
    gltf.root["accessors"][positions]["normalized"] = true;
    EXPECT_THAT(load_error_text("y.glb", gltf.glb_bytes()),
                HasSubstr("POSITION: wanted floats, found component type 5122"));
    gltf.root["accessors"][positions]["normalized"] = false;
    gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    const Scene scene = load_geometry_gltf(gltf);
    EXPECT_THAT(list_world_triangles(scene),
                ElementsAre(std::array{kTriangleCornerA, dvec3(100, 0, 0), dvec3(0, -200, 0)}));
    const Mesh& mesh = scene.meshes[0];
    const uvec3 t = mesh.triangles[0];
    EXPECT_EQ(mesh.normals[t.x], vec3(0, 0, -1));
    EXPECT_EQ(mesh.normals[t.y], vec3(0, 0, -1)) << "-128 is -1, too";
    EXPECT_EQ(mesh.normals[t.z], vec3(0, 1, 0));
    EXPECT_EQ(mesh.uv[0][t.x], vec2(0, 1));
    EXPECT_EQ(mesh.uv[0][t.y], vec2(.2f, 0));
}

TEST_F(LoadGeometryTest, TextureCoordinatesAndColoursAreRead) {
    GltfFileBuilder gltf = make_small_gltf();
    first_primitive_json(gltf)["attributes"]["TEXCOORD_0"] = gltf.add_accessor<float>(
        {0, 1, 2, 3, 4, 5, 6, 7}, "VEC2", 5126);
    const std::size_t bytes = gltf.add_accessor<std::uint8_t>({0, 51, 255, 127, 1, 2}, "VEC2",
                                                              5121);
    gltf.root["accessors"][bytes]["normalized"] = true;
    (void)bytes;
    first_primitive_json(gltf)["attributes"]["COLOR_0"] = gltf.add_accessor<float>(
        {1, 0, 0, .5, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1}, "VEC4", 5126);
    // A second primitive of the same material has neither texture coordinates nor colours.
    gltf.root["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    const Scene scene = load_geometry_gltf(gltf);
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.uv[0].size(), mesh.positions.size());
    ASSERT_EQ(mesh.colours.size(), mesh.positions.size());
    EXPECT_TRUE(mesh.uv[1].empty());
    const uvec3 own = mesh.triangles[0], other = mesh.triangles[1];
    EXPECT_EQ(mesh.uv[0][own.y], vec2(2, 3));
    EXPECT_EQ(mesh.colours[own.x], vec4(1, 0, 0, .5f));
    EXPECT_EQ(mesh.uv[0][other.y], vec2(0));
    EXPECT_EQ(mesh.colours[other.y], vec4(1));
}

TEST_F(LoadGeometryTest, ColoursOfThreeNormalisedBytesAreRead) {
    GltfFileBuilder gltf = make_small_gltf();
    const std::size_t colours = gltf.add_accessor<std::uint8_t>(
        {0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "SCALAR", 5121);
    gltf.root["bufferViews"].back()["byteStride"] = 4;
    gltf.root["accessors"][colours].update(
        Json{{"type", "VEC3"}, {"count", 4}, {"normalized", true}});
    first_primitive_json(gltf)["attributes"]["COLOR_0"] = colours;
    const Scene scene = load_geometry_gltf(gltf);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.colours[mesh.triangles[0].x], vec4(0, .2f, 1, 1));
}

TEST_F(LoadGeometryTest, NodesShareTheirMesh) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["nodes"] = Json::array();
    gltf.root["scenes"][0]["nodes"] = Json::array();
    for (int i = 0; i < 1000; ++i) {
        gltf.root["nodes"].push_back({{"mesh", 0}, {"translation", {i, 0, 0}}});
        gltf.root["scenes"][0]["nodes"].push_back(i);
    }
    const Scene scene = load_geometry_gltf(gltf);
    EXPECT_EQ(scene.objects.size(), 1000u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(list_world_triangles(scene)[999][1], dvec3(1000, 0, 0));
}

TEST_F(LoadGeometryTest, MorphTargetsAreAppliedWithDefaultWeights) {
    GltfFileBuilder gltf = make_small_gltf();
    const std::size_t by = gltf.add_accessor<float>({0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3",
                                                    5126);
    first_primitive_json(gltf)["targets"] = {{{"POSITION", by}}, {{"POSITION", by}}};
    EXPECT_THAT(list_world_triangles(load_geometry_gltf(gltf)),
                ElementsAre(std::array{kTriangleCornerA, kB, kTriangleCornerC}));
    gltf.root["meshes"][0]["weights"] = {.25, .5};
    const Scene scene = load_geometry_gltf(gltf);
    const dvec3 up(0, 0, 3);
    EXPECT_THAT(list_world_triangles(scene),
                ElementsAre(std::array{kTriangleCornerA + up, kB + up, kTriangleCornerC + up}));
    EXPECT_EQ(scene.unsupported.at(0).id, "morph");
    // Weights of a node replace the weights of its mesh. Nodes with equal weights share a mesh.
    gltf.root["nodes"] = {
        {{"mesh", 0}}, {{"mesh", 0}, {"weights", {0, 1}}}, {{"mesh", 0}, {"weights", {0, 1}}}};
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene nodes = load_geometry_gltf(gltf);
    const dvec3 own(0, 0, 4);
    EXPECT_EQ(nodes.meshes.size(), 2u);
    const std::array moved{kTriangleCornerA + own, kB + own, kTriangleCornerC + own};
    EXPECT_THAT(list_world_triangles(nodes),
                ElementsAre(std::array{kTriangleCornerA + up, kB + up, kTriangleCornerC + up},
                            moved, moved));
}

TEST_F(LoadGeometryTest, SkinnedMeshesArePosedByTheirJoints) {
    GltfFileBuilder gltf = make_small_gltf();
    // The first joint is at height 2 and was bound at height 1, so it lifts vertices by 1. The
    // second joint is at the origin.
    std::vector<float> bound(32);
    for (const std::size_t i : {0, 5, 10, 15, 16, 21, 26, 31}) bound[i] = 1;
    bound[13] = -1;
    const std::size_t inverse = gltf.add_accessor(bound, "MAT4", 5126);
    const std::size_t joints = gltf.add_accessor<std::uint8_t>(
        {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC4", 5121);
    const std::size_t weights = gltf.add_accessor<float>(
        {1, 0, 0, 0, 1, 0, 0, 0, .5, .5, 0, 0, 1, 0, 0, 0}, "VEC4", 5126);
    first_primitive_json(gltf)["attributes"]["JOINTS_0"] = joints;
    first_primitive_json(gltf)["attributes"]["WEIGHTS_0"] = weights;
    gltf.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {50, 0, 0}}},
                          {{"translation", {0, 2, 0}}},
                          {{"name", "root"}}};
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2};
    gltf.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
    const Scene scene = load_geometry_gltf(gltf);
    EXPECT_THAT(list_world_triangles(scene),
                ElementsAre(std::array{dvec3(0, 1, 0), kB, dvec3(0, 1.5, 0)}))
        << "where the node is does not matter";
    EXPECT_EQ(scene.unsupported.at(0).id, "skin");
}

TEST_F(LoadGeometryTest, OrthographicCamerasAreRead) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["cameras"] = {
        {{"type", "orthographic"},
         {"name", "plan"},
         {"orthographic", {{"xmag", 9}, {"ymag", 1.5}, {"znear", 0}, {"zfar", 1}}}}};
    gltf.root["nodes"].push_back({{"camera", 0}, {"translation", {1, 2, 3}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load_geometry_gltf(gltf);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].orthographic_height, 3);
    EXPECT_EQ(scene.cameras[0].eye, dvec3(1, 2, 3));
    EXPECT_EQ(scene.cameras[0].target, dvec3(1, 2, 2));
    gltf.root["cameras"][0]["orthographic"]["ymag"] = 0;
    EXPECT_THAT(load_error_text("y.glb", gltf.glb_bytes()),
                HasSubstr("cameras[0] 'plan': orthographic: ymag: wanted a number above 0"));
}

TEST_F(LoadGeometryTest, PunctualLightsAreRead) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 8}, {"color", {1, .5, .25}}, {"range", 7}},
        {{"type", "spot"},
         {"name", "cone"},
         {"spot", {{"innerConeAngle", .25}, {"outerConeAngle", .5}}}},
        {{"type", "directional"}, {"intensity", 3}}};
    for (int i = 0; i < 3; ++i) {
        gltf.root["nodes"].push_back({{"translation", {0, i, 0}},
                                      {"rotation", {0, std::sqrt(.5), 0, std::sqrt(.5)}},
                                      {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
        gltf.root["scenes"][0]["nodes"].push_back(i + 1);
    }
    const Scene scene = load_geometry_gltf(gltf);
    ASSERT_EQ(scene.punctual.size(), 3u);
    const PunctualLight &point = scene.punctual[0], &spot = scene.punctual[1],
                        &sun = scene.punctual[2];
    EXPECT_EQ(point.kind, PunctualLight::Kind::point);
    EXPECT_EQ(point.intensity, vec3(8, 4, 2));
    EXPECT_EQ(point.range, 7);
    EXPECT_EQ(spot.kind, PunctualLight::Kind::spot);
    EXPECT_EQ(spot.name, "cone");
    EXPECT_EQ(spot.intensity, vec3(1));
    EXPECT_NEAR(spot.cos_inner, std::cos(.25), 1e-12);
    EXPECT_NEAR(spot.cos_outer, std::cos(.5), 1e-12);
    EXPECT_TRUE(std::isinf(spot.range));
    EXPECT_EQ(sun.kind, PunctualLight::Kind::directional);
    EXPECT_EQ(dvec3(sun.world_from_light[3]), dvec3(0, 2, 0));
    const dvec3 along = -dvec3(
        sun.world_from_light[2]); // the light's -z axis, turned by 90 degrees about y
    EXPECT_NEAR(along.x, -1, 1e-12);
    EXPECT_THAT(scene.warnings, testing::IsEmpty()) << "it is lit";
}

} // namespace
