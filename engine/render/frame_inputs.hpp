#pragma once

#include "render/frame_facts.hpp"
#include "render/gpu_scene.hpp"

#include <optional>
#include <string>

/// The inputs from which all passes of a frame are declared.
namespace catoptric::render {

struct FrameInputs {
    const GpuScene& scene;
    FrameRequests& requests; ///< grows while passes are declared; passes do not read it later
    uvec2 size{512, 512};
    std::string prefix; ///< starts the names of passes and images
    /// Causes of error to remove in the camera's view: a sum of shared::kAblate...
    std::uint32_t ablated = 0;
    /// Adds an output of where mirrors looked; for measuring, costs an attachment.
    bool with_lookup = false;
    FrameFacts facts = {};
    double exposure = 0; ///< stops, of the displayed picture
};

/// The images of light probes (shaders/lib/light_probes.glsl).
struct LightProbeImages {
    graph::ImageHandle grid, light, distances;
    /// What the light probes hold: shared::kLightProbesOfSurfaces or kLightProbesOfEnvironment.
    std::uint32_t content = shared::kLightProbesOfSurfaces;
    friend bool operator==(const LightProbeImages&, const LightProbeImages&) = default;
};

/// The lighting of captures and views. Without a shadow map, light casts no shadows. Without light
/// probes, ambient light and the whole environment light all surfaces. Light probes of surfaces
/// replace both; light probes of the environment hide the part that surfaces hide.
struct ShadingLights {
    std::optional<graph::ImageHandle> shadow_map;
    std::optional<LightProbeImages> probes = {};
    /// Optical depths of glass, in the layers of the shadow map; none: glass casts no shadow.
    std::optional<graph::ImageHandle> glass_depths = {};
    /// Whether shadows of lamps are soft (shaders/lib/soft_shadow.glsl). Only set with a shadow
    /// map, in frames that asked for it (FrameRequests::draw_soft_shadows).
    bool has_soft_shadows = false;
    /// For each pixel of the camera's view, the share of the light of environment, ambient light
    /// and light probes that near surfaces let through to the pixel's surface, 0 to 1, r32f
    /// (render/ambient_occlusion.hpp); none: near surfaces hide nothing.
    std::optional<graph::ImageHandle> ambient_occlusion = {};
    friend bool operator==(const ShadingLights&, const ShadingLights&) = default;
};

} // namespace catoptric::render
