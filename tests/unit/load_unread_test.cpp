// Tests of the loaders' warnings. A warning names and counts each part of a file that a loader does
// not read, or repairs.
#include "scene/transform.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>

namespace {

using namespace test::loading;
using glm::dvec2;
using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;

class LoadUnreadFeaturesTest : public Load {
protected:
    /// Loads a file with `text` and returns its warnings without the file's path.
    std::vector<std::string> load_and_list_warnings(const std::string& name,
                                                    const std::string& text) const {
        const std::string path = write_loaded_file(name, text);
        std::vector<std::string> list;
        for (const std::string& warning : load(path).warnings) {
            EXPECT_THAT(warning, HasSubstr(folder.string()));
            list.push_back(warning.starts_with(path) ? warning.substr(path.size() + 2) : warning);
        }
        return list;
    }
};

TEST_F(LoadUnreadFeaturesTest, FilesThatAreFullyReadGiveNoWarnings) {
    EXPECT_THAT(load_and_list_warnings("x.obj", kTriangle + "f 1 2 3\n"), testing::IsEmpty());
    EXPECT_THAT(load_and_list_warnings("x.glb", make_small_gltf().glb_bytes()), testing::IsEmpty());
    write_loaded_file("m.mtl", "newmtl a\nKe 1 0 0\nnewmtl b\n");
    const std::string lit = "mtllib m.mtl\n" + kTriangle + "usemtl a\n";
    EXPECT_THAT(load_and_list_warnings("x.obj", lit + "f 1 2 3\n"), testing::IsEmpty());
}

/// Colours of 0 to 255 are a usual mistake. They are clamped, with a warning that says so.
TEST_F(LoadUnreadFeaturesTest, ClampedColoursAndFactorsGiveAWarning) {
    const std::string kind = "colours and factors outside 0 to 1, clamped (a colour of 0 to 255 "
                             "must be divided by 255): ";
    write_loaded_file("m.mtl", "newmtl a\nKd 51 102 153\nKs 1 1 1.00001\nKe 9 9 9\nNs 300\n"
                               "newmtl b\nd 1.5\nPr -1\nPm 2\nTr 3\nKs 0 -1 0\nPc 7\nPcr 7\n");
    EXPECT_THAT(
        load_and_list_warnings("x.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n"),
        ElementsAre(
            testing::AllOf(HasSubstr(kind + "8 (first: "), HasSubstr("m.mtl:2: 'Kd 51 102 153')")),
            HasSubstr("drawn by d: 1 (first: ")));
    EXPECT_THAT(
        load_and_list_warnings("y.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n"),
        ElementsAre(HasSubstr("colours of vertices, read as sRGB: 3"),
                    testing::AllOf(HasSubstr(kind + "1 (first: "), EndsWith("y.obj:1)"))));
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["materials"] = {
        {{"name", "red"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {255, 0, 0, 1}}, {"roughnessFactor", 1.5}}}},
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness", {{"specularFactor", {51, 51, 51}}}}}}},
        {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}}};
    EXPECT_THAT(load_and_list_warnings("x.glb", gltf.glb_bytes()),
                ElementsAre(kind + "3 (first: materials[0] 'red': baseColorFactor)"));
}

TEST_F(LoadUnreadFeaturesTest, GltfLightsGiveNoWarnings) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "Sun"}}, {{"type", "spot"}}, {{"type", "directional"}}};
    gltf.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    EXPECT_THAT(load_and_list_warnings("x.glb", gltf.glb_bytes()), testing::IsEmpty());
}

