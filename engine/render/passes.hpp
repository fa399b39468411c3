#pragma once

#include "render/capture_cache.hpp"
#include "render/mirror_shaders.hpp"
#include "require/model.hpp"

#include <memory>
#include <optional>
#include <string>

/// The passes that techniques share. Each function declares passes in a graph and returns their
/// outputs. `prefix` keeps the names of several techniques in one frame apart.
namespace catoptric::render {

/// Default number of mirror bounces of ray tracing, for the reference and for techniques that trace
/// rays for single pixels.
inline constexpr std::uint32_t kReferenceBounces = 16;

/// Declares one pass for each light, which draws the depth around it: layers [shadow_faces * l,
/// ...) of a 2D array. Returns nothing if the scene has no light. `suffix` tells several maps of a
/// frame apart. With a required model, maps persist while the shadow casters stay, and a light that
/// needs no map gets none.
std::optional<graph::ImageHandle> add_shadows(graph::Graph& graph, const FrameInputs& inputs,
                                              std::uint32_t edge,
                                              const require::WorkModel& model = {},
                                              const std::string& suffix = "");

/// Declares one pass for each light, which draws the optical depth of the glass between the light
/// and the surfaces in its shadow map (shaders/lib/glass_shadow.glsl): rgba32f, in the layers of
/// the shadow map. These passes draw in every frame, and count as no scene pass.
graph::ImageHandle add_glass_shadows(graph::Graph& graph, const FrameInputs& inputs,
                                     graph::ImageHandle shadow_map, std::uint32_t edge,
                                     const std::string& suffix = "");

/// Number of the knob value refract=backface, as in shaders/lib/refraction.glsl. Only camera views
/// have the image that it reads.
inline constexpr std::uint32_t kRefractBackface = shared::kRefractTraced + 1;
/// Declares the pass that draws the back faces of glass in the camera's view
/// (shaders/glass_back.frag). It counts as no scene pass.
graph::ImageHandle add_glass_back_pass(graph::Graph& graph, const FrameInputs& inputs);

/// Number of the knob value refract=screen, as in shaders/lib/refraction.glsl. Only camera views
/// have the picture that it reads.
inline constexpr std::uint32_t kRefractScreen = kRefractBackface + 1;
/// A copy of the camera's view as it is before glass is drawn (shaders/lib/opaque_picture.glsl).
struct OpaquePicture {
    graph::ImageHandle colour; ///< linear radiance, rgba32f
    /// Levels from 1 on of its box-filtered chain, rgba16f, for rough glass; none: no glass is
    /// rough.
    std::optional<graph::ImageHandle> levels;
};
/// Declares the images of the opaque picture. add_camera_view declares the passes that fill them.
OpaquePicture declare_opaque_picture(graph::Graph& graph, const FrameInputs& inputs,
                                     bool has_levels);

/// Declares one pass for each mirror with a capture. The pass draws all faces that need drawing. If
/// some faces stay, each run of neighbours has its own pass, and so has each face of which only a
/// part is drawn. A second layer needs a second pass. `looks`: shaders of the other mirrors; a
/// mirror is left out of its own capture.
void add_captures(graph::Graph& graph, const FrameInputs& inputs, const MirrorCaptures& captures,
                  MirrorShaders looks, const CaptureWork& work = {});

struct CameraOutputs {
    graph::ImageHandle hdr; ///< linear radiance, rgba32f
    /// Image with the direction in which each mirror pixel looked into a capture, rgba32f: see
    /// shaders/lib/mirror.glsl; 0 for other pixels.
    std::optional<graph::ImageHandle> lookup;
    /// Image that says which tracer completes each pixel: the tracer's number from 1, r32f; 0:
    /// none.
    std::optional<graph::ImageHandle> tracers;
};
/// Glass that is drawn after everything opaque, because it looks up the opaque picture.
struct GlassOverPicture {
    OpaquePicture picture;
    MirrorShaders opaque_looks; ///< of the mirrors in the picture; they do not read it
};
/// Declares the pass that draws the camera's view. `is_traced`: some shader leaves pixels to
/// tracing. In that case `lookup` and `tracers` exist. `completing_tracer`: see DrawSettings.
/// With such a tracer, `hdr` itself says which pixels are left (shaders/lib/first_hit.glsl). With
/// `glass`, further passes copy the picture, compute its levels, and draw glass and blended
/// surfaces. They count as no scene passes.
CameraOutputs add_camera_view(graph::Graph& graph, const FrameInputs& inputs,
                              const ShadingLights& lighting, MirrorShaders looks,
                              bool is_traced = false, ShadingTracer completing_tracer = {},
                              std::optional<GlassOverPicture> glass = {});

/// The images of a mirrored view. They are defined only in the view's area.
struct MirroredViewImages {
    graph::ImageHandle colour; ///< linear radiance: rgba32f, or rgba16f if there are levels
    /// Distances from the mirrored eye, r16f; infinity where no surface is.
    std::optional<graph::ImageHandle> distances;
    std::optional<graph::ImageHandle> levels; ///< box-filtered levels of `colour`, from level 1 on
};
/// The images that a mirrored view has besides its colour.
struct MirroredViewWishes {
    bool has_distances = false, has_levels = false;
};

/// Declares a pass that draws a mirrored view within its area, and a pass that computes its levels
/// if they are wanted. `number`: of the view in the scene's list of views. Leaves out everything
/// behind the mirror's plane, and the mirror `left_out`, from 0.
MirroredViewImages add_mirrored_view(graph::Graph& graph, const FrameInputs& inputs,
                                     const std::string& name, const MirroredView& view,
                                     std::uint32_t number, const ShadingLights& lighting,
                                     MirrorShaders looks, std::optional<std::uint32_t> left_out,
                                     const MirroredViewWishes& wanted);

/// Declares the pass that makes the final picture: exposure in stops, clamp and sRGB curve,
/// rgba8_unorm.
graph::ImageHandle add_compose_pass(graph::Graph& graph, const FrameInputs& inputs,
                                    graph::ImageHandle hdr, double exposure_stops);

} // namespace catoptric::render
