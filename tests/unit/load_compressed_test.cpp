// Tests of glTF geometry that is compressed or instanced. A compressed file must load like the same
// file without compression, and damaged data must be refused.
#include "places.hpp"
#include "scene/pose.hpp"
#include "scene/transform.hpp"
#include "support/bent_grid.hpp"
#include "support/process.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>
#include <random>

#include <meshoptimizer.h>

namespace {

using namespace test::loading;
using test::BentGrid;
using test::kGridEdge;

class LoadCompressedTest : public Load {
protected:
    Scene load_glb(const GltfFileBuilder& gltf) const {
        return load_file(write_loaded_file("x.glb", gltf.glb_bytes()), {});
    }
    std::string refuse(const GltfFileBuilder& gltf, const FileOptions& options = {}) const {
        return load_error_text("y.glb", gltf.glb_bytes(), Failure::bad_data, options);
    }
};

/// Returns a glTF file of one node that shows the grid without compression. Accessors 0 to 2 are
/// the attributes, and accessor 3 holds the indices.
GltfFileBuilder make_grid_gltf(const BentGrid& grid) {
    GltfFileBuilder gltf;
    gltf.add_accessor(grid.positions, "VEC3", 5126);
    gltf.add_accessor(grid.normals, "VEC3", 5126);
    gltf.add_accessor(grid.uv, "VEC2", 5126);
    gltf.add_accessor(grid.corners, "SCALAR", 5125);
    gltf.root["nodes"] = {{{"name", "grid"}, {"mesh", 0}}};
    gltf.root["meshes"] = {{{"primitives",
                             {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}},
                               {"indices", 3}}}}}};
    return gltf;
}

/// Returns position, normal and texture coordinate of each corner of each triangle. The list is
/// sorted, because encoders may reorder triangles and their corners.
std::vector<std::array<double, 8>> list_sorted_corners(const Scene& scene) {
    std::vector<std::array<double, 8>> list;
    const Mesh& mesh = scene.meshes[0];
    for (const uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t at = triangle[i];
            const dvec3 p = mesh.positions[at], n = dvec3(mesh.normals[at]);
            const dvec2 t = dvec2(mesh.uv[0][at]);
            // Values are rounded for sorting, so that small errors do not change the order.
            list.push_back({std::round(p.x * 700) / 700, std::round(p.y * 700) / 700, p.z, n.x, n.y,
                            n.z, t.x, t.y});
        }
    std::ranges::sort(list);
    return list;
}

void expect_equal_corners(const Scene& found, const Scene& wanted, double tolerance) {
    const auto a = list_sorted_corners(found), b = list_sorted_corners(wanted);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t k = 0; k < 8; ++k)
            ASSERT_NEAR(a[i][k], b[i][k], tolerance) << "corner " << i << ", number " << k;
}

/// Appends bytes to the binary chunk as a new buffer view. Returns the index of the view.
std::size_t add_view_of_bytes(GltfFileBuilder& gltf, const std::string& bytes) {
    gltf.root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", gltf.data.size()}, {"byteLength", bytes.size()}});
    gltf.data += bytes;
    gltf.data.resize((gltf.data.size() + 3) / 4 * 4, '\0');
    return gltf.root["bufferViews"].size() - 1;
}

/// Returns the grid, compressed by Draco in a separate program. `bits`: quantisation of each
/// attribute; 0: floats are stored without quantisation. The attribute ids are 0, 1 and 2.
std::string encode_by_draco(const std::string& method, int bits) {
    const test::ProcessResult ended = test::run_process(
        {.command = {CATOPTRIC_ENCODE_DRACO, method, std::to_string(bits)}});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    return ended.out;
}

GltfFileBuilder make_draco_gltf(const BentGrid& grid, const std::string& bytes) {
    GltfFileBuilder gltf = make_grid_gltf(grid);
    const std::size_t view = add_view_of_bytes(gltf, bytes);
    gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    gltf.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}};
    for (Json& accessor : gltf.root["accessors"])
        accessor.erase("bufferView"); // in compressed files,
                                      // these accessors have no
                                      // buffer view
    return gltf;
}

