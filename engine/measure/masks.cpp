#include "measure/masks.hpp"
#include "core/mirror_id.hpp"
#include "shared.h"

#include <algorithm>

namespace catoptric::measure {
namespace {

template <typename Choice>
Mask mask_pixels_where(std::span<const std::uint32_t> hits, const Choice& chosen) {
    Mask mask;
    mask.reserve(hits.size());
    for (const std::uint32_t hit : hits) mask.push_back(chosen(hit) ? 255 : 0);
    return mask;
}

} // namespace

Mask mask_all_pixels(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits, [](std::uint32_t) { return true; });
}

Mask mask_mirror_pixels(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits,
                             [](std::uint32_t hit) { return bool(first_mirror_of_hit_word(hit)); });
}

Mask mask_first_order_pixels(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits, [](std::uint32_t hit) {
        return first_mirror_of_hit_word(hit) && !second_mirror_of_hit_word(hit);
    });
}

Mask mask_mirror_in_mirror(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits, [](std::uint32_t hit) {
        return first_mirror_of_hit_word(hit) && second_mirror_of_hit_word(hit);
    });
}

Mask mask_one_mirror(std::span<const std::uint32_t> hits, MirrorId mirror) {
    return mask_pixels_where(hits, [mirror](std::uint32_t hit) {
        return mirror && first_mirror_of_hit_word(hit) == mirror;
    });
}

Mask mask_non_mirror_pixels(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits,
                             [](std::uint32_t hit) { return !first_mirror_of_hit_word(hit); });
}

Mask mask_smooth_dielectrics(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits, [](std::uint32_t hit) {
        return !first_mirror_of_hit_word(hit) && hit >> 16 == shared::kHitSmoothDielectric;
    });
}

Mask mask_rough_surfaces(std::span<const std::uint32_t> hits) {
    return mask_pixels_where(hits, [](std::uint32_t hit) {
        return !first_mirror_of_hit_word(hit) && hit >> 16 == shared::kHitRoughNonMirror;
    });
}

std::vector<Mask> compute_row_masks(std::span<const std::uint32_t> hits) {
    return {mask_mirror_pixels(hits),    mask_first_order_pixels(hits),
            mask_mirror_in_mirror(hits), mask_non_mirror_pixels(hits),
            mask_all_pixels(hits),       mask_smooth_dielectrics(hits),
            mask_rough_surfaces(hits)};
}

std::size_t count_mask_pixels(const Mask& mask) {
    return static_cast<std::size_t>(
        std::count_if(mask.begin(), mask.end(), [](std::uint8_t value) { return value != 0; }));
}

} // namespace catoptric::measure
