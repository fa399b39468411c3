#include "measure/masks.hpp"
#include "core/mirror_id.hpp"

#include <algorithm>

namespace catoptric::measure {
namespace {

template <typename Choice>
Mask where(std::span<const std::uint32_t> hits, const Choice& chosen) {
    Mask mask;
    mask.reserve(hits.size());
    for (const std::uint32_t hit : hits) mask.push_back(chosen(hit) ? 255 : 0);
    return mask;
}

} // namespace

Mask all_pixels(std::span<const std::uint32_t> hits) {
    return where(hits, [](std::uint32_t) { return true; });
}

Mask mirrors(std::span<const std::uint32_t> hits) {
    return where(hits, [](std::uint32_t hit) { return bool(first_mirror(hit)); });
}

Mask first_order(std::span<const std::uint32_t> hits) {
    return where(hits, [](std::uint32_t hit) { return first_mirror(hit) && !second_mirror(hit); });
}

Mask mirror_in_mirror(std::span<const std::uint32_t> hits) {
    return where(hits, [](std::uint32_t hit) { return first_mirror(hit) && second_mirror(hit); });
}

Mask of_mirror(std::span<const std::uint32_t> hits, MirrorId mirror) {
    return where(hits,
                 [mirror](std::uint32_t hit) { return mirror && first_mirror(hit) == mirror; });
}

Mask non_mirror(std::span<const std::uint32_t> hits) {
    return where(hits, [](std::uint32_t hit) { return !first_mirror(hit); });
}

Mask dielectrics(std::span<const std::uint32_t> hits) {
    return where(hits, [](std::uint32_t hit) { return !first_mirror(hit) && second_mirror(hit); });
}

std::size_t pixel_count(const Mask& mask) {
    return static_cast<std::size_t>(
        std::count_if(mask.begin(), mask.end(), [](std::uint8_t value) { return value != 0; }));
}

} // namespace catoptric::measure
