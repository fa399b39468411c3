// Tests of small scene files that would take gigabytes of memory or hours, or that hold false
// numbers. Each file must be refused, or render within 1 GiB. The tests print the table "bombs" of
// docs/data/extremes-files.md.
#include "cli/triangle.hpp"
#include "core/image_codec.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace test::loading;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class DecompressionBombCliTest : public CommandLineTest {
protected:
    /// Renders the file and expects the exit code, each of `parts` in stderr, short messages and
    /// little memory. Exit code 0 means that the file loads and renders. Prints a row of the table.
    void expect_exit_code_and_texts(const std::string& what, const std::string& file, int exit_code,
                                    const Words& parts = {}) const {
        // The program runs without limits, so that its time and memory are those that a user would
        // see.
        const test::ProcessResult ended = test::run_process(make_process_start(
            add_small_frame_options({"render", file, "--technique", "raytrace", "-o", "x.png"})));
        EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
        for (const std::string& part : parts) EXPECT_THAT(ended.err, testing::HasSubstr(part));
        EXPECT_LE(ended.peak_bytes, 1ull << 30);
        EXPECT_LE(ended.processor_seconds, 10) << "processor time hardly depends on other programs";
        // A refusal prints one line. A scene that renders may print several warnings of one line
        // each. On a loaded machine, lines of progress come between.
        std::istringstream lines(ended.err);
        std::vector<std::string> messages;
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), 300u) << line;
            if (line.find(", no estimate yet") == line.npos && line.find(" left, ") == line.npos)
                messages.push_back(line);
        }
        EXPECT_LE(messages.size(), exit_code == 0 ? 5u : 1u) << ended.err;
        ASSERT_FALSE(messages.empty());
        EXPECT_EQ(ended.out, "");
        std::string said = messages.front();
        if (const std::size_t at = said.find(folder.string()); at != said.npos)
            said.replace(at, folder.string().size(), "FOLDER");
        said = exit_code == 0 ? "(renders)" : said.substr(std::string("catoptric: ").size(), 110);
        std::cout << "[ MEASURED ] | " << what << " | " << fs::file_size(folder / file) / 1024 + 1
                  << " | " << exit_code << " | " << std::ceil(ended.seconds * 10) / 10 << " | "
                  << (ended.peak_bytes >> 20) << " | " << said << " |\n";
    }
    void expect_exit_code_and_texts(const std::string& what, const std::string& file,
                                    const Json& scene, int exit_code,
                                    const Words& parts = {}) const {
        write_input_file(file, scene.dump());
        expect_exit_code_and_texts(what, file, exit_code, parts);
    }
    /// Writes 20,000 triangles to a.bin. Returns a glTF document that shows them once.
    Json write_gltf_of_many_triangles() const {
        Json scene = make_triangle_gltf("a.bin");
        scene["accessors"][0]["count"] = 60'000;
        scene["bufferViews"][0]["byteLength"] = scene["buffers"][0]["byteLength"] = 720'000;
        std::string floats;
        for (int i = 0; i < 20'000; ++i) floats += encode_triangle_corners();
        write_input_file("a.bin", floats);
        return scene;
    }
    void SetUp() override { write_input_file("a.bin", encode_triangle_corners()); }
};

/// Returns a PNG of one pixel that ends in the middle of a chunk with the given name, which claims
/// 2 GB.
std::string make_png_with_huge_chunk(const std::string& name) {
    const std::string whole = catoptric::encode_png({{1, 1}, 1, {}}, std::vector<std::uint8_t>{0});
    constexpr std::size_t kSignatureAndHeader = 33;
    return whole.substr(0, kSignatureAndHeader) + "\x7f\xff\xff\xff" + name + "abc";
}

/// libpng allocates what a chunk claims before it reads the chunk.
TEST_F(DecompressionBombCliTest, PngChunkThatClaimsGigabytesTakesNoMemory) {
    constexpr std::uint64_t kMaxBytes = 100 << 20;
    const auto expect_refused = [&](const Words& words, const std::string& part) {
        const test::ProcessResult ended = run_cli(words);
        expect_exit_code(ended, 65, {part});
        EXPECT_LE(ended.peak_bytes, kMaxBytes) << words.back();
    };
    for (const std::string chunk : {"tEXt", "zTXt", "iTXt", "iCCP", "sPLT", "eXIf", "hIST", "pCAL",
                                    "PLTE", "tRNS", "abCd", "IDAT", "IEND"}) {
        write_input_file("p.png", make_png_with_huge_chunk(chunk));
        expect_refused({"diff", "p.png", "p.png"}, "p.png: cannot be decoded: ");
    }
    write_input_file("p.png", make_png_with_huge_chunk("tEXt"));
    expect_refused({"info", "cornell-mirrors", "--environment", "p.png"}, "p.png: cannot be dec");
    write_input_file("m.mtl", "newmtl a\nmap_Kd p.png\n");
    write_input_file("t.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n");
    expect_refused({"info", "t.obj"}, "'p.png': cannot be decoded: ");
}