TEST_F(LoadCompressedTest, DracoMeshesLoadLikeTheirUncompressedTwins) {
    const BentGrid grid;
    const Scene wanted = load_glb(make_grid_gltf(grid));
    ASSERT_EQ(triangle_count(wanted), 98u);
    for (const char* method : {"sequential", "described"})
        expect_equal_corners(load_glb(make_draco_gltf(grid, encode_by_draco(method, 0))), wanted,
                             0);
    expect_equal_corners(load_glb(make_draco_gltf(grid, encode_by_draco("edgebreaker", 16))),
                         wanted, 1e-4);
    const Scene loaded = load_glb(make_draco_gltf(grid, encode_by_draco("edgebreaker", 16)));
    EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings.front();
    // Draco always decodes to a list of triangles, whatever mode the glTF file states.
    GltfFileBuilder strip = make_draco_gltf(grid, encode_by_draco("edgebreaker", 16));
    strip.root["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(triangle_count(load_glb(strip)), 98u);
    strip.root["meshes"][0]["primitives"][0]["mode"] = 0;
    EXPECT_THAT(refuse(strip), HasSubstr("mode: wanted 4 or 5 beside KHR_draco"));
    // Accessors that only describe compressed data take no memory of their own.
    const FileOptions options{.budget = {.made_bytes = 400}};
    const std::string file = write_loaded_file(
        "x.glb", make_draco_gltf(grid, encode_by_draco("edgebreaker", 16)).glb_bytes());
    EXPECT_EQ(triangle_count(load_file(file, options)), 98u);
}

TEST_F(LoadCompressedTest, DracoDataThatDoNotFitAreRefused) {
    const BentGrid grid;
    const std::string bytes = encode_by_draco("edgebreaker", 12);
    const auto change = [&](const std::function<void(Json&)>& body) {
        GltfFileBuilder gltf = make_draco_gltf(grid, bytes);
        body(gltf.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]);
        return refuse(gltf);
    };
    EXPECT_THAT(change([](Json& e) { e["bufferView"] = 99; }), HasSubstr("bufferView"));
    EXPECT_THAT(change([](Json& e) { e.erase("attributes"); }),
                HasSubstr("wanted attributes, found none"));
    EXPECT_THAT(change([](Json& e) { e["attributes"]["POSITION"] = 7; }),
                HasSubstr("attribute 7: wanted one of Draco's data, found none with this id"));
    EXPECT_THAT(change([](Json& e) { e["attributes"] = {{"COLOR_0", 0}}; }), HasSubstr("COLOR_0"));
    EXPECT_THAT(change([](Json& e) { e["attributes"]["POSITION"] = 2; }),
                HasSubstr("attribute 2: wanted 3 components, found 2"));
    EXPECT_THAT(refuse(make_draco_gltf(grid, "DRACO\2\2\1\1")), HasSubstr("bitstream 2.2"));
    EXPECT_THAT(refuse(make_draco_gltf(grid, bytes.substr(0, bytes.size() / 2))),
                HasSubstr("cannot be decoded"));
    // A few bytes that claim a huge count must not make the decoder allocate gigabytes.
    std::string huge("DRACO\2\2\1\0\0\0", 11);
    huge += "\xff\xff\xff\xff\x04\xff\xff\xff\xff\x04";
    EXPECT_THAT(
        refuse(make_draco_gltf(grid, huge)),
        AllOf(HasSubstr("triangles in meshes, the budget of a scene"), HasSubstr("1342177279")));
    EXPECT_THAT(refuse(make_draco_gltf(grid, bytes), {.budget = {.triangles = 97}}),
                HasSubstr("wanted at most 97 triangles"));
}

/// Compresses the buffer views of the grid as EXT_meshopt_compression describes.
GltfFileBuilder make_meshopt_gltf(const BentGrid& grid, bool with_fallback) {
    const GltfFileBuilder plain = make_grid_gltf(grid);
    GltfFileBuilder gltf;
    gltf.root = plain.root;
    const auto encode_vertices = [](const std::vector<float>& values, std::size_t width) {
        const std::size_t count = values.size() / width, stride = width * sizeof(float);
        std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
        bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                                bytes.size(), values.data(), count, stride));
        return bytes;
    };
    std::string indices(meshopt_encodeIndexBufferBound(grid.corners.size(), kGridEdge * kGridEdge),
                        '\0');
    indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()),
                                             indices.size(), grid.corners.data(),
                                             grid.corners.size()));
    const std::string compressed[] = {encode_vertices(grid.positions, 3),
                                      encode_vertices(grid.normals, 3), encode_vertices(grid.uv, 2),
                                      indices};
    const std::size_t strides[] = {12, 12, 8, 4};
    for (std::size_t i = 0; i < 4; ++i) {
        Json& view = gltf.root["bufferViews"][i];
        const std::size_t length = view["byteLength"];
        view["buffer"] = 1;
        view["extensions"]["EXT_meshopt_compression"] = {
            {"buffer", 0},
            {"byteOffset", gltf.data.size()},
            {"byteLength", compressed[i].size()},
            {"byteStride", strides[i]},
            {"count", length / strides[i]},
            {"mode", i == 3 ? "TRIANGLES" : "ATTRIBUTES"}};
        gltf.data += compressed[i];
        gltf.data.resize((gltf.data.size() + 3) / 4 * 4, '\0');
    }
    gltf.root["buffers"] = {{{"byteLength", gltf.data.size()}},
                            {{"byteLength", plain.data.size()}}};
    if (with_fallback)
        gltf.root["buffers"][1]["extensions"]["EXT_meshopt_compression"] = {{"fallback", true}};
    gltf.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    return gltf;
}

