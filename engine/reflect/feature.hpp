#pragma once

#include "reflect/frame.hpp"
#include "reflect/rough.hpp"
#include "render/light_probes.hpp"

#include <map>
#include <optional>
#include <string_view>
#include <vector>

/// The table of features: what one frame may contain. add_frame_passes walks the table. A feature
/// is one row of data and functions. Its .cpp file registers the row, and no other file lists it.
namespace catoptric::reflect {

/// The shadow map that a pass reads, and how.
struct ShadowMapRequest {
    std::optional<std::uint32_t> edge; ///< texels; none: the pass needs no shadow map
    bool is_soft = false;              ///< whether lamps cast soft shadows
};

/// A frame while its passes are declared. Features read what earlier features put here. It holds
/// handles and settings; what only one feature needs stays in that feature's file.
struct FrameDeclaration {
    FrameDeclaration(graph::Graph& of, const render::FrameInputs& given,
                     const Assignment& of_mirrors, const CaptureHistory& continued)
        : graph(of), inputs(given), assignment(of_mirrors), history(continued) {}

    graph::Graph& graph;
    const render::FrameInputs& inputs;
    const Assignment& assignment;
    const CaptureHistory& history;

    const std::vector<TechniqueChoice>& choices() const { return assignment.choices; }
    bool is_mixed() const { return choices().size() > 1; }
    /// Returns the captures from which the frame continues, and the work that it may leave out.
    /// With light probes, light goes from every surface to every other one, so nothing is left out.
    const CaptureHistory& continued_history() const;
    /// Returns lighting with a shadow map that many passes may share.
    render::ShadingLights light_with(const ShadowMapRequest& wanted);

    std::optional<render::LightProbes> probes;
    /// Whether the ray tracer draws all parts of the view that the rasteriser cannot finish
    /// (Technique::completes_view).
    bool completes_view = false;
    /// Whether a technique declares the whole picture, so that no view is rasterised.
    bool is_traced_whole = false;
    render::ShadingLights lighting;                ///< of captures and mirrored views
    render::ShadingLights view_lighting;           ///< of the camera's view
    std::optional<render::CaptureUpdate> captures; ///< none: no technique needs captures
    std::optional<RoughLevels> levels;             ///< of `captures`
    render::MirrorShaders captured_looks;          ///< shaders of mirrors in `captures`
    std::optional<render::OpaquePicture> opaque;   ///< the picture without glass; none: unused
    render::MirrorShaders looks;                   ///< shaders of mirrors in the camera's view
    std::vector<TracerSettings> tracers;           ///< of the pixels that `looks` leave to rays
    std::optional<render::CameraOutputs> view;     ///< the rasterised view
    TechniqueOutputs outputs;

private:
    std::map<std::uint32_t, render::ShadingLights> shadow_maps_; ///< by edge in texels
    render::ShadingLights shadow_map(std::uint32_t edge);
};

/// Orders of the features that every frame may have. A feature between two of them takes a number
/// between theirs.
namespace feature_order {
inline constexpr int kLightProbes = 100, kShadowMaps = 200, kTracedPicture = 300, kOcclusion = 400,
                     kCaptures = 500, kLightProbeCaptures = 600, kCapturePasses = 700,
                     kFilters = 800, kOpaquePicture = 900, kMirrors = 1000, kMirroredViews = 1100,
                     kCameraView = 1200, kTracers = 1300, kCompose = 1400;
}

/// One thing that a frame may contain.
struct FrameFeature {
    std::string_view name;
    int order = 0;
    bool (*applies)(const FrameDeclaration& frame) = nullptr;
    /// Declares passes, and puts their handles into the frame. Called if `applies`.
    void (*add)(FrameDeclaration& frame) = nullptr;
};

/// Adds a feature to the table when the program starts, as an object of namespace scope.
struct RegisteredFeature {
    explicit RegisteredFeature(const FrameFeature& feature);
};

/// Returns all features, sorted by `order`.
std::vector<const FrameFeature*> features();

/// Returns the shadow map that a technique's captures and mirrors ask for.
ShadowMapRequest choose_shadow_map(const ShadowKnobs& knobs);

/// Returns whether the frame rasterises the camera's view.
inline bool is_rasterised(const FrameDeclaration& frame) { return !frame.is_traced_whole; }

} // namespace catoptric::reflect
