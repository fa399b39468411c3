#include "measure/masks.hpp"
#include "core/mirror_id.hpp"
#include "shared.h"

#include <algorithm>

namespace catoptric::measure {
namespace {

template <typename Choice>
Mask mask_where(std::span<const std::uint32_t> hits, const Choice& chosen) {
    Mask mask;
    mask.reserve(hits.size());
    for (const std::uint32_t hit : hits) mask.push_back(chosen(hit) ? 255 : 0);
    return mask;
}

} // namespace

Mask mask_all(std::span<const std::uint32_t> hits) {
    return mask_where(hits, [](std::uint32_t) { return true; });
}

Mask mask_mirrors(std::span<const std::uint32_t> hits) {
    return mask_where(hits, [](std::uint32_t hit) { return bool(first_mirror(hit)); });
}

Mask mask_first_order(std::span<const std::uint32_t> hits) {
    return mask_where(hits,
                      [](std::uint32_t hit) { return first_mirror(hit) && !second_mirror(hit); });
}

Mask mask_mirror_in_mirror(std::span<const std::uint32_t> hits) {
    return mask_where(hits,
                      [](std::uint32_t hit) { return first_mirror(hit) && second_mirror(hit); });
}

Mask mask_one_mirror(std::span<const std::uint32_t> hits, MirrorId mirror) {
    return mask_where(
        hits, [mirror](std::uint32_t hit) { return mirror && first_mirror(hit) == mirror; });
}

Mask mask_non_mirrors(std::span<const std::uint32_t> hits) {
    return mask_where(hits, [](std::uint32_t hit) { return !first_mirror(hit); });
}

Mask mask_dielectrics(std::span<const std::uint32_t> hits) {
    return mask_where(hits, [](std::uint32_t hit) {
        return !first_mirror(hit) && hit >> 16 == shared::kHitSmoothDielectric;
    });
}

Mask mask_rough(std::span<const std::uint32_t> hits) {
    return mask_where(hits, [](std::uint32_t hit) {
        return !first_mirror(hit) && hit >> 16 == shared::kHitRoughNonMirror;
    });
}

std::vector<Mask> compute_masks(std::span<const std::uint32_t> hits) {
    return {mask_mirrors(hits),     mask_first_order(hits), mask_mirror_in_mirror(hits),
            mask_non_mirrors(hits), mask_all(hits),         mask_dielectrics(hits),
            mask_rough(hits)};
}

std::size_t count_pixels(const Mask& mask) {
    return static_cast<std::size_t>(
        std::count_if(mask.begin(), mask.end(), [](std::uint8_t value) { return value != 0; }));
}

} // namespace catoptric::measure
