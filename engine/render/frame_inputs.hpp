#pragma once

#include "render/gpu_scene.hpp"

#include <optional>
#include <string>

/// What all passes of a frame are declared from.
namespace catoptric::render {

struct FrameInputs {
    const GpuScene& scene;
    uvec2 size{512, 512};
    std::string prefix;        ///< of the names of passes and images
    std::uint64_t seed = 1;    ///< of stratified samples
    std::uint32_t ablated = 0; ///< causes of error to take away in the view: shared::kMend...
    bool with_lookup = false; ///< also say where mirrors looked: for measuring, costs an attachment
};

/// How captures and view are lit; no map: light without shadows.
struct Lighting {
    std::optional<graph::Image> shadow_map;
    friend bool operator==(const Lighting&, const Lighting&) = default;
};

} // namespace catoptric::render
