#pragma once

#include "core/math.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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
    /// World from object, by object of the scene. Frames between which nothing moved share them.
    std::shared_ptr<const std::vector<dmat4>> transforms;
    /// Of the last frame of the sequence; none: there is none. An edit that removes or adds objects
    /// ends the sequence, so the objects are the same.
    std::optional<ShownInstant> before;
    std::shared_ptr<const std::vector<dmat4>> transforms_before;
};

} // namespace catoptric::render
