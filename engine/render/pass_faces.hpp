#pragma once

#include "graph/graph.hpp"

#include <cstdint>
#include <string>

/// Definitions that the passes of captures and of shadow maps share.
namespace catoptric::render {

inline constexpr graph::ClearValue kClearBlack{0, 0, 0, 1};
inline constexpr graph::ClearValue kClearFarthest{0, 0, 0, 0}; ///< 0, because depth is reversed

/// A range of faces of a mirror's capture or of a light's shadow map.
struct FaceRange {
    std::uint32_t owner = 0, first = 0, count = 6;
};

/// Returns `name` for all six faces, else "NAME.FIRST-LAST".
inline std::string face_range_name(const std::string& name, const FaceRange& faces) {
    if (faces.count == 6) return name;
    return name + "." + std::to_string(faces.first + 1) + "-" +
           std::to_string(faces.first + faces.count);
}

} // namespace catoptric::render
