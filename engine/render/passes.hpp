#pragma once

#include "core/knob.hpp"
#include "render/gpu_scene.hpp"

#include <optional>
#include <string>

/// The passes that techniques share. Each declares passes in a graph and returns what they make; a
/// `prefix` keeps the names of several techniques in one frame apart.
namespace catoptric::render {

/// Mirror bounces of the reference, and of whatever stands in for it.
inline constexpr std::uint32_t kReferenceDepth = 16;

struct FrameInputs {
    const GpuScene& scene;
    uvec2 size{512, 512};
    std::string prefix;
    std::uint64_t seed = 1;   ///< of stratified samples
    std::uint32_t mended = 0; ///< causes of error to take away in the view: shared::kMend...
    bool with_lookup = false; ///< also say where mirrors looked: for measuring, costs an attachment
};

/// Depth around every light, one pass a light: layers [shadow_faces * l, ...) of a 2D array.
/// Nothing when the scene has no light.
std::optional<graph::Image> add_shadow(graph::Graph& graph, const FrameInputs& inputs,
                                       std::uint32_t edge);

/// Colour and, where asked for, radial distance: cube arrays of 6 layers a mirror. The second
/// pair holds, in the same directions, the next surface behind that faces the centre.
struct Cubes {
    graph::Image colour;
    std::optional<graph::Image> distance;
    std::optional<graph::Image> colour2, distance2;
    std::optional<graph::Image>
        surfaces; ///< rgba16f: number and normal, see shaders/lib/surface.glsl
};

/// How a mirror is drawn: a fragment shader and the cubes that it looks into. Without cubes: black.
struct MirrorLook {
    std::string fragment = "mirror_black.frag";
    gpu::Constants constants;
    std::optional<Cubes> cubes;
    std::vector<std::pair<std::string, graph::Image>>
        images; ///< what else it samples (nearest), by shader name
    std::vector<std::pair<std::string, graph::Buffer>> buffers; ///< what else it reads
    bool blank = false;       ///< the cubes are last frame's and there was none: black
    std::uint32_t mended = 0; ///< causes of error that its fragment#mend takes away
};

/// How captures and view are lit; no map: light without shadows.
struct Lighting {
    std::optional<graph::Image> shadow_map;
};

/// What a capture holds beside colour.
struct CaptureOptions {
    std::string name = "capture"; ///< passes are called name/1, name/2, ...
    std::uint32_t face = 256;     ///< cube edge in texels
    Format colour = Format::rgba16f;
    std::optional<Format> distance;
    bool saturates = true;     ///< half colour; false only to measure what that costs
    bool second_layer = false; ///< with distance: another pass a mirror, name2/1, name2/2, ...;
                               ///< fragment#peel exists
    bool surfaces = false;     ///< with distance: also keep which object is seen, and its normal
    bool leaves_out_spheres = false; ///< no mirror that is an exact sphere is drawn
    float stored_unit = 1;           ///< scene units of a stored 1 (unorm8: the range)
    Lighting lighting;
    MirrorLook look; ///< of the other mirrors; mirror n is left out of its own capture
};

/// Declares the cubes; what a row's `previous` needs before the captures exist.
Cubes declare_cubes(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options);
/// One pass a mirror, six faces at once; two with a second layer.
void add_captures(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
                  const Cubes& cubes);

/// The camera's picture.
struct View {
    graph::Image hdr; ///< linear radiance, rgba32f
    std::optional<graph::Image>
        lookup; ///< rgba32f, where each mirror pixel looked: see shaders/lib/mirror.glsl; else 0
};
View add_view(graph::Graph& graph, const FrameInputs& inputs, const Lighting& lighting,
              const MirrorLook& look, bool with_lookup = false);

/// Exposure in stops, clamp, sRGB curve: rgba8_unorm.
graph::Image add_compose(graph::Graph& graph, const FrameInputs& inputs, graph::Image hdr,
                         double exposure_stops);

} // namespace catoptric::render
