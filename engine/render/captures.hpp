#pragma once

#include "render/frame_inputs.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Captures of the surroundings of mirrors: what each capture holds, and the cube arrays that store
/// them.
namespace catoptric::render {

/// A cube array with 6 layers a mirror: colour and, if requested, radial distance. `colour2` and
/// `distance2` hold the next surface behind the first in the same direction, if that surface faces
/// the centre.
struct CubeCaptureArray {
    std::uint32_t face = 0; ///< edge in texels
    graph::ImageHandle colour;
    std::optional<graph::ImageHandle> distance;
    std::optional<graph::ImageHandle> colour2, distance2;
    /// Image with the number and the normal of each texel's surface (rgba16f), see
    /// shaders/lib/surface.glsl.
    std::optional<graph::ImageHandle> surfaces;
};

/// Returns a range of layers of every image that exists.
CubeCaptureArray select_layers(const CubeCaptureArray& cubes, std::uint32_t first,
                               std::uint32_t count);

/// Contents of one mirror's capture, and settings with which the capture is drawn.
struct CaptureOptions {
    std::uint32_t face = 256; ///< cube edge in texels; 0: the mirror has no capture
    TexelFormat colour = TexelFormat::rgba16f;
    std::optional<TexelFormat> distance;
    bool saturates = true;     ///< clamps half-float colour; false only to measure the cost
    bool second_layer = false; ///< needs distance: adds a pass name2/1; fragment#peel must exist
    /// Needs distance: also stores the number and normal of the visible surface.
    bool surfaces = false;
    /// Blended surfaces store their distance where their alpha is larger. A search that leaves what
    /// it does not know to rays takes 0.
    float blended_alpha = .5f;
    bool leaves_out_spheres = false; ///< mirrors that are exact spheres are not drawn
    /// The capture is drawn again at most in each N-th frame. Mirrors take turns.
    std::uint32_t every = 1;
    float stored_unit = 1; ///< scene units that a stored 1 means (unorm8: the range)
    ShadingLights lighting;
};

/// Returns whether both options give captures of the same layout and content, apart from lighting
/// and from the frame in which they are drawn.
bool have_equal_contents(const CaptureOptions& a, const CaptureOptions& b);

/// The place of a mirror's capture in the arrays.
struct CubeSlot {
    /// Indices from 0; `array` is kMaxCubeArrays if the mirror has no capture.
    std::uint32_t array = shared::kMaxCubeArrays, cube = 0;
    bool has_capture() const { return array < shared::kMaxCubeArrays; }
    bool operator==(const CubeSlot&) const = default;
};

/// The captures of all mirrors.
struct MirrorCaptures {
    std::string name;                     ///< prefix of the passes' names name/1, name/2, ...
    std::vector<CaptureOptions> options;  ///< options of each mirror's capture
    std::vector<CubeSlot> places;         ///< place of each mirror's capture
    std::vector<CubeCaptureArray> arrays; ///< 1 to shared::kMaxCubeArrays arrays
    /// Holds a shared::CaptureLookupTable; absent if mirror n is cube n of the only array.
    std::optional<graph::BufferHandle> table;
    std::vector<std::string> notes; ///< deviations from the request, one sentence each
    /// Numbers of the pictures in each face of each mirror's capture, if captures persist. Equal
    /// numbers mean equal texels if the options are equal.
    std::vector<std::array<std::uint64_t, 6>> drawings;

    /// Null if the mirror has no capture.
    const CubeCaptureArray* find_array(std::uint32_t mirror) const {
        return places[mirror].has_capture() ? &arrays[places[mirror].array] : nullptr;
    }
};

/// Declares one array for each combination of size and format, and more if the device limits the
/// layers. If that exceeds kMaxCubeArrays, enlarges the captures for which the next larger edge
/// adds the fewest texels, and says so in `notes`. `options`: by mirror; at least one mirror must
/// have a capture. `set`: if not empty, the arrays persist until they are overwritten
/// (graph::Lifetime::persistent). The name tells them from other arrays of the same
/// captures. Throws `exhausted` if kMaxCubeArrays arrays cannot hold the captures. Costs
/// O(mirrors).
MirrorCaptures declare_capture_images(graph::Graph& graph, const FrameInputs& inputs,
                                      std::string name, std::vector<CaptureOptions> options,
                                      const std::string& set = "");

/// Returns the colours and distances of these captures at the end of the frame before.
MirrorCaptures declare_previous_captures(graph::Graph& graph, const MirrorCaptures& captures);

} // namespace catoptric::render
