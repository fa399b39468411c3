// Tests of every file reader with randomly changed files. Half of the files are changed anywhere,
// half in their structure, so that they pass the first parse. Each run must end with a known exit
// code and no signal, within 10 s of processor time and 1 GiB. CATOPTRIC_FUZZED sets the number of
// files per reader.
#include "cli/program.hpp"
#include "fuzzed/mutate.hpp"
#include "measure/picture_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

namespace {

using namespace test::fuzzed;

constexpr std::uint64_t kMutationSeed = 20261124;
constexpr std::uint64_t kMaxMemoryBytes = 1ULL << 30;
constexpr std::uint64_t kMaxProcessorSeconds = 10;
constexpr int kDefaultFilesPerReader = 24; ///< files per reader if CATOPTRIC_FUZZED is not set

int count_files_per_reader() {
    const char* asked = std::getenv("CATOPTRIC_FUZZED");
    return asked == nullptr ? kDefaultFilesPerReader : std::atoi(asked);
}

/// Exit codes with which a reader may end: 0 accepted, 65 bad data, 66 missing file, 75 out of
/// memory. 2 is for errors of a file that a command line could also cause. 1 means that pictures
/// differ or a benchmark is slower.
const std::set<int> kExitCodes{0, 1, 2, 65, 66, 75};

class Readers : public CommandLineTest {
protected:
    using Change = std::function<std::string(Random&)>;

    /// Writes each changed file under the name `file`, and runs the command `words`, which reads
    /// the file. `good`: the unchanged file. The command must accept `good`, because otherwise it
    /// would refuse every file and test nothing.
    void feed_changed_files_to_program(const std::string& file, const std::string& good,
                                       const Words& words, const Change& anywhere,
                                       const Change& in_structure) const {
        write_input_file(file, good);
        const test::ProcessResult taken = run_cli(words);
        ASSERT_EQ(taken.exit_code, 0) << file << ", unchanged\n" << taken.err;
        std::map<int, int> codes;
        int structured_taken = 0;
        std::uint64_t most_bytes = 0;
        double longest = 0;
        const int count = count_files_per_reader();
        for (int i = 0; i < count; ++i) {
            Random random(kMutationSeed + static_cast<std::uint64_t>(i));
            const bool is_structured = i % 2 == 0;
            write_input_file(file, (is_structured ? in_structure : anywhere)(random));
            test::ProcessStartOptions process = make_process_start(words);
            process.seconds_limit = kMaxProcessorSeconds;
            const test::ProcessResult ended = test::run_process(process);
            ++codes[ended.exit_code];
            structured_taken += is_structured && ended.exit_code <= 1;
            most_bytes = std::max(most_bytes, ended.peak_bytes);
            longest = std::max(longest, ended.seconds);
            const std::string which = file + " of seed " + std::to_string(kMutationSeed) + " + " +
                                      std::to_string(i) +
                                      (is_structured ? ", in structure" : ", anywhere");
            EXPECT_TRUE(kExitCodes.contains(ended.exit_code))
                << which << ": exit code " << ended.exit_code << "\n"
                << ended.err;
            EXPECT_LE(ended.peak_bytes, kMaxMemoryBytes) << which;
            EXPECT_THAT(ended.err, testing::Not(testing::HasSubstr("json.exception"))) << which;
            if (HasFailure()) keep_wrongly_read_file(file, i);
        }
        EXPECT_GT(codes[0], 0) << file << ": every change was refused";
        EXPECT_LT(codes[0], count) << file << ": the file is not read";
        std::cout << "[ MEASURED ] " << file << ": " << count << " files, exit codes";
        for (const auto& [code, times] : codes) std::cout << " " << code << " x" << times;
        std::cout << "; of " << (count + 1) / 2 << " changed in structure " << structured_taken
                  << " taken; at most " << (most_bytes >> 20) << " MiB and " << longest << " s\n";
    }

