#pragma once

#include "render/geometry.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

/// Finds the objects that a capture shows, before the capture is drawn.
namespace catoptric::render {

/// A ball inside a closed object. The object hides everything that the ball hides.
struct InnerBall {
    vec3 centre{0};   ///< scene units
    float radius = 0; ///< scene units; 0: no ball is known
    std::size_t object = 0;
};

/// The texels of a face, and how precisely a device places triangles on them.
struct FaceRaster {
    std::uint32_t edge = 0;          ///< texels of a face's edge
    std::uint32_t subtexel_bits = 4; ///< bits below a texel to which corners are rounded
};

/// Returns, for each object, the faces of a capture that may show it: bit k stands for faces[k].
/// An object is left out of a face only if the drawn face is certainly the same without it. Then
/// the object lies beside the face, or covers the centre of no texel, or is hidden at each covered
/// centre by one of the `balls`.
/// `faces`: perspective views from one eye, a right angle wide.
/// `wanted`: the objects that the capture draws; others get 0 and hide nothing.
/// Costs O(objects * faces) plus the texels that objects cover. Above kFaceCellsPerEdge texels an
/// edge, several texels form one cell of the search.
std::vector<std::uint8_t> find_shown_faces(std::span<const shared::View> faces,
                                           const FaceRaster& raster,
                                           std::span<const DrawRange> ranges,
                                           std::span<const InnerBall> balls,
                                           const std::function<bool(std::size_t)>& wanted);

inline constexpr std::uint32_t kFaceCellsPerEdge = 64;

} // namespace catoptric::render
