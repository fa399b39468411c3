// Tests of files as other programs write them: names of files from other machines, line ends,
// statements that contradict each other, numbers outside their range.
#include "core/image_codec.hpp"
#include "import/image_file.hpp"
#include "unit/load_fixture.hpp"

namespace {

using namespace test::loading;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

class LoadForeign : public Load {
protected:
    void SetUp() override {
        Load::SetUp();
        fs::create_directories(folder / "maps");
        fs::create_directories(folder / "My Library");
        const Image red{.name = "red", .size = {1, 1}, .texels = {0xff0000ffu}};
        write_file(folder / "maps/Red Wood.png", encode_png(red));
        write_file(folder / "My Library/own.png", encode_png(red));
        write_file(folder / "My Library/room.mtl", "newmtl a\nKd 1 0 0\nmap_Kd own.png\n");
        write_file(folder / "plain.mtl", "newmtl a\nKd 1 0 0\n");
    }
    Scene load_with_library(const std::string& name) const {
        return load(write_loaded_file("x.obj",
                                      "mtllib " + name + "\n" + kTriangle + "usemtl a\nf 1 2 3\n"));
    }
    Scene load_with_statements(const std::string& statements) const {
        write_loaded_file("m.mtl", "newmtl a\n" + statements);
        return load_with_library("m.mtl");
    }
    static std::string join_warnings(const Scene& scene) {
        std::string text;
        for (const std::string& line : scene.warnings) text += line + "\n";
        return text;
    }
};

TEST_F(LoadForeign, LibrariesAndMapsAreFoundAsProgramsWriteTheirNames) {
    for (const char* name :
         {"plain.mtl", "\"plain.mtl\"", "plain.mtl # of the room", "PLAIN.MTL", ".\\plain.mtl",
          "C:\\Users\\me\\plain.mtl", "/home/me/plain.mtl", "My Library/room.mtl",
          "My Library\\room.mtl", "\"My Library\\room.mtl\"", "my library/ROOM.mtl",
          "My Library/room.mtl # of the room"}) {
        const Scene scene = load_with_library(name);
        EXPECT_EQ(scene.materials.at(0).albedo, vec3(1, 0, 0)) << name;
        EXPECT_THAT(scene.warnings, IsEmpty()) << name;
    }
    for (const char* name :
         {"maps/Red Wood.png", "maps\\Red Wood.png", "\"maps/Red Wood.png\"", "MAPS/red wood.PNG",
          "maps/Red Wood.png # of the floor", "-s 1 1 1 \"maps\\Red Wood.png\""})
        EXPECT_TRUE(load_with_statements("map_Kd " + std::string(name) + "\n")
                        .materials.at(0)
                        .albedo_texture)
            << name;
    EXPECT_TRUE(load_with_library("My Library/room.mtl").materials.at(0).albedo_texture)
        << "a map beside its library";
    write_loaded_file("second.mtl", "newmtl b\nKd 0 1 0\n");
    write_loaded_file("my third.mtl", "newmtl c\nKd 0 1 0\n");
    EXPECT_EQ(load_with_library("plain.mtl \"second.mtl\"").materials.size(), 2u);
    EXPECT_EQ(load_with_library("plain.mtl my third.mtl second.mtl").materials.size(), 3u);
    EXPECT_EQ(load_with_library("my third.mtl My Library\\room.mtl").materials.size(), 2u);
}

/// Pictures of floats hold linear light, which is encoded: they were read as sRGB, much too dark.
TEST_F(LoadForeign, MapsOfFloatsHoldLinearLight) {
    const auto texel_of = [&](float light, const char* statement) {
        const std::string picture = encode_openexr({{1, 1}, 3, {}}, std::vector<float>(3, light));
        write_file(folder / "maps/light.exr", picture);
        const Scene scene = load_with_statements(std::string(statement) + " maps/light.exr\n");
        const Material& material = scene.materials.at(0);
        const bool is_normal = bool(material.normal_texture);
        EXPECT_EQ(join_warnings(scene).find("light above 1, clamped") != std::string::npos,
                  light > 1 && !is_normal)
            << join_warnings(scene);
        const Texture& texture = is_normal ? *material.normal_texture : *material.albedo_texture;
        EXPECT_EQ(texture.srgb, !is_normal);
        return texture.image->texels.at(0);
    };
    EXPECT_EQ(texel_of(.2158605f, "map_Kd"), 0xff808080u) << "IEC 61966-2-1";
    EXPECT_EQ(texel_of(0, "map_Kd"), 0xff000000u);
    EXPECT_EQ(texel_of(7, "map_Kd"), 0xffffffffu);
    EXPECT_EQ(texel_of(.5f, "norm"), 0xff808080u) << "no light: not encoded";
}

TEST_F(LoadForeign, ExactNamesWinOverNamesInAnotherCase) {
    write_loaded_file("Plain.mtl", "newmtl a\nKd 0 0 1\n");
    EXPECT_EQ(load_with_library("plain.mtl").materials.at(0).albedo, vec3(1, 0, 0));
    EXPECT_EQ(load_with_library("Plain.mtl").materials.at(0).albedo, vec3(0, 0, 1));
}

TEST_F(LoadForeign, NamesOutsideTheFolderAreRefused) {
    fs::create_directories(folder / "scene");
    write_loaded_file("secret.mtl", "newmtl a\nKd 1 0 0\n");
    for (const char* name : {"../secret.mtl", "..\\secret.mtl", "\"../secret.mtl\""})
        EXPECT_THAT(load_error_text("scene/x.obj",
                                    "mtllib " + std::string(name) + "\n" + kTriangle + "f 1 2 3\n"),
                    HasSubstr("wanted a file below"))
            << name;
}

TEST_F(LoadForeign, LinesMayEndInCarriageReturns) {
    write_loaded_file("m.mtl", "newmtl a\rKd 1 0 0\r");
    const Scene scene = load(
        write_loaded_file("x.obj", "mtllib m.mtl\rv 0 0 0\rv 1 0 0\rv 0 1 0\rusemtl a\rf 1 2 3\r"));
    EXPECT_EQ(scene.materials.at(0).albedo, vec3(1, 0, 0));
    EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1u);
    EXPECT_THAT(load_error_text("y.obj", "v 0 0 0\rv 1 0 0\rv 0 1\r"), HasSubstr("y.obj:3"));
}

