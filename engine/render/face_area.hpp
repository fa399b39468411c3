#pragma once

#include "graph/graph.hpp"
#include "require/pieces.hpp"
#include "shared.h"

#include <optional>

/// Parts of a capture's faces in texels.
namespace catoptric::render {

/// The part grown to whole texels of a face of `edge`, and by one more: where a drawing of what it
/// holds may change texels.
require::FacePart in_texels(const require::FacePart& part, std::uint32_t edge);
/// The texels of such a part; nothing: all.
std::optional<graph::Area> area_of(const require::FacePart& part, std::uint32_t edge);

/// What a face of a capture, whose view this is, shows of a box in scene units.
require::FacePart part_with(const shared::View& view, int face, const Bounds<float>& box);

} // namespace catoptric::render
