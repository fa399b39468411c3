#pragma once

#include "core/error.hpp"
#include "core/file.hpp"
#include "import/file_options.hpp"
#include "import/load.hpp"
#include "support/folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Helpers of the loader tests, which write and load small valid and invalid scene files.
namespace test::loading {

using namespace catoptric;
using namespace catoptric::scene;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

class Load : public InFolder {
protected:
    std::string write_loaded_file(const std::string& name, const std::string& text) const {
        write_file(folder / name, text);
        return (folder / name).string();
    }
    /// Writes `text` to a file and loads the file. Expects an error of kind `failure` and returns
    /// its message.
    std::string load_error_text(const std::string& name, const std::string& text,
                                Failure failure = Failure::bad_data,
                                const FileOptions& options = {}) const {
        const std::string path = write_loaded_file(name, text);
        try {
            load_file(path, options);
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, failure) << error.what();
            EXPECT_THAT(error.what(), HasSubstr(path));
            return error.what();
        }
        ADD_FAILURE() << "nothing was thrown";
        return {};
    }
};

/// OBJ text of three positions, to which tests append faces.
inline const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Returns the text of a .gltf file with one triangle. In the text, `to` replaces the first `from`.
inline std::string make_gltf_text(const std::string& from = "", const std::string& to = "") {
    std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"n","mesh":0}],"meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    if (const std::size_t place = text.find(from); !from.empty()) {
        EXPECT_NE(place, text.npos) << from;
        text.replace(place, from.size(), to);
    }
    return text;
}

using Json = nlohmann::json;

/// Builds a .glb file from JSON and binary data.
struct GltfFileBuilder {
    Json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string data;

    /// Appends the values to the buffer, adds a buffer view and an accessor, and returns the index
    /// of the accessor.
    template <typename Value>
    std::size_t add_accessor(const std::vector<Value>& values, const char* type, int component) {
        const std::size_t size = values.size() * sizeof(Value);
        const std::string kind = type;
        const std::size_t width = kind == "SCALAR" ? 1 : kind == "MAT4" ? 16 : kind[3] - '0';
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", size}});
        data.append(reinterpret_cast<const char*>(values.data()), size);
        data.resize((data.size() + 3) / 4 * 4, '\0');
        root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", values.size() / width},
                                     {"type", type}});
        return root["accessors"].size() - 1;
    }
    std::string glb_bytes() const {
        Json whole = root;
        if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", data.size()}}};
        const auto word = [](std::size_t value) {
            const auto number = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&number), 4);
        };
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) +
               "JSON" + text + word(data.size()) + std::string("BIN\0", 4) + data;
    }
};

/// Builds a glTF file of one node, whose mesh has `triangles` equal triangles. Accessor 0 has four
/// positions, accessor 1 the indices.
inline GltfFileBuilder make_small_gltf(std::size_t triangles = 1) {
    GltfFileBuilder gltf;
    gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 5126);
    std::vector<std::uint16_t> corners;
    for (std::size_t i = 0; i < triangles; ++i) corners.insert(corners.end(), {0, 1, 2});
    gltf.add_accessor(corners, "SCALAR", 5123);
    gltf.root["nodes"] = {{{"name", "n"}, {"mesh", 0}}};
    gltf.root["meshes"] = {
        {{"name", "m"}, {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
    return gltf;
}

} // namespace test::loading
