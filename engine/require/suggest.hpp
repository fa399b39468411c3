#pragma once

#include "require/model.hpp"

#include <string>
#include <vector>

/// Which technique suits which mirror of a picture.
namespace catoptric::require {

/// What may be no larger in the picture, pixels, is looked up in the cheapest way, in a capture of
/// this edge.
inline constexpr double kFewPixels = 256;
inline constexpr std::uint32_t kSmallFace = 64;
/// What stands higher in front of a triangle's plane than this part of its mirror's extent faces
/// it.
inline constexpr double kFacing = 1e-3;
/// Of triangles with vertices; what has more is taken to face itself.
inline constexpr std::size_t kMostFacings = std::size_t{1} << 26;

struct Suggestion {
    std::string plan;                 ///< "1=planar 2-3 ..." as reflect::parse_plan reads it
    std::vector<std::string> reasons; ///< entry n-1 of mirror n: "planar: it is flat ..."
};

/// By shape and by size in this picture: what is seen in other mirrors alone, or is small there:
/// `reuse` with small faces; flat (scene::flat_tolerance): `planar`; a true sphere: `secant`;
/// anything else `hybrid`, which asks
/// no captures but its own where some mirror is not seen. O(n log n) in the mirrors' triangles,
/// kMostFacings for one that is neither.
Suggestion suggest(const Question& question);

} // namespace catoptric::require
