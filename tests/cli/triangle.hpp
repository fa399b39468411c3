#pragma once

#include "cli/program.hpp"

/// A scene file to be changed.
namespace test::loading {

using Json = nlohmann::json;

/// A triangle that lies in a file of its own.
inline Json triangle(const std::string& uri) {
    return {{"asset", {{"version", "2.0"}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
            {"accessors",
             {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
            {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
            {"buffers", {{{"byteLength", 36}, {"uri", uri}}}}};
}

inline std::string corners() {
    const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    return {reinterpret_cast<const char*>(numbers), sizeof numbers};
}

} // namespace test::loading
