// Tests of loading budgets. A file that asks for more than a budget allows is refused before
// anything of that size is allocated.
#include "scene/hash.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>

namespace {

using namespace test::loading;

class LoadBudgetTest : public Load {
protected:
    std::string budget_error_text(const std::string& name, const std::string& text,
                                  LoadBudget budget = {}) const {
        const std::string message = load_error_text(name, text, Failure::bad_data,
                                                    {.budget = budget});
        EXPECT_THAT(message, HasSubstr(", the budget of a scene, found "));
        return message;
    }
    /// Builds a glTF file whose list `list` contains `count` copies of `item`.
    static GltfFileBuilder make_gltf_with_copies_of_item(const char* list, std::size_t count,
                                                         const Json& item) {
        GltfFileBuilder gltf = make_small_gltf();
        gltf.root[list] = Json::array();
        for (std::size_t i = 0; i < count; ++i) gltf.root[list].push_back(item);
        return gltf;
    }
};

// ---- small files that expand to large scenes

TEST_F(LoadBudgetTest, TooManyNodesThatShareAMeshAreRefused) {
    GltfFileBuilder gltf = make_small_gltf(20'000);
    gltf.root["nodes"] = Json::array(), gltf.root["scenes"][0]["nodes"] = Json::array();
    for (int i = 0; i < 105; ++i) {
        gltf.root["nodes"].push_back({{"mesh", 0}});
        gltf.root["scenes"][0]["nodes"].push_back(i);
    }
    // Each object has 60,000 vertices: without normals in the file, triangles share no vertices.
    const LoadBudget shown{.shown = 2'000'000};
    EXPECT_THAT(budget_error_text("x.glb", gltf.glb_bytes(), shown),
                AllOf(HasSubstr("nodes[33]: wanted at most 2000000 vertices shown by objects"),
                      HasSubstr("found 2040000")));
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = gltf.add_accessor<float>(
        {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    EXPECT_THAT(budget_error_text("x.glb", gltf.glb_bytes(), shown),
                AllOf(HasSubstr("nodes[100]: wanted at most 2000000 triangles shown by objects"),
                      HasSubstr("found 2020000")));
}

TEST_F(LoadBudgetTest, TooManyPrimitivesThatShareAccessorsAreRefused) {
    GltfFileBuilder gltf = make_small_gltf(20'000);
    Json& primitives = gltf.root["meshes"][0]["primitives"];
    const Json one = primitives[0];
    for (int i = 1; i < 105; ++i) primitives.push_back(one);
    EXPECT_THAT(budget_error_text("x.glb", gltf.glb_bytes()),
                AllOf(HasSubstr("meshes[0] 'm': wanted at most 2000000 triangles in meshes"),
                      HasSubstr("found 2020000")));
    // Many accessors read the same bytes.
    GltfFileBuilder views = make_small_gltf();
    const std::size_t positions = views.add_accessor(std::vector<float>(3 * 99'999), "VEC3", 5126);
    for (int i = 0; i < 43; ++i) {
        views.root["accessors"].push_back(views.root["accessors"][positions]);
        views.root["meshes"].push_back(
            {{"primitives", {{{"attributes", {{"POSITION", positions + 1 + i}}}}}}});
    }
    EXPECT_THAT(budget_error_text("x.glb", views.glb_bytes()),
                HasSubstr("wanted at most 4000000 positions"));
}

TEST_F(LoadBudgetTest, PrimitivesMayShareALongListOfPositions) {
    GltfFileBuilder gltf = make_small_gltf();
    const std::size_t positions = gltf.add_accessor(std::vector<float>(3 * 100'000, 1.0f), "VEC3",
                                                    5126);
    Json& primitives = gltf.root["meshes"][0]["primitives"];
    // If each primitive copied all positions, there would be 10 million.
    for (int i = 0; i < 100; ++i)
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", 1}});
    EXPECT_EQ(triangle_count(load(write_loaded_file("x.glb", gltf.glb_bytes()))), 1u);
}

TEST_F(LoadBudgetTest, SharedAnimationKeysAreStoredAndCountedOnce) {
    constexpr std::size_t kAnimationKeyCount = 40'000, kNodes = 500;
    GltfFileBuilder gltf = make_small_gltf();
    std::vector<float> times(kAnimationKeyCount);
    for (std::size_t i = 0; i < kAnimationKeyCount; ++i) times[i] = float(i);
    const Json sampler = {
        {"input", gltf.add_accessor(times, "SCALAR", 5126)},
        {"output",
         gltf.add_accessor(std::vector<float>(3 * kAnimationKeyCount, 1.0f), "VEC3", 5126)}};
    Json channels = Json::array(), roots = Json::array();
    gltf.root["nodes"] = Json::array();
    for (std::size_t i = 0; i < kNodes; ++i) {
        gltf.root["nodes"].push_back({{"mesh", 0}});
        roots.push_back(i);
        channels.push_back({{"sampler", 0}, {"target", {{"node", i}, {"path", "translation"}}}});
    }
    gltf.root["scenes"][0]["nodes"] = roots;
    gltf.root["animations"] = {{{"samplers", {sampler}}, {"channels", channels}}};
    const Scene scene = load(write_loaded_file("x.glb", gltf.glb_bytes()));
    ASSERT_EQ(scene.objects.size(), kNodes);
    const auto keys_of = [&](std::size_t i) {
        return std::get<Keyframes>(scene.objects[i].motion).keys;
    };
    EXPECT_EQ(keys_of(0), keys_of(kNodes - 1)) << "one copy";
    EXPECT_EQ(keys_of(0)->times.size(), kAnimationKeyCount);
    EXPECT_NE(hash_scene(scene), hash_scene(scene_at(scene, 0)));

    for (std::size_t i = 1; i < kNodes; ++i) {
        gltf.root["animations"][0]["samplers"].push_back(sampler);
        gltf.root["animations"][0]["channels"][i]["sampler"] = i;
    }
    EXPECT_THAT(budget_error_text("x.glb", gltf.glb_bytes()),
                AllOf(HasSubstr("animations[0]: samplers[25]: wanted at most 1000000 keys"),
                      HasSubstr("found 1040000")));
}

TEST_F(LoadBudgetTest, KeysOfAMovingParentAreSharedByItsChildren) {
    GltfFileBuilder gltf = make_small_gltf();
    const Json sampler = {{"input", gltf.add_accessor<float>({0, 1}, "SCALAR", 5126)},
                          {"output", gltf.add_accessor<float>({0, 0, 0, 0, 0, 8}, "VEC3", 5126)}};
    gltf.root["nodes"] = {
        {{"children", {1, 2}}}, {{"mesh", 0}}, {{"mesh", 0}, {"scale", {2, 2, 2}}}};
    gltf.root["animations"] = {
        {{"samplers", {sampler}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const Scene scene = load(write_loaded_file("x.glb", gltf.glb_bytes()));
    EXPECT_EQ(std::get<Keyframes>(scene.objects[0].motion).keys,
              std::get<Keyframes>(scene.objects[1].motion).keys);
    EXPECT_EQ(scene_at(scene, .5).objects[1].world_from_object[3], dvec4(0, 0, 4, 1));
}

TEST_F(LoadBudgetTest, TooManyBytesOfNamesAreRefused) {
    GltfFileBuilder gltf = make_gltf_with_copies_of_item("nodes", 1000, {{"mesh", 0}});
    gltf.root["meshes"][0]["name"] = std::string(100'000, 'n');
    gltf.root.erase("scenes"), gltf.root.erase("scene");
    const std::string message = budget_error_text("x.glb", gltf.glb_bytes());
    EXPECT_THAT(message, HasSubstr("wanted at most 67108864 bytes of names"));
    EXPECT_LT(message.size(), 400u);

    std::string text = "mtllib m.mtl\n" + kTriangle + "o " + std::string(100'000, 'n') + "\n",
                materials;
    for (int i = 0; i < 400; ++i) {
        materials += "newmtl " + std::to_string(i) + "\n";
        text += "usemtl " + std::to_string(i) + "\nf 1 2 3\n";
    }
    write_loaded_file("m.mtl", materials);
    EXPECT_THAT(budget_error_text("x.obj", text), HasSubstr("bytes of names"));
}

TEST_F(LoadBudgetTest, MaterialLibraryNamedManyTimesIsReadOnce) {
    std::string materials;
    for (int i = 0; i < 1000; ++i) materials += "newmtl " + std::to_string(i) + "\n";
    write_loaded_file("m.mtl", materials);
    fs::create_symlink("m.mtl", folder / "n.mtl");
    std::string text;
    for (int i = 0; i < 300; ++i) text += "mtllib m.mtl n.mtl ./m.mtl\n";
    const Scene scene = load(
        write_loaded_file("x.obj", text + kTriangle + "usemtl 999\nf 1 2 3\n"));
    EXPECT_EQ(scene.materials.size(), 1000u);
    EXPECT_EQ(scene.materials[scene.objects[0].material].name, "999");
    EXPECT_THAT(budget_error_text("y.obj",
                                  [&] {
                                      for (int i = 0; i < 2000; ++i)
                                          text += "mtllib m.mtl n.mtl ./m.mtl\n";
                                      return text;
                                  }()),
                HasSubstr("wanted at most 4000 names of files"));
}

TEST_F(LoadBudgetTest, PolygonsThatNeedTooManyComparisonsAreRefused) {
    std::string text, face = "f";
    for (int i = 0; i < 20'000; ++i) {
        const double angle = i * 2 * M_PI / 20'000, radius = 1 + i % 2;
        text += "v " + std::to_string(radius * std::cos(angle)) + " " +
                std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    EXPECT_THAT(budget_error_text("x.obj", text + face + "\n"),
                HasSubstr("x.obj:20001: wanted at most 100000000 comparisons to cut concave "
                          "polygons"));
}

TEST_F(LoadBudgetTest, FilesLongerThanTheBudgetAreRefused) {
    write_loaded_file("x.bin", "");
    fs::resize_file(folder / "x.bin", 200ull << 30); // a sparse file without disk blocks
    GltfFileBuilder gltf = make_small_gltf();
    gltf.root["buffers"] = {{{"byteLength", 36}, {"uri", "x.bin"}}};
    EXPECT_THAT(
        budget_error_text("x.gltf", gltf.root.dump()),
        AllOf(HasSubstr("buffers[0]: 'x.bin': wanted at most 268435456 bytes in its files")));
    for (const char* name : {"y.obj", "y.gltf", "y.glb"}) {
        write_loaded_file(name, "");
        fs::resize_file(folder / name, 200ull << 30);
        EXPECT_THAT([&] { load((folder / name).string()); },
                    testing::ThrowsMessage<Error>(HasSubstr("268435456 bytes in its files")));
    }
}

// ---- the limit of each budget

TEST_F(LoadBudgetTest, TooLongGltfListsAreRefused) {
    EXPECT_THAT(
        budget_error_text(
            "x.glb", make_gltf_with_copies_of_item("nodes", 125'001, Json::object()).glb_bytes()),
        AllOf(HasSubstr("nodes[125000]: wanted at most 125000 nodes"), HasSubstr("found 125001")));
    const auto of = [&](const char* list, const Json& item) {
        return budget_error_text(
            "x.glb", make_gltf_with_copies_of_item(list, 101, item).glb_bytes(), {.objects = 100});
    };
    EXPECT_THAT(of("meshes", Json::object()), HasSubstr("meshes[100]: wanted at most 100 meshes"));
    EXPECT_THAT(of("materials", Json::object()), HasSubstr("wanted at most 100 materials"));
    EXPECT_THAT(of("cameras", {{"type", "orthographic"}}), HasSubstr("wanted at most 100 cameras"));
    EXPECT_THAT(of("animations", {{"samplers", {Json::object()}},
                                  {"channels", {{{"sampler", 0}, {"target", Json::object()}}}}}),
                HasSubstr("wanted at most 100 animation channels"));
    const Json one = make_small_gltf().root["meshes"][0]["primitives"][0];
    Json primitives = Json::array();
    for (int i = 0; i < 101; ++i) primitives.push_back(one);
    EXPECT_THAT(of("meshes", {{"primitives", primitives}}),
                HasSubstr("wanted at most 100 primitives"));
}

TEST_F(LoadBudgetTest, EachBudgetCanBeLowered) {
    const auto with = [](auto member, std::uint64_t value) {
        LoadBudget budget;
        budget.*member = value;
        return budget;
    };
    const std::string glb = make_small_gltf(3).glb_bytes(),
                      obj = kTriangle + "vn 0 0 1\nf 1 2 3\nf 1 3 2\no b\nf 1 2 3\n";
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::triangles, 2)),
                HasSubstr("2 triangles in meshes"));
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::vertices, 3)),
                HasSubstr("3 positions"));
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::vertices, 12)),
                HasSubstr("12 vertices in meshes"));
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::json_bytes, 99)),
                HasSubstr("99 bytes of JSON"));
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::json_memory, 99)),
                HasSubstr("99 bytes of memory for its JSON"));
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::file_bytes, 99)),
                HasSubstr("99 bytes in its files"));
    EXPECT_THAT(budget_error_text("x.glb", glb, with(&LoadBudget::objects, 0)),
                HasSubstr("0 meshes"));
    EXPECT_THAT(budget_error_text("x.obj", obj, with(&LoadBudget::triangles, 2)),
                HasSubstr("x.obj:8: wanted at most 2 triangles"));
    EXPECT_THAT(budget_error_text("x.obj", obj, with(&LoadBudget::vertices, 2)),
                HasSubstr("x.obj:3: wanted at most 2 positions"));
    EXPECT_THAT(budget_error_text("x.obj", obj, with(&LoadBudget::objects, 1)),
                HasSubstr("1 objects"));
    EXPECT_THAT(budget_error_text("x.obj",
                                  kTriangle + "# catoptric motion a step 2 0 0 0 0 1 0 0 0\n",
                                  with(&LoadBudget::keys, 1)),
                HasSubstr("x.obj:4: wanted at most 1 keys"));
}

