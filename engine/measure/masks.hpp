#pragma once

#include "core/mirror_id.hpp"
#include "measure/picture.hpp"

#include <cstdint>
#include <span>
#include <vector>

// Masks of pixels, made from the first hits of the reference's camera rays. A hit is one word a
// pixel, row-major. The low 16 bits hold the number of the mirror that was hit first, from 1, or 0
// for none. The high 16 bits hold the number of the mirror that the reflected ray meets next, or 0.
// If the low bits are 0 and the high bits are not, the first surface reflects but is no numbered
// mirror. The high bits are then shared::kHitSmoothDielectric or shared::kHitRoughNonMirror.
namespace catoptric::measure {

constexpr MirrorId first_mirror(std::uint32_t hit) { return MirrorId(hit & 0xFFFFU); }
constexpr MirrorId second_mirror(std::uint32_t hit) { return MirrorId(hit >> 16); }

/// Returns a mask of all pixels. Each mask here has one entry (0 or 255) per hit. A mask without
/// any pixel is all 0, which differs from the empty mask: that means "all pixels".
Mask mask_all(std::span<const std::uint32_t> hits);
/// Returns the pixels whose first hit is a mirror.
Mask mask_mirrors(std::span<const std::uint32_t> hits);
/// Returns the pixels whose first hit is a mirror and whose reflected ray meets no second mirror.
Mask mask_first_order(std::span<const std::uint32_t> hits);
/// Returns the pixels whose first hit is a mirror and whose reflected ray meets another mirror, or
/// the same again.
Mask mask_mirror_in_mirror(std::span<const std::uint32_t> hits);
/// Returns the pixels whose first hit is this mirror. The mask is all 0 for no mirror.
Mask mask_one_mirror(std::span<const std::uint32_t> hits, MirrorId mirror);
/// Returns the pixels whose first hit is no mirror, or that hit nothing.
Mask mask_non_mirrors(std::span<const std::uint32_t> hits);
/// Returns the pixels whose first hit reflects sharply but is no mirror: a smooth dielectric.
Mask mask_dielectrics(std::span<const std::uint32_t> hits);
/// Returns the pixels whose first hit reflects by a lobe but is no mirror: a rough dielectric, or a
/// metal too rough for a mirror.
Mask mask_rough(std::span<const std::uint32_t> hits);

/// Returns the masks of row_masks(), in the same order.
std::vector<Mask> compute_masks(std::span<const std::uint32_t> hits);

std::size_t count_pixels(const Mask& mask);

} // namespace catoptric::measure
