#pragma once

#include "render/capture_cache.hpp"
#include "render/mirror_shaders.hpp"

#include <memory>
#include <optional>
#include <string>

/// The passes that techniques share. Each declares passes in a graph and returns what they make; a
/// `prefix` keeps the names of several techniques in one frame apart.
namespace catoptric::render {

/// Mirror bounces of the reference, and of whatever stands in for it.
inline constexpr std::uint32_t kReferenceDepth = 16;

/// Depth around every light, one pass a light: layers [shadow_faces * l, ...) of a 2D array.
/// Nothing when the scene has no light. `suffix` tells maps of one frame apart. Unless the model is
/// everything, maps stay while what casts shadows does, and none is drawn of a light that needs
/// none.
std::optional<graph::Image> add_shadow(graph::Graph& graph, const FrameInputs& inputs,
                                       std::uint32_t edge, const require::Model& model = {},
                                       const std::string& suffix = "");

/// One pass a mirror that has a capture, all faces that are drawn at once (neighbours, where some
/// are not; each by itself of which only a part is); two with a second layer. `looks`: of the other
/// mirrors; mirror n is left out of its own capture.
void add_captures(graph::Graph& graph, const FrameInputs& inputs, const Captures& captures,
                  Looks looks, const CaptureWork& work = {});

/// The camera's picture.
struct View {
    graph::Image hdr; ///< linear radiance, rgba32f
    std::optional<graph::Image>
        lookup; ///< rgba32f, where each mirror pixel looked: see shaders/lib/mirror.glsl; else 0
    std::optional<graph::Image>
        tracers; ///< r32f: the number, from 1, of the tracing that takes over; 0: none
};
/// `is_traced`: some look leaves pixels to tracing. Then there are `lookup` and `tracers`.
View add_view(graph::Graph& graph, const FrameInputs& inputs, const Lighting& lighting, Looks looks,
              bool is_traced = false);

/// What the scene's view numbered `number`, which is `view`, shows in its area: linear radiance,
/// rgba32f, defined there alone. What lies behind the mirror's plane is not drawn, nor is the
/// mirror `left_out`, from 0.
graph::Image add_mirrored_view(graph::Graph& graph, const FrameInputs& inputs,
                               const std::string& name, const MirroredView& view,
                               std::uint32_t number, const Lighting& lighting, Looks looks,
                               std::optional<std::uint32_t> left_out);

/// Exposure in stops, clamp, sRGB curve: rgba8_unorm.
graph::Image add_compose(graph::Graph& graph, const FrameInputs& inputs, graph::Image hdr,
                         double exposure_stops);

} // namespace catoptric::render