TEST_F(LoadUnreadFeaturesTest, UnreadMaterialFeaturesGiveWarnings) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["materials"] = {
        {{"name", "wood"},
         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}},
        {{"name", "gold"},
         {"pbrMetallicRoughness", {{"roughnessFactor", .3}}},
         {"extensions", // these extensions do not affect a metal
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume", Json::object()}}}},
        {{"name", "glass"},
         {"alphaMode", "BLEND"},
         {"normalTexture", {{"index", 0}}},
         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume", Json::object()},
           {"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}}};
    gltf.root["textures"] = {{{"source", 0}}};
    gltf.root["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
    EXPECT_THAT(
        load_and_list_warnings("x.glb", gltf.glb_bytes()),
        testing::UnorderedElementsAre(
            "images that are not there or of a kind that is not read, drawn without: 1 (first: "
            "images[0])"));
}

TEST_F(LoadUnreadFeaturesTest, UnreadPrimitivesSkinsAndExtensionsGiveWarnings) {
    GltfFileBuilder gltf = make_small_gltf();
    Json& primitives = gltf.root["meshes"][0]["primitives"];
    gltf.root["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
    primitives[0]["attributes"]["COLOR_0"] = 2;
    primitives[0]["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 5}});
    gltf.root["skins"] = {{{"joints", {0}}}};
    gltf.root["nodes"][0]["skin"] = 0;
    gltf.root["nodes"].push_back(Json::object());
    const Json to = [](const char* path) {
        return Json{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}};
    }("weights");
    gltf.root["animations"] = {
        {{"samplers", {{{"input", 0}, {"output", 0}}}}, {"channels", {to, to}}}};
    gltf.root["extensions"]["EXT_all"] = Json::object();
    gltf.root["nodes"][1]["extensions"]["EXT_instancing"] = Json::object();
    gltf.root["nodes"][1]["extras"]["extensions"]["no_extension"] = Json::object();
    EXPECT_THAT(
        load_and_list_warnings("x.glb", gltf.glb_bytes()),
        testing::UnorderedElementsAre(
            "primitives with morph targets, in their default shape: 1 (first: meshes[0] 'm': "
            "primitives[0])",
            "primitives of points or lines, left out: 1 (first: meshes[0] 'm': primitives[1])",
            "nodes with a skin, posed by its joints at rest: 1 (first: nodes[0] 'n')",
            "animation channels of 'weights', left out: 2 (first: animations[0]: channels[0])",
            "extension 'EXT_all', not read: 1 (first: of the whole file)",
            "extension 'EXT_instancing', not read: 1 (first: nodes[1])"));
}

TEST_F(LoadUnreadFeaturesTest, NodesOutsideTheShownSceneGiveAWarning) {
    GltfFileBuilder gltf = make_small_gltf();
    const std::size_t times = gltf.add_accessor<float>({0, 1}, "SCALAR", 5126),
                      here = gltf.add_accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3", 5126),
                      there = gltf.add_accessor<float>({0, 0, 0, 0, 9, 0}, "VEC3", 5126);
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    gltf.root["nodes"].push_back({{"camera", 0}, {"name", "riding"}});
    gltf.root["nodes"][0]["children"] = {1};
    gltf.root["nodes"].push_back({{"mesh", 0}, {"name", "elsewhere"}});
    gltf.root["nodes"].push_back({{"name", "nothing"}});
    const auto moves = [&](std::size_t output) {
        return Json{
            {"samplers", {{{"input", times}, {"output", output}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}};
    };
    gltf.root["animations"] = {moves(here), moves(there)};
    EXPECT_THAT(
        load_and_list_warnings("x.glb", gltf.glb_bytes()),
        testing::UnorderedElementsAre(
            "nodes outside the scene that is shown, left out: 1 (first: nodes[2] 'elsewhere')"));
    const Scene moved = scene_at(load((folder / "x.glb").string()), 1);
    EXPECT_EQ(dvec3(moved.objects[0].world_from_object[3]), dvec3(1, 0, 0)) << "the first counts";
}

TEST_F(LoadUnreadFeaturesTest, StatementsBeforeTheFirstMaterialGiveAWarning) {
    write_loaded_file("m.mtl", "Kd 1 0 0\nKe 1 1 1\nnewmtl a\nKd 0 1 0\n");
    const std::string file = fs::canonical(folder).string() + "/m.mtl";
    EXPECT_THAT(
        load_and_list_warnings("x.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n"),
        testing::UnorderedElementsAre(
            "statements before the first newmtl, left out: 2 (first: " + file + ":1)"));
}

TEST_F(LoadUnreadFeaturesTest, LongAttributeNameIsRefusedWithAShortMessage) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["POSITION" + std::string(5000, 'x')] = 0;
    write_loaded_file("x.glb", gltf.glb_bytes());
    try {
        load((folder / "x.glb").string());
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("wanted a name of at most 1024 bytes, found 5008"));
        EXPECT_LE(std::string(error.what()).size(), 400u);
    }
}

TEST_F(LoadUnreadFeaturesTest, UnreadObjAndMtlStatementsGiveWarnings) {
    write_loaded_file("m.mtl", "newmtl a\nNs 10\nKa 0 0 0\nmap_Kd wood.png\nillum 2\n"
                               "newmtl b\nNs 10\nillum 4\nnewmtl c\nillum 2\nd .5\n");
    const std::string file = fs::canonical(folder).string() + "/m.mtl";
    EXPECT_THAT(load_and_list_warnings(
                    "x.obj", "mtllib m.mtl\n" + kTriangle +
                                 "vt 0 0\nvt 1 0\nlod 1\nusemtl a\nf 1/1 2/1 3/1\nl 1 2\n"),
                testing::UnorderedElementsAre(
                    "images that are not there or of a kind that is not read, drawn without: 1 "
                    "(first: " +
                        file + ":4: 'wood.png')",
                    "statements 'lod', not read: 1 (first: " + (folder / "x.obj").string() + ":7)",
                    "statements 'l', not read: 1 (first: " + (folder / "x.obj").string() + ":10)"));
}

TEST_F(LoadUnreadFeaturesTest, NumberOfWarningsIsLimited) {
    GltfFileBuilder gltf = make_small_gltf();
    for (int i = 0; i < 200; ++i)
        gltf.root["nodes"].push_back(
            {{"extensions", {{"EXT_" + std::to_string(i), Json::object()}}}});
    const std::vector<std::string> lines = load_and_list_warnings("x.glb", gltf.glb_bytes());
    EXPECT_EQ(lines.size(), 41u);
    EXPECT_EQ(lines[0], "extension 'EXT_0', not read: 1 (first: nodes[1])");
    EXPECT_EQ(lines[40], "further notes of other kinds, not listed: 160");
    std::string text = kTriangle + "f 1 2 3\n";
    for (int i = 0; i < 200; ++i) text += "x" + std::to_string(i) + "\n";
    EXPECT_THAT(load_and_list_warnings("x.obj", text),
                Contains(HasSubstr("other statements, not read: 160")));
}

TEST_F(LoadUnreadFeaturesTest, ControlCharactersOfAFileAreEscapedInMessages) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["nodes"][0]["name"] = "\x1b[2J";
    gltf.root["nodes"][0]["skin"] = 0;
    gltf.root["skins"] = {{{"joints", {0}}}};
    EXPECT_THAT(load_and_list_warnings("x.glb", gltf.glb_bytes()),
                Contains(EndsWith("(first: nodes[0] '\\x1b[2J')")));
    gltf.root["nodes"][0]["mesh"] = 5;
    EXPECT_THAT(load_error_text("x.glb", gltf.glb_bytes()), HasSubstr("nodes[0] '\\x1b[2J': mesh"));
    EXPECT_THAT(
        load_and_list_warnings("x.obj", "mtllib \x1b\n" + kTriangle + "usemtl a\nf 1 2 3\n"),
        Contains(HasSubstr("'\\x1b'")));
    EXPECT_THAT(load_error_text("x.obj", kTriangle + "f \x1b 2 3\n"), HasSubstr("'\\x1b'"));
    EXPECT_THAT(load_error_text("x.obj", kTriangle + "v \x9b 2 3\n"), HasSubstr("'\\x9b'"));
    EXPECT_THAT(load_error_text("x.obj", kTriangle + "# catoptric \x1b x\n"), HasSubstr("'\\x1b'"));
    EXPECT_THAT(load_error_text("x.gltf", "{\"\x1b"), testing::Not(HasSubstr("\x1b")));
}

// ---- repairs of loaded files

/// Builds a glTF file of a closed box without normals. `node` gives the transform of the box.
GltfFileBuilder make_box_gltf_without_normals(const Json& node) {
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = gltf.add_accessor<float>(
        {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1}, "VEC3", 5126);
    gltf.root["meshes"][0]["primitives"][0]["indices"] = gltf.add_accessor<std::uint16_t>(
        {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
        "SCALAR", 5123);
    gltf.root["nodes"][0].update(node);
    return gltf;
}

TEST_F(LoadUnreadFeaturesTest, FacetNormalsOfMirroredNodesPointOutwards) {
    for (const Json& node : {Json{{"scale", {1, 1, 1}}}, Json{{"scale", {-1, 1, 1}}},
                             Json{{"scale", {-2, -1, -3}}}, Json{{"scale", {1, -1, -1}}},
                             Json{{"matrix", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}}) {
        const Scene scene = load(
            write_loaded_file("x.glb", make_box_gltf_without_normals(node).glb_bytes()));
        const Object& object = scene.objects.at(0);
        const Mesh& mesh = scene.meshes[object.mesh];
        const dvec3 centre = bounds(scene).centre();
        ASSERT_EQ(mesh.triangles.size(), 12u);
        for (const uvec3& t : mesh.triangles) {
            const auto at = [&](int i) {
                return transform_point(object.world_from_object, mesh.positions[t[i]]);
            };
            const dvec3 winding = glm::cross(at(1) - at(0), at(2) - at(0));
            const dvec3 shading = normal_matrix(object.world_from_object) *
                                  dvec3(mesh.normals[t[0]]);
            EXPECT_GT(glm::dot(winding, at(0) - centre), 0) << node;
            EXPECT_GT(glm::dot(shading, at(0) - centre), 0) << node;
            EXPECT_NEAR(glm::dot(glm::normalize(winding), glm::normalize(shading)), 1, 1e-6)
                << node;
        }
    }
}

// ---- polygons are cut into triangles

double total_scene_area(const Scene& scene) {
    double sum = 0;
    for (const uvec3& t : scene.meshes.at(0).triangles) {
        const auto at = [&](int i) { return scene.meshes[0].positions[t[i]]; };
        sum += glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
        EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).z, 0) << "turned as its polygon";
    }
    return sum;
}

TEST_F(LoadUnreadFeaturesTest, TrianglesOfAPolygonCoverItsArea) {
    const auto cut = [&](const std::vector<dvec2>& corners) {
        std::string text, face = "f";
        for (std::size_t i = 0; i < corners.size(); ++i) {
            text += "v " + std::to_string(corners[i].x) + " " + std::to_string(corners[i].y) +
                    " 3\n";
            face += " " + std::to_string(i + 1);
        }
        return load(write_loaded_file("x.obj", text + face + "\n"));
    };
    EXPECT_EQ(total_scene_area(cut({{0, 0}, {2, 0}, {2, 1}, {0, 1}})), 2);
    // The kite must be cut along its shorter diagonal.
    const Scene kite = cut({{0, 0}, {1, -3}, {2, 0}, {1, 3}});
    EXPECT_EQ(total_scene_area(kite), 6);
    EXPECT_EQ(kite.meshes[0].triangles[0], uvec3(0, 1, 2));
    EXPECT_EQ(total_scene_area(cut({{0, 0}, {4, 0}, {4, 4}, {3, 1}})), 4) << "a notch in a quad";
    EXPECT_EQ(
        total_scene_area(cut({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}})), 7)
        << "a U";
    EXPECT_EQ(total_scene_area(cut({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}})), 4)
        << "corners on edges";
    std::vector<dvec2> star, round;
    for (int i = 0; i < 100; ++i) {
        const double angle = i * M_PI / 50, radius = 1 + i % 2;
        round.emplace_back(std::cos(angle), std::sin(angle));
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    EXPECT_NEAR(total_scene_area(cut(round)), 50 * std::sin(M_PI / 50), 1e-4);
    EXPECT_NEAR(total_scene_area(cut(star)), 100 * std::sin(M_PI / 50), 1e-4);
    // The loader must end for a polygon that crosses itself, whatever the triangles.
    cut({{0, 0}, {2, 2}, {2, 0}, {0, 2}, {-3, 1}});
}

} // namespace
