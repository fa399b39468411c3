#pragma once

#include "render/frame_inputs.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Captures of mirrors' surroundings: what each holds, and the cube arrays that they are kept in.
namespace catoptric::render {

/// A cube array of 6 layers a mirror: colour and, where asked for, radial distance. The second pair
/// holds, in the same directions, the next surface behind that faces the centre.
struct Cubes {
    std::uint32_t face = 0; ///< edge in texels
    graph::Image colour;
    std::optional<graph::Image> distance;
    std::optional<graph::Image> colour2, distance2;
    std::optional<graph::Image>
        surfaces; ///< rgba16f: number and normal, see shaders/lib/surface.glsl
};

/// Some layers of each image that is there.
Cubes part_of(const Cubes& cubes, std::uint32_t first, std::uint32_t count);

/// What one mirror's capture holds, and how it is made.
struct CaptureOptions {
    std::uint32_t face = 256; ///< cube edge in texels; 0: there is no capture of this mirror
    Format colour = Format::rgba16f;
    std::optional<Format> distance;
    bool saturates = true;     ///< half colour; false only to measure what that costs
    bool second_layer = false; ///< with distance: another pass, name2/1; fragment#peel exists
    bool surfaces = false;     ///< with distance: also keep which object is seen, and its normal
    bool leaves_out_spheres = false; ///< no mirror that is an exact sphere is drawn
    float stored_unit = 1;           ///< scene units of a stored 1 (unorm8: the range)
    Lighting lighting;
};

/// Whether captures of the one are captures of the other but for what they show.
bool same_contents(const CaptureOptions& a, const CaptureOptions& b);

/// Where a mirror's capture is kept.
struct CapturePlace {
    std::uint32_t array = shared::kMostArrays, cube = 0; ///< from 0; kMostArrays: nowhere
    bool exists() const { return array < shared::kMostArrays; }
    bool operator==(const CapturePlace&) const = default;
};

/// The captures of all mirrors.
struct Captures {
    std::string name;                    ///< passes are called name/1, name/2, ...
    std::vector<CaptureOptions> options; ///< of each mirror
    std::vector<CapturePlace> places;    ///< of each mirror
    std::vector<Cubes> arrays;           ///< 1 to shared::kMostArrays
    /// shared::CaptureTable; none where mirror n is cube n of the only array.
    std::optional<graph::Buffer> table;
    std::vector<std::string> notes; ///< what was done otherwise than asked for, a sentence each
    /// Of each mirror's faces, where captures are kept: with the same options the same number, the
    /// same texels.
    std::vector<std::array<std::uint64_t, 6>> drawings;

    /// That a mirror's capture is part of; null: it has none.
    const Cubes* array_of(std::uint32_t mirror) const {
        return places[mirror].exists() ? &arrays[places[mirror].array] : nullptr;
    }
};

/// Declares the arrays, one for each size and format that some mirror wants and as many more as the
/// device's limit of layers asks for. Where that makes more than kMostArrays, the edges that cost
/// least are enlarged to the next larger one, which `notes` says. `options`: of each mirror, one of
/// which at least has a capture. With a `set` the arrays stay until they are written again
/// (graph::Lifetime::persistent), and it tells them from others of the same name. Throws
/// `exhausted` where so many arrays do not hold them. O(mirrors).
Captures declare_captures(graph::Graph& graph, const FrameInputs& inputs, std::string name,
                          std::vector<CaptureOptions> options, const std::string& set = "");

/// The same as they were at the end of the frame before: colours and distances.
Captures previous(graph::Graph& graph, const Captures& captures);

} // namespace catoptric::render