    /// Returns a glTF document with textures, lights, a camera and a motion. `buffer`: the file of
    /// its buffer; empty for a .glb.
    Json make_gltf_scene(const std::string& buffer) const {
        Json document = {
            {"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0, 2, 3}}}}},
            {"nodes",
             {{{"name", "sheet"},
               {"mesh", 0},
               {"children", {1}},
               {"rotation", {0, 0, 0, 1}},
               {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
              {{"mesh", 0}, {"scale", {1, 1, -1}}, {"translation", {0, 0, 1}}},
              {{"camera", 0}, {"translation", {0.5, 0.5, 3}}},
              {{"mesh", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1}}}}},
            {"cameras",
             {{{"type", "perspective"},
               {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"aspectRatio", 1.5}}}}}},
            {"meshes",
             {{{"primitives",
                {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}},
                  {"indices", 3},
                  {"material", 0}}}}},
              {{"name", "mirror"},
               {"primitives",
                {{{"attributes", {{"POSITION", 0}}}, {"mode", 5}, {"material", 1}}}}}}},
            {"materials",
             {{{"name", "painted"},
               {"pbrMetallicRoughness",
                {{"baseColorTexture", {{"index", 0}}}, {"roughnessFactor", 0.6}}},
               {"emissiveFactor", {0.1, 0.1, 0.1}},
               {"alphaMode", "MASK"},
               {"alphaCutoff", 0.4},
               {"extensions",
                {{"KHR_materials_ior", {{"ior", 1.4}}},
                 {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}},
              {{"name", "silver"},
               {"doubleSided", true},
               {"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}}}},
            {"textures", {{{"source", 0}, {"sampler", 0}}}},
            {"samplers", {{{"magFilter", 9729}, {"wrapS", 10497}, {"wrapT", 33071}}}},
            {"images", {{{"uri", "p.png"}}}},
            {"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_ior"}},
            {"extensions",
             {{"KHR_lights_punctual",
               {{"lights",
                 {{{"type", "spot"}, {"intensity", 20}, {"spot", {{"outerConeAngle", 0.7}}}}}}}}}},
            {"animations",
             {{{"samplers", {{{"input", 4}, {"output", 5}, {"interpolation", "LINEAR"}}}},
               {"channels",
                {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}}},
            {"accessors",
             {{{"bufferView", 0},
               {"componentType", 5126},
               {"count", 4},
               {"type", "VEC3"},
               {"min", {0, 0, 0}},
               {"max", {1, 1, 0}}},
              {{"bufferView", 1}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
              {{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
              {{"bufferView", 3}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}},
              {{"bufferView", 4}, {"componentType", 5126}, {"count", 2}, {"type", "SCALAR"}},
              {{"bufferView", 5}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}}}},
            {"bufferViews",
             {{{"buffer", 0}, {"byteLength", 48}},
              {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 48}},
              {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 32}},
              {{"buffer", 0}, {"byteOffset", 128}, {"byteLength", 12}},
              {{"buffer", 0}, {"byteOffset", 140}, {"byteLength", 8}},
              {{"buffer", 0}, {"byteOffset", 148}, {"byteLength", 24}}}},
            {"buffers", {{{"byteLength", 172}}}}};
        if (!buffer.empty()) document["buffers"][0]["uri"] = buffer;
        return document;
    }
    static std::string make_gltf_buffer() {
        std::string bytes;
        const auto floats = [&](std::initializer_list<float> numbers) {
            for (const float number : numbers)
                bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
        };
        floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
        floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
        floats({0, 0, 1, 0, 0, 1, 1, 1});
        constexpr std::uint16_t kTestIndices[] = {0, 1, 2, 2, 1, 3};
        for (const std::uint16_t index : kTestIndices)
            bytes.append(reinterpret_cast<const char*>(&index), sizeof index);
        floats({0, 1, 0, 0, 1, 0, 1, 1});
        return bytes;
    }
    static catoptric::measure::Picture make_test_picture() {
        catoptric::measure::Picture made(24, 16);
        for (std::size_t i = 0; i < made.pixels.size(); ++i)
            made.pixels[i] = {static_cast<float>(i % 24) / 24, static_cast<float>(i) / 384, .5F};
        return made;
    }
    /// Returns a Radiance picture file: a header and uncompressed pixels of four bytes.
    static std::string make_hdr_file() {
        std::string file = "#?RADIANCE\nEXPOSURE=1.0\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 6\n";
        for (int i = 0; i < 24; ++i) file += std::string("\x40\x80\x20\x80", 4);
        return file;
    }
    static std::string make_obj_text() {
        return "# catoptric camera front 0 1 4 0 0 0 0 1 0 45\nmtllib m.mtl\no sheet\nv -1 0 0\nv 1 0 0\nv 1 2 0\n"
               "v -1 2 0 0.5 0.5 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nusemtl painted\n"
               "f 1/1/1 2/2/1 3/3/1 4/4/1\ng mirror\nusemtl silver\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
               "f -3 -2 -1\nl 1 2\ns off\n";
    }
    static std::string make_mtl_text() {
        return "newmtl painted\nKd 0.5 0.4 0.3\nKe 0.1 0.1 0.1\nmap_Kd -s 2 2 1 p.png\nKs 0.2 0.2 0.2\nNs 40\nillum 2\n"
               "d 0.9\nNi 1.4\nnewmtl silver\nKd 0 0 0\nKs 1 1 1\nillum 3\nNs 1000\nKe 0 0 0\nPr 0\nPm 1\n";
    }

    void SetUp() override {
        write_input_file("a.bin", make_gltf_buffer());
        write_input_file("p.png", catoptric::measure::encode_png(make_test_picture()));
        write_input_file("good.exr", catoptric::measure::encode_exr(make_test_picture()));
        write_input_file("m.mtl", make_mtl_text());
        write_input_file("good.obj", make_obj_text());
        std::filesystem::create_directory(folder_of_kept_files());
    }

private:
    static std::filesystem::path folder_of_kept_files() {
        return std::filesystem::path(CATOPTRIC_CLI).parent_path() / "fuzzed";
    }
    /// Keeps a copy of a file that a reader handled wrongly, in the folder `fuzzed` beside the
    /// program.
    void keep_wrongly_read_file(const std::string& file, int index) const {
        std::error_code error;
        std::filesystem::copy_file(folder / file,
                                   folder_of_kept_files() / (std::to_string(index) + "-" + file),
                                   std::filesystem::copy_options::overwrite_existing, error);
    }
};

TEST_F(Readers, ChangedGltfFilesAreReadOrRefused) {
    const Json document = make_gltf_scene("a.bin");
    feed_changed_files_to_program(
        "scene.gltf", document.dump(1), {"info", "scene.gltf"},
        [&](Random& random) { return change_random_bytes(document.dump(1), random); },
        [&](Random& random) { return change_json_document(document, random).dump(1); });
}

TEST_F(Readers, ChangedGlbFilesAreReadOrRefused) {
    const std::string glb = make_glb_file(make_gltf_scene(""), make_gltf_buffer());
    feed_changed_files_to_program(
        "scene.glb", glb, {"info", "scene.glb"},
        [&](Random& random) { return change_random_bytes(glb, random); },
        [&](Random& random) { return change_glb_file(glb, random); });
}

TEST_F(Readers, ChangedObjFilesAreReadOrRefused) {
    feed_changed_files_to_program(
        "scene.obj", make_obj_text(), {"info", "scene.obj"},
        [&](Random& random) { return change_random_bytes(make_obj_text(), random); },
        [&](Random& random) { return change_text_lines(make_obj_text(), random); });
}

TEST_F(Readers, ChangedMtlFilesAreReadOrRefused) {
    feed_changed_files_to_program(
        "m.mtl", make_mtl_text(), {"info", "good.obj"},
        [&](Random& random) { return change_random_bytes(make_mtl_text(), random); },
        [&](Random& random) { return change_text_lines(make_mtl_text(), random); });
}

TEST_F(Readers, ChangedExrFilesAreReadOrRefused) {
    const std::string exr = read_output_file("good.exr");
    feed_changed_files_to_program(
        "a.exr", exr, {"diff", "a.exr", "good.exr"},
        [&](Random& random) { return change_random_bytes(exr, random); },
        [&](Random& random) { return change_exr_file(exr, random); });
}

TEST_F(Readers, ChangedHdrFilesAreReadOrRefused) {
    feed_changed_files_to_program(
        "a.hdr", make_hdr_file(), {"info", "good.obj", "--environment", "a.hdr"},
        [&](Random& random) { return change_random_bytes(make_hdr_file(), random); },
        [&](Random& random) {
            const std::size_t pixels = make_hdr_file().find('\x40');
            return change_text_lines(make_hdr_file().substr(0, pixels), random) +
                   make_hdr_file().substr(pixels);
        });
}

TEST_F(Readers, ChangedPngFilesAreReadOrRefused) {
    const std::string png = read_output_file("p.png");
    feed_changed_files_to_program(
        "a.png", png, {"diff", "a.png", "p.png"},
        [&](Random& random) { return change_random_bytes(png, random); },
        [&](Random& random) { return change_png_file(png, random); });
}

TEST_F(Readers, ChangedSceneOverrideFilesAreReadOrRefused) {
    const Json document = {{"mirrors", Json::array({"mirror=0.9"})},
                           {"lights", Json::array({"sheet"})},
                           {"mirror_max_roughness", 0.1},
                           {"dielectric_mirrors", false},
                           {"multiple_scattering", "turquin"},
                           {"glass_shadow", "tint"},
                           {"light_samples", 4},
                           {"environment_shadows", 4},
                           {"environment", "good.exr"},
                           {"environment_scale", 1},
                           {"environment_rotate", 90},
                           {"ambient", 0},
                           {"exposure", 0},
                           {"camera", "0,1.6,3:0,1,0:50"},
                           {"up", "y"},
                           {"animation", "none"}};
    feed_changed_files_to_program(
        "good.obj.catoptric.json", document.dump(1), {"info", "good.obj"},
        [&](Random& random) { return change_random_bytes(document.dump(1), random); },
        [&](Random& random) { return change_json_document(document, random).dump(1); });
}

TEST_F(Readers, ChangedPlanFilesAreReadOrRefused) {
    const Json document = {
        {"plan",
         {{{"mirror", 1}, {"technique", "secant"}, {"settings", {{"face", 64}, {"steps", "2"}}}},
          {{"mirror", "ball*"}, {"technique", "reuse"}, {"name", "b"}, {"why", "small"}},
          {{"mirror", "*"}, {"technique", "hybrid"}}}}};
    feed_changed_files_to_program(
        "plan.json", document.dump(1), {"graph", "--plan", "plan.json", "--why"},
        [&](Random& random) { return change_random_bytes(document.dump(1), random); },
        [&](Random& random) { return change_json_document(document, random).dump(1); });
}

TEST_F(Readers, ChangedBenchmarkFilesAreReadOrRefused) {
    Json document = {{"context", {{"date", "2026-11-24T03:00:00+00:00"}, {"num_cpus", 2}}},
                     {"benchmarks", Json::array()}};
    for (int round = 0; round < 6; ++round)
        for (const char* name : {"frame/reuse", "frame/hybrid"})
            document["benchmarks"].push_back({{"name", name},
                                              {"run_name", name},
                                              {"run_type", "iteration"},
                                              {"repetition_index", round},
                                              {"repetitions", 6},
                                              {"iterations", 4},
                                              {"real_time", 4.0 + round / 10.0},
                                              {"cpu_time", 8.0},
                                              {"time_unit", "ms"}});
    write_input_file("before.json", document.dump());
    ASSERT_EQ(run_cli({"bench", "--compare", "before.json", "before.json"}).exit_code, 0);
    feed_changed_files_to_program(
        "now.json", document.dump(1), {"bench", "--compare", "before.json", "now.json"},
        [&](Random& random) { return change_random_bytes(document.dump(1), random); },
        [&](Random& random) { return change_json_document(document, random).dump(1); });
}

TEST_F(Readers, ChangedDeviceProfilesAreReadOrRefused) {
    const Json info = Json::parse(run_cli({"list", "devices", "--json"}).out)["devices"][0];
    const Json document = {
        {"schema", "catoptric/device-profile/1"},
        {"version", "0.1.0"},
        {"device", {{"name", info["name"]}, {"driver", info["driver"]}, {"id", info["id"]}}},
        {"variants", {{"groups", "scattered"}}},
        {"measured", Json::array()}};
    feed_changed_files_to_program(
        "profile.json", document.dump(1), {"info", "--device-profile", "profile.json"},
        [&](Random& random) { return change_random_bytes(document.dump(1), random); },
        [&](Random& random) { return change_json_document(document, random).dump(1); });
}

TEST_F(Readers, ChangedCostFilesAreReadOrRefused) {
    Json document = {{"schema", "catoptric/costs/1"},
                     {"device", "a device"},
                     {"origin", "literature"},
                     {"costs", Json::array()}};
    for (const char* work : {"camera_rays", "mirror_rays", "colour_lookups", "fragments", "draws"})
        document["costs"].push_back(
            {{"work", work}, {"ns", 2.5}, {"range", {1.0, 4.0}}, {"source", "a paper"}});
    feed_changed_files_to_program(
        "costs.json", document.dump(1),
        {"compare", "-o", "out", "--size", "8x8", "--frames", "1", "--warmup", "0", "--techniques",
         "reuse:face=8", "--costs", "costs.json"},
        [&](Random& random) { return change_random_bytes(document.dump(1), random); },
        [&](Random& random) { return change_json_document(document, random).dump(1); });
}

} // namespace