TEST_F(LoadCompressedTest, MeshoptViewsLoadLikeTheirUncompressedTwins) {
    const BentGrid grid;
    const Scene wanted = load_glb(make_grid_gltf(grid));
    const Scene found = load_glb(make_meshopt_gltf(grid, true));
    expect_equal_corners(found, wanted, 0);
    EXPECT_TRUE(found.warnings.empty()) << found.warnings.front();
    // If a buffer without bytes is not marked as a fallback buffer, the file is refused.
    EXPECT_THAT(refuse(make_meshopt_gltf(grid, false)), HasSubstr("buffers[1]: wanted a uri"));
    // An uncompressed view must not read from a fallback buffer, which has no data.
    GltfFileBuilder gltf = make_meshopt_gltf(grid, true);
    gltf.root["bufferViews"][0].erase("extensions");
    EXPECT_THAT(refuse(gltf), HasSubstr("bufferViews[0]: wanted 768 bytes"));
}

TEST_F(LoadCompressedTest, MeshoptFiltersAreUndone) {
    const BentGrid grid;
    const Scene wanted = load_glb(make_grid_gltf(grid));
    // Exporters store normals with meshopt's octahedral filter as normalised integers with a stride
    // of 4 bytes.
    std::vector<float> four;
    for (std::size_t i = 0; i < grid.normals.size(); i += 3)
        four.insert(four.end(), {grid.normals[i], grid.normals[i + 1], grid.normals[i + 2], 0.f});
    const std::size_t count = four.size() / 4;
    std::vector<std::int8_t> filtered(count * 4);
    meshopt_encodeFilterOct(filtered.data(), count, 4, 8, four.data());
    std::string bytes(meshopt_encodeVertexBufferBound(count, 4), '\0');
    bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                            bytes.size(), filtered.data(), count, 4));
    GltfFileBuilder gltf = make_meshopt_gltf(grid, true);
    gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    Json& view = gltf.root["bufferViews"][1];
    view["byteLength"] = count * 4, view["byteStride"] = 4;
    view["extensions"]["EXT_meshopt_compression"].update(Json{{"byteOffset", gltf.data.size()},
                                                              {"byteLength", bytes.size()},
                                                              {"byteStride", 4},
                                                              {"filter", "OCTAHEDRAL"}});
    gltf.data += bytes;
    gltf.data.resize((gltf.data.size() + 3) / 4 * 4, '\0');
    gltf.root["buffers"][0]["byteLength"] = gltf.data.size();
    gltf.root["accessors"][1].update(Json{{"componentType", 5120}, {"normalized", true}});
    expect_equal_corners(load_glb(gltf), wanted, .02);
}

