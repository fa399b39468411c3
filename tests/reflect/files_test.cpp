// Tests that the scene files in samples/scenes render as the built-in scene.
#include "measure/flip.hpp"
#include "places.hpp"
#include "scene/built_in.hpp"
#include "support/folder.hpp"
#include "support/rendering.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <iostream>
#include <iterator>

namespace {

using namespace catoptric;

std::filesystem::path path_of_shipped_file(const std::string& ending) {
    return test::source_folder() / "samples/scenes" / ("cornell-mirrors." + ending);
}

class ShippedSceneFileTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Files, ShippedSceneFileTest, testing::Values("glb", "obj"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(ShippedSceneFileTest, FileRendersAsTheBuiltInScene) {
    const scene::Scene built_in = scene::make_cornell();
    const scene::Scene loaded = scene::load(path_of_shipped_file(GetParam()));
    for (const char* technique : {"raytrace", "parallax"})
        for (const double time : {0.0, 0.7}) {
            session::Request request = test::make_test_request(built_in, {technique}, {256, 256});
            request.time = time, request.frames = 3;
            const measure::Picture wanted =
                session::run(test::get_test_engine(), request).parts.front().hdr;
            request.scene = loaded, request.camera = loaded.cameras.at(0);
            const double error = test::rmse_of_pictures(
                session::run(test::get_test_engine(), request).parts.front().hdr, wanted);
            std::cout << "[ MEASURED ] ." << GetParam() << ", " << technique << " at " << time
                      << " s: rmse " << error << "\n";
            EXPECT_LE(error, 1e-3);
        }
}

/// Returns the .glb file with all its root nodes, the camera included, below a chain of `depth` new
/// nodes. Each new node rotates, moves and scales its children.
std::string put_roots_below_node_chain(const std::string& glb, int depth) {
    const auto number = [](const std::string& bytes, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    };
    const std::size_t head = 12 + 8, length = number(glb, 12);
    nlohmann::json json = nlohmann::json::parse(glb.substr(head, length));
    const std::size_t first = json["nodes"].size();
    for (int k = 0; k < depth; ++k) {
        // Half the angle in radians. The signs alternate so that the rotations cancel out, because
        // captures are aligned with the world's axes.
        const double half = k % 2 ? .3 : -.3;
        nlohmann::json node = {{"rotation", {0, std::sin(half), 0, std::cos(half)}},
                               {"translation", {40. * (k % 2), -3, k % 5}},
                               {"scale", {1.002, 1.002, 1.002}}};
        node["children"] = k + 1 < depth ? nlohmann::json::array({first + std::size_t(k) + 1})
                                         : json["scenes"][0]["nodes"];
        json["nodes"].push_back(node);
    }
    json["scenes"][0]["nodes"] = nlohmann::json::array({first});
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = glb.substr(0, head) + text + glb.substr(head + length);
    const auto put = [&](std::size_t at, std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        std::memcpy(bytes.data() + at, &word, 4);
    };
    put(12, text.size());
    put(8, bytes.size());
    return bytes;
}

using NestedGltfNodesTest = test::InFolder;

/// Stress case N4: below a thousand nested nodes the scene is about 7 times as large and far away.
/// The picture must stay the same.
TEST_F(NestedGltfNodesTest, SceneBelowAThousandNodesRendersTheSame) {
    std::ifstream file(path_of_shipped_file("glb"), std::ios::binary);
    const std::string glb((std::istreambuf_iterator<char>(file)), {});
    const std::filesystem::path path = folder / "nested.glb";
    std::ofstream(path, std::ios::binary) << put_roots_below_node_chain(glb, 1000);
    const scene::Scene flat = scene::load(path_of_shipped_file("glb")), nested = scene::load(path);
    const dmat4 there = nested.objects.front().world_from_object,
                here = flat.objects.front().world_from_object;
    EXPECT_NEAR(length(dvec3(there[0])) / length(dvec3(here[0])), std::pow(1.002, 1000), 1e-6);
    EXPECT_GT(length(dvec3(there[3] - here[3])), 1e4);
    for (const char* technique : {"raytrace", "parallax"})
        for (const double time : {0.0, 0.7}) {
            const auto display = [&](const scene::Scene& scene) {
                session::Request request = test::make_test_request(scene, {technique}, {256, 256});
                request.time = time, request.frames = 3;
                return session::run(test::get_test_engine(), request).parts.front().display;
            };
            const double flip = measure::flip_mean(measure::flip(display(nested), display(flat)));
            std::cout << "[ MEASURED ] 1000 nodes, " << technique << " at " << time << " s: FLIP "
                      << flip << "\n";
            EXPECT_LE(flip, 1e-3);
        }
}

} // namespace
