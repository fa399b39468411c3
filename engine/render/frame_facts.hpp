#pragma once

#include "core/math.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <optional>

namespace catoptric::render {

/// What a frame shows of the scene. Equal values show the same.
struct ShownInstant {
    double time = 0;      ///< seconds into the scene's motion
    scene::Camera camera; ///< at this instant
    uvec2 size{0, 0};
    double ambient = 0;
    bool operator==(const ShownInstant&) const = default;
};

/// What a frame knows before it starts.
struct FrameFacts {
    std::uint64_t number = 1; ///< in its sequence, from 1 after a cut
    std::uint64_t seed = 1;   ///< seed of sample patterns
    ShownInstant now;
    std::optional<ShownInstant> before; ///< of the last frame of the sequence; none: there is none
};

} // namespace catoptric::render