TEST_F(LoadCompressedTest, MeshoptDataThatDoNotFitAreRefused) {
    const BentGrid grid;
    const auto change = [&](std::size_t view, const std::function<void(Json&)>& body) {
        GltfFileBuilder gltf = make_meshopt_gltf(grid, true);
        body(gltf.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]);
        return refuse(gltf);
    };
    EXPECT_THAT(change(0, [](Json& e) { e["mode"] = "POINTS"; }),
                HasSubstr("mode: wanted ATTRIBUTES, TRIANGLES or INDICES, found \"POINTS\""));
    EXPECT_THAT(change(0, [](Json& e) { e.erase("mode"); }), HasSubstr("found none"));
    EXPECT_THAT(change(0, [](Json& e) { e["byteStride"] = 260; }),
                HasSubstr("byteStride: wanted a multiple of 4 from 4 to 256, found 260"));
    EXPECT_THAT(change(3, [](Json& e) { e["byteStride"] = 8; }),
                HasSubstr("byteStride: wanted 2 or 4, found 8"));
    EXPECT_THAT(change(3, [](Json& e) { e["count"] = 4; }), HasSubstr("a multiple of 3, found 4"));
    EXPECT_THAT(change(0, [](Json& e) { e["count"] = 640; }),
                HasSubstr("wanted 640 elements of 12 bytes in meshopt's format"));
    EXPECT_THAT(change(0, [](Json& e) { e["filter"] = "QUATERNION"; }),
                HasSubstr("a stride of 12, found \"QUATERNION\""));
    EXPECT_THAT(change(3, [](Json& e) { e["filter"] = "EXPONENTIAL"; }), HasSubstr("filter"));
    EXPECT_THAT(change(0, [](Json& e) { e["buffer"] = 2; }), HasSubstr("buffer"));
    EXPECT_THAT(change(0, [](Json& e) { e["byteLength"] = 1 << 30; }), HasSubstr("found a buffer"));
    EXPECT_THAT(change(0, [](Json& e) { e["count"] = std::uint64_t(1) << 60; }),
                HasSubstr("the budget of a scene"));
    EXPECT_THAT(change(0, [](Json& e) { e = 3; }), HasSubstr("wanted an object"));
}

/// If bytes of a compressed file are changed, the file loads as another mesh or is refused, but
/// never crashes or hangs.
TEST_F(LoadCompressedTest, DamagedCompressedDataNeverCrash) {
    const BentGrid grid;
    const GltfFileBuilder whole[] = {make_draco_gltf(grid, encode_by_draco("edgebreaker", 12)),
                                     make_draco_gltf(grid, encode_by_draco("sequential", 12)),
                                     make_meshopt_gltf(grid, true)};
    std::mt19937 random(5);
    int loaded = 0, refused = 0;
    for (const GltfFileBuilder& good : whole) {
        const std::size_t first = good.root["bufferViews"].size() == 5
                                      ? good.root["bufferViews"][4]["byteOffset"].get<std::size_t>()
                                      : 0;
        for (int i = 0; i < 150; ++i) {
            GltfFileBuilder bad = good;
            for (int k = 0; k <= i % 4; ++k)
                bad.data[first + random() % (bad.data.size() - first)] = static_cast<char>(
                    random());
            try {
                load_glb(bad);
                ++loaded;
            } catch (const Error& error) {
                EXPECT_EQ(error.failure, Failure::bad_data) << error.what();
                ++refused;
            }
        }
    }
    EXPECT_GT(loaded, 50);
    EXPECT_GT(refused, 50);
}

/// Returns a file whose node shows one triangle at three places.
GltfFileBuilder make_instanced_gltf() {
    GltfFileBuilder gltf = make_small_gltf();
    const std::size_t translations = gltf.add_accessor<float>({0, 0, 0, 5, 0, 0, 0, 7, 0}, "VEC3",
                                                              5126);
    // A quarter turn about z, as normalised shorts.
    const std::int16_t half = 23170;
    const std::size_t rotations = gltf.add_accessor<std::int16_t>(
        {0, 0, 0, 32767, 0, 0, half, half, 0, 0, 0, 32767}, "VEC4", 5122);
    gltf.root["accessors"][rotations]["normalized"] = true;
    const std::size_t scales = gltf.add_accessor<float>({1, 1, 1, 1, 1, 1, 2, 3, 4}, "VEC3", 5126);
    gltf.root["nodes"][0]["translation"] = {100, 0, 0};
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}};
    gltf.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return gltf;
}

