#pragma once

#include "render/captures.hpp"
#include "scene/flat_mirror.hpp"

#include <memory>
#include <string>
#include <vector>

/// How mirrors are drawn.
namespace catoptric::render {

/// A fragment shader and what it looks into.
struct MirrorShader {
    std::string fragment; ///< empty: black
    gpu::Constants constants;
    std::shared_ptr<const Captures> captures;
    /// What else it samples (nearest), by shader name: one image, or one an array of the captures.
    std::vector<std::pair<std::string, std::vector<graph::Image>>> images;
    std::vector<std::pair<std::string, graph::Buffer>> buffers; ///< what else it reads
    bool blank = false;        ///< the captures are last frame's and there was none: black
    std::uint32_t ablated = 0; ///< causes of error that its fragment#ablate takes away
};

/// A part of a mirror that has a look of its own.
struct PartShader {
    std::uint32_t mirror = 0; ///< from 0
    std::uint32_t look = 0;   ///< index into Looks::looks
    std::vector<scene::TriangleRun> triangles;
};

/// One of several looks for each mirror.
struct Looks {
    static constexpr std::uint32_t kInParts = ~0u;
    std::vector<MirrorShader> looks;
    std::vector<std::uint32_t> of_mirror; ///< index into `looks`; kInParts: as `parts` say
    std::vector<PartShader> parts;        ///< what is in none is not drawn
};

/// All mirrors alike.
Looks same_shader(const GpuScene& scene, MirrorShader look);

/// Says which of the look's resources a pass reads, each once.
void read_surroundings(graph::PassBuilder& pass, const Lighting& lighting, const Looks& looks);

} // namespace catoptric::render
