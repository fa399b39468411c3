#pragma once

#include "cli/program.hpp"

/// A minimal glTF scene that tests change before they write it to a file.
namespace test::loading {

using Json = nlohmann::json;

/// Returns a glTF document of one triangle whose buffer is the file `uri`.
inline Json make_triangle_gltf(const std::string& uri) {
    return {{"asset", {{"version", "2.0"}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
            {"accessors",
             {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
            {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
            {"buffers", {{{"byteLength", 36}, {"uri", uri}}}}};
}

inline std::string encode_triangle_corners() {
    const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    return {reinterpret_cast<const char*>(numbers), sizeof numbers};
}

} // namespace test::loading