TEST_F(LoadCompressedTest, InstancesBecomeObjectsOfOneMesh) {
    const Scene scene = load_glb(make_instanced_gltf());
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    const auto place = [&](std::size_t object, const dvec3& at) {
        return transform_point(scene.objects[object].world_from_object, at);
    };
    const auto expect_near = [](const dvec3& found, const dvec3& wanted) {
        EXPECT_LT(glm::distance(found, wanted), 1e-3)
            << found.x << " " << found.y << " " << found.z;
    };
    expect_near(place(0, {1, 0, 0}), {101, 0, 0});
    expect_near(place(1, {1, 0, 0}), {105, 1, 0});
    expect_near(place(1, {0, 1, 0}), {104, 0, 0});
    expect_near(place(2, {1, 1, 1}), {102, 10, 4});
    EXPECT_EQ(scene.objects[1].name, "n #2");
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

TEST_F(LoadCompressedTest, InstancesFollowTheAnimationOfTheirNode) {
    GltfFileBuilder gltf = make_instanced_gltf();
    const std::size_t times = gltf.add_accessor<float>({0, 1}, "SCALAR", 5126);
    gltf.root["accessors"][times].update(Json{{"min", {0}}, {"max", {1}}});
    const std::size_t places = gltf.add_accessor<float>({0, 0, 0, 0, 0, 40}, "VEC3", 5126);
    gltf.root["animations"] = {
        {{"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const Scene scene = load_glb(gltf);
    ASSERT_EQ(scene.objects.size(), 3u);
    Scene later = scene;
    move_to_time(later, scene, 1);
    const dvec3 found = transform_point(later.objects[1].world_from_object, dvec3(0));
    EXPECT_LT(glm::distance(found, dvec3(5, 0, 40)), 1e-3) << found.x << " " << found.z;
}

TEST_F(LoadCompressedTest, InstancesMayBeSparseAndKeepOnlyOurExtras) {
    GltfFileBuilder gltf = make_instanced_gltf();
    const std::size_t at = gltf.add_accessor<std::uint16_t>({2}, "SCALAR", 5123),
                      value = gltf.add_accessor<float>({0, 0, 50}, "VEC3", 5126);
    const std::size_t translations =
        gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"];
    const auto view_of = [&](std::size_t accessor) {
        return gltf.root["accessors"][accessor]["bufferView"];
    };
    gltf.root["accessors"][translations]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", view_of(at)}, {"componentType", 5123}}},
        {"values", {{"bufferView", view_of(value)}}}};
    gltf.root["nodes"][0]["extras"] = {{"note", std::string(1000, 'x')},
                                       {"catoptric", {{"seen_by_camera", false}}}};
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["_COLOR_0"] = 0;
    const Scene scene = load_glb(gltf);
    ASSERT_EQ(scene.objects.size(), 3u);
    const dvec3 found = transform_point(scene.objects[2].world_from_object, dvec3(0));
    EXPECT_LT(glm::distance(found, dvec3(100, 0, 50)), 1e-3) << found.x << " " << found.z;
    EXPECT_FALSE(scene.objects[1].seen_by_camera);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_THAT(scene.warnings[0], HasSubstr("instance attributes that are not read"));
}

TEST_F(LoadCompressedTest, InstancesThatDoNotFitAreRefused) {
    const auto change = [&](const std::function<void(GltfFileBuilder&, Json&)>& body) {
        GltfFileBuilder gltf = make_instanced_gltf();
        body(gltf, gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]);
        return refuse(gltf);
    };
    EXPECT_THAT(change([](GltfFileBuilder&, Json& e) { e.erase("attributes"); }),
                HasSubstr("wanted attributes, found none"));
    EXPECT_THAT(change([](GltfFileBuilder&, Json& e) {
                    e["attributes"] = {{"_ID", 0}};
                }),
                HasSubstr("wanted TRANSLATION, ROTATION or SCALE, found none"));
    EXPECT_THAT(change([](GltfFileBuilder&, Json& e) { e["attributes"]["SCALE"] = 0; }),
                HasSubstr("SCALE: wanted 3 instances, found 4"));
    EXPECT_THAT(change([](GltfFileBuilder&, Json& e) { e["attributes"]["SCALE"] = 1; }),
                HasSubstr("wanted an accessor of VEC3, found SCALAR"));
    EXPECT_THAT(
        change([](GltfFileBuilder& gltf, Json&) { gltf.root["accessors"][3].erase("normalized"); }),
        HasSubstr("normalized bytes or shorts, found component type 5122"));
    EXPECT_THAT(change([](GltfFileBuilder& gltf, Json& e) {
                    e["attributes"]["SCALE"] = gltf.add_accessor<float>(
                        {1, 1, 1, 1, NAN, 1, 1, 1, 1}, "VEC3", 5126);
                }),
                HasSubstr("element 1: wanted finite numbers, found NaN"));
    EXPECT_THAT(refuse(make_instanced_gltf(), {.budget = {.objects = 3}}), HasSubstr("3 nodes"));
}

} // namespace
