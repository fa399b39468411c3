#pragma once

#include "core/mirror_id.hpp"
#include "measure/picture.hpp"

#include <cstdint>
#include <span>

// Which pixels count, from what the reference's camera rays met: one word a pixel, row-major; low
// 16 bits: number of the mirror hit first, from 1, or 0 for none; high 16 bits: number of the
// mirror that the ray reflected there meets next, or 0. Where the first is 0 and the second is not,
// the surface that was hit first reflects, but is no numbered mirror: a smooth dielectric.
namespace catoptric::measure {

constexpr MirrorId first_mirror(std::uint32_t hit) { return MirrorId(hit & 0xFFFFU); }
constexpr MirrorId second_mirror(std::uint32_t hit) { return MirrorId(hit >> 16); }

/// Every mask has one entry (0 or 255) for each hit; with nothing chosen it is all 0, which is not
/// the empty mask "every pixel".
Mask all_pixels(std::span<const std::uint32_t> hits);
/// First hit a mirror.
Mask mirrors(std::span<const std::uint32_t> hits);
/// First hit a mirror whose reflected ray meets no second one.
Mask first_order(std::span<const std::uint32_t> hits);
/// First hit a mirror whose reflected ray meets another, or the same again.
Mask mirror_in_mirror(std::span<const std::uint32_t> hits);
/// First hit is this mirror; nothing for none.
Mask of_mirror(std::span<const std::uint32_t> hits, MirrorId mirror);
/// First hit no mirror, or nothing.
Mask non_mirror(std::span<const std::uint32_t> hits);
/// First hit reflects, but is no mirror.
Mask dielectrics(std::span<const std::uint32_t> hits);

/// How many pixels of a mask count.
std::size_t pixel_count(const Mask& mask);

} // namespace catoptric::measure