TEST_F(LoadForeign, DissolveWinsOverContradictingTransparency) {
    const auto alpha = [&](const std::string& statements) {
        return load_with_statements(statements).materials.at(0).alpha;
    };
    for (const char* statements : {"d 1\nTr 1\n", "Tr 1\nd 1\n"}) {
        EXPECT_EQ(alpha(statements), 1) << statements;
        EXPECT_THAT(join_warnings(load_with_statements(statements)),
                    HasSubstr("d and Tr contradict each other, drawn by d"));
    }
    EXPECT_FLOAT_EQ(alpha("Tr .25\n"), .75f);
    EXPECT_FLOAT_EQ(alpha("d .75\nTr .25\n"), .75f);
    EXPECT_THAT(join_warnings(load_with_statements("d .75\nTr .25\n")),
                Not(HasSubstr("contradict")));
}

TEST_F(LoadForeign, SurfacesThatNobodySeesAreNamed) {
    const std::string said = "objects of which nothing can be seen";
    for (const char* statements : {"d 0\n", "Tr 1\n"})
        EXPECT_THAT(join_warnings(load_with_statements(statements)), HasSubstr(said)) << statements;
    for (const char* statements : {"d .01\n", "d 0\nNi 1.5\n", "illum 4\nd 0\n"})
        EXPECT_THAT(join_warnings(load_with_statements(statements)), Not(HasSubstr(said)))
            << statements;
    const auto gltf = [&](const std::string& material) {
        GltfFileBuilder file = make_small_gltf();
        file.root["materials"] = Json::array({Json::parse(material)});
        file.root["meshes"][0]["primitives"][0]["material"] = 0;
        return join_warnings(load(write_loaded_file("x.glb", file.glb_bytes())));
    };
    const std::string clear = R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0]}})";
    EXPECT_THAT(gltf(R"({"alphaMode":"BLEND",)" + clear), HasSubstr(said));
    EXPECT_THAT(gltf(R"({"alphaMode":"MASK",)" + clear), HasSubstr(said));
    EXPECT_THAT(gltf("{" + clear), Not(HasSubstr(said)));
}

