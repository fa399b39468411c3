#pragma once

#include "graph/graph.hpp"
#include "require/pieces.hpp"
#include "shared.h"

#include <optional>

/// Parts of capture faces in texels.
namespace catoptric::render {

/// Returns the part of a face, enlarged to whole texels and by one more texel on each side. Drawing
/// the part's contents can change no texel outside the result.
require::FacePart grow_to_texels(const require::FacePart& part, std::uint32_t edge);
/// Returns the texels of a part from grow_to_texels; nothing for a whole face.
std::optional<graph::PixelRectangle> to_pixel_area(const require::FacePart& part,
                                                   std::uint32_t edge);

/// Returns the part of a capture face that shows a box in scene units. `view`: the view of that
/// face.
require::FacePart part_showing(const shared::View& view, int face, const Bounds<float>& box);

} // namespace catoptric::render