TEST_F(DecompressionBombCliTest, EndlessDeviceIsNoInput) {
    write_input_file("p.png", catoptric::encode_png({{1, 1}, 1, {}}, std::vector<std::uint8_t>{0}));
    for (const Words& words : {Words{"diff", "/dev/zero", "p.png"},
                               {"choose", "--certify", "/dev/zero"},
                               {"choose", "--costs", "/dev/zero"},
                               {"info", "cornell-mirrors", "--environment", "/dev/zero"}}) {
        const test::ProcessResult ended = run_cli(words);
        expect_exit_code(ended, 65, {"/dev/zero: wanted "});
        EXPECT_LE(ended.peak_bytes, 1ull << 30) << words[1];
    }
}

TEST_F(DecompressionBombCliTest, ManyEmptyObjectsExceedTheMaterialBudget) {
    std::string text = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{}";
    for (int i = 0; i < 330'000; ++i) text += ",{}";
    write_input_file("empty.gltf", text + "]}");
    expect_exit_code_and_texts(
        "1 MB of empty objects", "empty.gltf", 65,
        {"empty.gltf", "wanted at most 125000 materials, the budget of a scene, found 125001"});
}

/// 600,000 accessors exceed the memory budget for a parsed JSON document.
TEST_F(DecompressionBombCliTest, ManyAccessorsExceedTheMemoryBudget) {
    Json scene = make_triangle_gltf("a.bin");
    std::string text = scene.dump(), more;
    for (int i = 0; i < 600'000; ++i)
        more += R"({"componentType":5126,"count":1,"type":"SCALAR"},)";
    text.insert(text.find('[', text.find("accessors")) + 1, more);
    write_input_file("accessors.gltf", text);
    expect_exit_code_and_texts("600,000 accessors", "accessors.gltf", 65,
                               {"bytes of memory for its JSON"});
}

TEST_F(DecompressionBombCliTest, AccessorOfFourThousandMillionElementsIsRefused) {
    Json scene = make_triangle_gltf("a.bin");
    scene["accessors"][0]["count"] = 4'000'000'000;
    expect_exit_code_and_texts("accessor of 4e9 elements", "count.gltf", scene, 65,
                               {"accessors[0]: wanted 4000000000 elements", "holds 3"});
    scene["accessors"][0].erase("bufferView");
    expect_exit_code_and_texts(
        "the same without a view", "view.gltf", scene, 65,
        {"accessors[0]: wanted at most 134217728 bytes of sparse accessors"});
}

TEST_F(DecompressionBombCliTest, NodeWithTwoParentsIsRefused) {
    Json scene = make_triangle_gltf("a.bin");
    scene["nodes"] = Json::array();
    for (int i = 0; i < 30; ++i) scene["nodes"].push_back({{"children", {i + 1, i + 1}}});
    scene["nodes"].push_back({{"mesh", 0}});
    expect_exit_code_and_texts(
        "30 nodes, each twice in the one before", "double.gltf", scene, 65,
        {"nodes[1]: wanted one parent at most, found nodes[0] and nodes[0]"});
}

TEST_F(DecompressionBombCliTest, ManyUsesOfOneMeshExceedTheVertexBudget) {
    Json nodes = write_gltf_of_many_triangles();
    for (int i = 0; i < 20'000; ++i) nodes["nodes"].push_back({{"mesh", 0}});
    expect_exit_code_and_texts(
        "20,000 nodes of a mesh of 20,000 triangles", "nodes.gltf", nodes, 65,
        {"wanted at most 200000000 vertices shown by objects, the budget of a scene, found "});
    Json primitives = write_gltf_of_many_triangles();
    Json& list = primitives["meshes"][0]["primitives"];
    const Json one = list[0];
    for (int i = 0; i < 10'000; ++i) list.push_back(one);
    expect_exit_code_and_texts(
        "10,000 primitives of the same numbers", "primitives.gltf", primitives, 65,
        {"wanted at most 4000000 vertices in meshes, the budget of a scene, found "});
}

TEST_F(DecompressionBombCliTest, MaterialLibraryNamedManyTimesIsReadOnce) {
    std::string text = "mtllib m.mtl", materials;
    for (int i = 0; i < 80'000; ++i) materials += "newmtl " + std::to_string(i) + "\n";
    for (int i = 0; i < 600; ++i) text += " m.mtl";
    write_input_file("m.mtl", materials);
    write_input_file("library.obj", text + "\n" + kTriangle + "f 1 2 3\n");
    expect_exit_code_and_texts("600 times a library of 80,000 materials: read once", "library.obj",
                               0);
}

TEST_F(DecompressionBombCliTest, ExpensiveObjFileIsRefused) {
    std::string text, face = "f", materials;
    for (int i = 0; i < 20'000; ++i) {
        const double angle = i * 2 * M_PI / 20'000, radius = 1 + i % 2;
        text += "v " + std::to_string(radius * std::cos(angle)) + " " +
                std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    write_input_file("star.obj", text + face + "\n");
    expect_exit_code_and_texts("a star of 20,000 corners", "star.obj", 65,
                               {"wanted at most 100000000 comparisons to cut concave polygons"});
    write_input_file("negative.obj", kTriangle + "f 1 2 -9223372036854775808\n");
    expect_exit_code_and_texts("index -9223372036854775808", "negative.obj", 65,
                               {"found -9223372036854775808"});
    text = "mtllib m.mtl\n" + kTriangle + "o " + std::string(100'000, 'n') + "\n";
    for (int i = 0; i < 400; ++i) {
        materials += "newmtl " + std::to_string(i) + "\n";
        text += "usemtl " + std::to_string(i) + "\nf 1 2 3\n";
    }
    write_input_file("m.mtl", materials), write_input_file("names.obj", text);
    expect_exit_code_and_texts("a name of 100 kB in 400 materials", "names.obj", 65,
                               {"bytes of names"});
}

TEST_F(DecompressionBombCliTest, LongUnknownNameIsLookedUpQuickly) {
    std::string materials;
    for (int i = 0; i < 50'000; ++i) materials += "newmtl material" + std::to_string(i) + "\n";
    write_input_file("m.mtl", materials);
    write_input_file("name.obj", "mtllib m.mtl\n" + kTriangle + "usemtl " +
                                     std::string(20'000, 'm') + "\nf 1 2 3\n");
    expect_exit_code_and_texts("a misspelt name of 20 kB, 50,000 names", "name.obj", 0,
                               {"drawn grey: 1", "mmm...' (20000 bytes)"});
}

TEST_F(DecompressionBombCliTest, FileOutsideTheFolderOrOfAnotherNameIsRefused) {
    fs::create_directories(folder / "in");
    write_input_file("secret.bin", encode_triangle_corners()),
        write_input_file("a b.bin", encode_triangle_corners());
    fs::create_symlink("../secret.bin", folder / "in/link.bin");
    expect_exit_code_and_texts("a link out of the folder", "in/link.gltf",
                               make_triangle_gltf("link.bin"), 65,
                               {"buffers[0]: wanted a file below '", "--root", "secret.bin'"});
    expect_exit_code_and_texts("`a+b.bin` where `a b.bin` lies", "plus.gltf",
                               make_triangle_gltf("a+b.bin"), 66, {"'a+b.bin' is not there"});
}

TEST_F(DecompressionBombCliTest, InvalidGltfValueIsRefused) {
    Json scene = make_triangle_gltf("a.bin");
    scene["nodes"][0]["rotation"] = {0, 0, 0, 0};
    expect_exit_code_and_texts("a quaternion of zeros", "rotation.gltf", scene, 65,
                               {"nodes[0]: rotation: wanted a quaternion with a length, found 0"});

    scene = make_triangle_gltf("a.bin");
    write_input_file("a.bin",
                     encode_triangle_corners() + std::string(8, '\0') + std::string(4, '\xff'));
    scene["buffers"][0]["byteLength"] = 48;
    scene["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 12}});
    scene["accessors"].push_back(
        {{"bufferView", 1}, {"componentType", 5125}, {"count", 3}, {"type", "SCALAR"}});
    scene["meshes"][0]["primitives"][0]["indices"] = 1;
    expect_exit_code_and_texts("index 4294967295", "index.gltf", scene, 65,
                               {"indices: wanted indices below 3, found 4294967295"});

    scene = make_triangle_gltf("a.bin");
    for (int i = 0; i < 20'000; ++i) scene["nodes"][i] = {{"children", {i + 1}}};
    scene["nodes"].push_back({{"mesh", 0}});
    expect_exit_code_and_texts("20,000 nodes one in another", "deep.gltf", scene, 65,
                               {"nodes[4096]: wanted at most 4096 nodes one in another"});
}

} // namespace
