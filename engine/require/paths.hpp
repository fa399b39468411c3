#pragma once

#include "require/model.hpp"

#include <map>
#include <vector>

/// Which mirrors the pixels of a picture show, by rays.
namespace catoptric::require {

/// Rays through a picture's pixels at most; a larger picture is looked at on a coarser grid.
inline constexpr std::size_t kMostPaths = 65536;
/// Mirrors that a path is followed through at most.
inline constexpr std::size_t kLongestPath = 8;

/// A ray from the eye through the middle of each pixel (or of each cell of a grid), followed from
/// mirror to mirror.
struct Paths {
    std::size_t count = 0; ///< of rays
    /// How many begin with these mirrors, numbers from 0 in the order in which they are met.
    std::map<std::vector<std::uint32_t>, std::size_t> through;
    std::vector<std::size_t> first;   ///< entry n-1: whose first hit is mirror n
    std::vector<std::size_t> reached; ///< entry n-1: that meet mirror n anywhere
    /// Entry n-1: whose first hit is mirror n and that go on to a place which the capture of a
    /// mirror on the way, made from the centre of its bounds, does not show.
    std::vector<std::size_t> hidden;
    /// How many rays meet these mirrors first and then a place that the capture of the last of
    /// these mirrors does not show.
    std::map<std::vector<std::uint32_t>, std::size_t> hidden_after;

    std::size_t on_mirrors() const; ///< whose first hit is a mirror
};

/// Builds a hierarchy over all triangles (bvh::build) and follows kMostPaths rays at most, in
/// floats about the eye; each reflection asks one ray more, from a capture's centre.
Paths paths_of(const Question& question);

} // namespace catoptric::require
