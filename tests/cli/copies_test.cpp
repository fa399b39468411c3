// Tests of memory: many copies of a mesh take the memory of one mesh and a transform per copy.
#include "cli/triangle.hpp"

#include <cmath>
#include <numbers>

namespace {

using namespace test::loading;

/// Returns the vertex positions of a ball of 2 * 70 * 70 triangles, as bytes of a glTF buffer.
/// Triangles share no vertices.
std::string make_ball_positions() {
    constexpr int kBallSegments = 70;
    std::vector<float> floats;
    const auto add = [&](int i, int j) {
        const double a = 2 * std::numbers::pi * i / kBallSegments,
                     b = std::numbers::pi * j / kBallSegments;
        for (const double x : {std::sin(b) * std::cos(a), std::cos(b), -std::sin(b) * std::sin(a)})
            floats.push_back(static_cast<float>(x));
    };
    for (int i = 0; i < kBallSegments; ++i)
        for (int j = 0; j < kBallSegments; ++j) {
            for (const auto& [di, dj] : {std::pair{0, 0}, {0, 1}, {1, 1}}) add(i + di, j + dj);
            for (const auto& [di, dj] : {std::pair{0, 0}, {1, 1}, {1, 0}}) add(i + di, j + dj);
        }
    return {reinterpret_cast<const char*>(floats.data()), floats.size() * sizeof(float)};
}

/// Returns a glTF document with `count` balls side by side that share one mesh. `bytes` is the size
/// of the mesh's buffer.
Json make_gltf_of_balls(std::size_t bytes, int count) {
    Json scene = make_triangle_gltf("ball.bin");
    scene["accessors"][0]["count"] = bytes / 12;
    scene["bufferViews"][0]["byteLength"] = scene["buffers"][0]["byteLength"] = bytes;
    scene["nodes"] = Json::array();
    for (int i = 0; i < count; ++i)
        scene["nodes"].push_back(
            {{"mesh", 0}, {"translation", {2.5 * (i % 40), 2.5 * (i / 40), 0}}});
    return scene;
}

TEST_F(CommandLineTest, CopiesOfAMeshShareItsMemory) {
    const std::string bytes = make_ball_positions();
    write_input_file("ball.bin", bytes);
    std::uint64_t peaks[2];
    for (const int k : {0, 1}) {
        write_input_file("balls.gltf", make_gltf_of_balls(bytes.size(), k ? 2000 : 20).dump());
        const test::ProcessResult ended = test::run_process(
            make_process_start(add_small_frame_options(
                {"render", "balls.gltf", "--technique", "raytrace", "-o", "x.png"})));
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        peaks[k] = ended.peak_bytes;
    }
    // If each copy stored its own triangles, ray tracing 20 million triangles would read 2 GB.
    EXPECT_LT(peaks[1], peaks[0] + (64u << 20));
}

/// Returns an OBJ file of 100,000 objects of one triangle each. The objects lie side by side if
/// `apart` is set, else in one place.
std::string make_obj_of_many_objects(bool apart) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 100'000; ++i) {
        text += "o part" + std::to_string(i) + "\n";
        if (apart) {
            const std::string x = std::to_string(i % 316), y = std::to_string(i / 316);
            text += "v " + x + " " + y + " 0\nv " + x + ".9 " + y + " 0\nv " + x + " " + y +
                    ".9 0\nf -3 -2 -1\n";
        } else {
            text += "f 1 2 3\n";
        }
    }
    return text;
}

/// Returns a glTF document of 100,000 nodes that share one triangle. The nodes lie side by side if
/// `apart` is set, else in one place.
Json make_gltf_of_many_nodes(bool apart) {
    Json scene = make_triangle_gltf("corners.bin");
    scene["nodes"] = Json::array();
    for (int i = 0; i < 100'000; ++i)
        scene["nodes"].push_back(
            {{"mesh", 0}, {"translation", {apart ? i % 316 : 0, apart ? i / 316 : 0, 0}}});
    return scene;
}

TEST_F(CommandLineTest, HundredThousandObjectsTakeAtMostHalfAGibibyte) {
    write_input_file("corners.bin", encode_triangle_corners());
    // The frame of the auto exposure needs the most memory, so one more frame is enough.
    const auto make_words = [](const std::string& file, const char* technique) {
        return std::vector<std::string>{"render",   file,    "--technique", technique,
                                        "--size",   "32x32", "--frames",    "1",
                                        "--warmup", "0",     "-o",          "x.png"};
    };
    for (const bool apart : {false, true}) {
        write_input_file("many.obj", make_obj_of_many_objects(apart));
        write_input_file("many.gltf", make_gltf_of_many_nodes(apart).dump());
        for (const std::string file : {"many.obj", "many.gltf"}) {
            std::vector<std::vector<std::string>> commands{make_words(file, "hybrid")};
            // `hybrid` needs the most memory of all commands, so the others are tested only with
            // objects side by side.
            if (!apart) {
                commands.push_back({"info", file});
                commands.push_back(make_words(file, "raytrace"));
            }
            for (const std::vector<std::string>& words : commands) {
                const test::ProcessResult ended = test::run_process(make_process_start(words));
                ASSERT_EQ(ended.exit_code, 0) << ended.err;
                EXPECT_LE(ended.peak_bytes, 512U << 20)
                    << words[0] << " " << file << " " << words.back() << ", apart: " << apart;
            }
        }
    }
}

/// Rays that search for mirrors test coincident triangles once, not each of them.
TEST_F(CommandLineTest, MirrorsAmongCoincidentObjectsAreFoundQuickly) {
    for (const bool apart : {false, true}) {
        write_input_file("many.obj", make_obj_of_many_objects(apart));
        for (const std::string mirror : {"part1", "part99999"}) {
            const test::ProcessResult ended = test::run_process(make_process_start(
                add_small_frame_options({"graph", "many.obj", "--why", "--mirror", mirror})));
            ASSERT_EQ(ended.exit_code, 0) << ended.err;
            EXPECT_THAT(ended.out, testing::HasSubstr("mirror 1 '" + mirror + "'"));
            EXPECT_LE(ended.peak_bytes, 512U << 20) << mirror << ", apart: " << apart;
            EXPECT_LE(ended.processor_seconds, 10) << "about 1; 150 if each triangle is tested";
        }
    }
}

} // namespace