// ---- large, valid files

TEST_F(LoadBudgetTest, MillionTrianglesFitTheBudget) {
    constexpr std::uint32_t kTextureSideTexels = 708;
    GltfFileBuilder gltf = make_small_gltf();
    std::vector<float> positions;
    std::vector<std::uint32_t> corners;
    for (std::uint32_t y = 0; y <= kTextureSideTexels; ++y)
        for (std::uint32_t x = 0; x <= kTextureSideTexels; ++x) {
            positions.insert(positions.end(), {float(x), float(y), float(x * y % 7)});
            const std::uint32_t a = y * (kTextureSideTexels + 1) + x,
                                b = a + kTextureSideTexels + 1;
            if (x < kTextureSideTexels && y < kTextureSideTexels)
                corners.insert(corners.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    Json& primitive = gltf.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = gltf.add_accessor(positions, "VEC3", 5126);
    primitive["indices"] = gltf.add_accessor(corners, "SCALAR", 5125);
    const Scene scene = load(write_loaded_file("x.glb", gltf.glb_bytes()));
    EXPECT_EQ(triangle_count(scene), 2 * kTextureSideTexels * kTextureSideTexels);
    EXPECT_EQ(scene.meshes[0].positions.size(), 6 * kTextureSideTexels * kTextureSideTexels)
        << "each triangle has its normal";
}

TEST_F(LoadBudgetTest, HundredThousandNamesFitTheBudget) {
    constexpr std::size_t kItemCount = 100'000;
    std::string text = "mtllib m.mtl\n" + kTriangle, materials;
    for (std::size_t i = 0; i < kItemCount; ++i) {
        const std::string name = "a rather long name, as exporters make them " + std::to_string(i);
        materials += "newmtl " + name + "\n";
        text += "o " + name + "\nusemtl " + name + "\nf 1 2 3\n";
    }
    write_loaded_file("m.mtl", materials);
    const Scene scene = load(write_loaded_file("x.obj", text));
    ASSERT_EQ(scene.objects.size(), kItemCount);
    EXPECT_EQ(scene.objects.back().material, kItemCount - 1);

    GltfFileBuilder gltf = make_gltf_with_copies_of_item("nodes", kItemCount, {{"mesh", 0}});
    gltf.root.erase("scenes"), gltf.root.erase("scene");
    Json& primitives = gltf.root["meshes"][0]["primitives"];
    const Json one = primitives[0];
    primitives = Json::array();
    for (std::size_t i = 0; i < kItemCount; ++i) {
        gltf.root["materials"].push_back({{"name", std::to_string(i)}});
        primitives.push_back(one);
        primitives.back()["material"] = i;
    }
    gltf.root["nodes"] = {{{"mesh", 0}}};
    EXPECT_EQ(load(write_loaded_file("x.glb", gltf.glb_bytes())).objects.size(), kItemCount);
}

} // namespace