TEST_F(LoadForeign, SmoothingGroupsGiveNormals) {
    // Two squares at a right angle along the z axis, and a third, of another group, behind them.
    const std::string roof = "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 1 1\nv 0 1 0\n";
    const auto normal_of_first_corner = [&](const std::string& faces) {
        const Scene scene = load(write_loaded_file("x.obj", roof + faces));
        const Mesh& mesh = scene.meshes.at(0);
        return mesh.normals[mesh.triangles.at(0).x];
    };
    const float slope = std::sqrt(.5f);
    const vec3 smooth = normal_of_first_corner("s 1\nf 1 2 3 4\nf 1 6 5 2\n"),
               flat = normal_of_first_corner("f 1 2 3 4\nf 1 6 5 2\n");
    EXPECT_NEAR(length(smooth - vec3(slope, slope, 0)), 0, 1e-6f);
    EXPECT_EQ(flat, vec3(0, 1, 0));
    EXPECT_EQ(normal_of_first_corner("s 1\nf 1 2 3 4\ns 2\nf 1 6 5 2\n"), flat);
    EXPECT_EQ(normal_of_first_corner("s off\nf 1 2 3 4\nf 1 6 5 2\n"), flat);
    EXPECT_EQ(normal_of_first_corner("s 1\ns 0\nf 1 2 3 4\nf 1 6 5 2\n"), flat);
    EXPECT_EQ(normal_of_first_corner("vn 0 0 1\ns 1\nf 1//1 2//1 3//1\nf 1 6 5 2\n"), vec3(0, 0, 1))
        << "normals of the file win";
    EXPECT_THAT(load_error_text("y.obj", kTriangle + "vn 0 0 1\ns 1\nf 1 2 3\nf 1//2 2//2 3//2\n"),
                HasSubstr("face wants one of 1 normals, found 2"));
}

TEST_F(LoadForeign, ColoursOfVerticesAreReadAsSrgbAndSaidSo) {
    const Scene scene = load(write_loaded_file(
        "x.obj", "v 0 0 0 .5 .5 .5\nv 1 0 0 .5 .5 .5\nv 0 1 0 .5 .5 .5\nf 1 2 3\n"));
    EXPECT_NEAR(scene.meshes.at(0).colours.at(0).x, .214041f, 1e-5f);
    EXPECT_THAT(join_warnings(scene), HasSubstr("colours of vertices, read as sRGB"));
}

TEST_F(LoadForeign, ColoursOfGltfVerticesAreClamped) {
    GltfFileBuilder gltf = make_small_gltf();
    const std::size_t colours = gltf.add_accessor<float>({3, -1, .5f, 1, 1, 1, 1, 1, 1, 1, 1, 1},
                                                         "VEC3", 5126);
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
    const Scene scene = load(write_loaded_file("x.glb", gltf.glb_bytes()));
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.colours.at(mesh.triangles[0].x), vec4(1, 0, .5f, 1));
    EXPECT_THAT(join_warnings(scene), HasSubstr("COLOR_0"));
}

TEST_F(LoadForeign, LaterVersionsOfGltfAreRefused) {
    const auto asset = [](const std::string& least) {
        return make_gltf_text(R"("version":"2.0")", R"("version":"2.1","minVersion":)" + least);
    };
    for (const char* least : {"\"2.1\"", "\"3.0\"", "\"2\"", "2.0", "\"\""})
        EXPECT_THAT(load_error_text("x.gltf", asset(least)),
                    HasSubstr("asset.minVersion: wanted at most \"2.0\", found "))
            << least;
    for (const char* least : {"\"2.0\"", "\"1.1\""})
        EXPECT_EQ(load(write_loaded_file("y.gltf", asset(least))).objects.size(), 1u) << least;
}

TEST_F(LoadForeign, AttributesThatAreNotReadAreNamed) {
    GltfFileBuilder gltf = make_small_gltf();
    Json& primitive = gltf.root["meshes"][0]["primitives"][0];
    const std::vector<float> fours(16, .5f);
    for (const char* name : {"TANGENT", "COLOR_1", "_OWN"})
        primitive["attributes"][name] = gltf.add_accessor(fours, "VEC4", 5126);
    const auto warnings = [&] {
        return join_warnings(load(write_loaded_file("x.glb", gltf.glb_bytes())));
    };
    EXPECT_THAT(warnings(), AllOf(HasSubstr("'COLOR_1', not read"), Not(HasSubstr("TANGENT")),
                                  Not(HasSubstr("_OWN"))));
    gltf.root["images"] = {{{"uri", "gone.png"}}};
    gltf.root["textures"] = {{{"source", 0}}};
    gltf.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    primitive["material"] = 0;
    EXPECT_THAT(warnings(), HasSubstr("attributes TANGENT, not read"));
}

} // namespace
