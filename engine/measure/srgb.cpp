#include "measure/srgb.hpp"

#include <bit>
#include <cstdint>

namespace catoptric::measure {
namespace {

int srgb_code(double linear) {
    return static_cast<int>(std::lround(srgb_from_linear(linear) * 255));
}

/// Returns the least value in [0,1] with this code. Bisects the bits: the curve is increasing, and
/// the bits of positive numbers are ordered as the numbers are.
double least_linear(int code) {
    std::uint64_t below = 0, there = std::bit_cast<std::uint64_t>(1.0);
    while (there - below > 1) {
        const std::uint64_t middle = below + (there - below) / 2;
        (srgb_code(std::bit_cast<double>(middle)) < code ? below : there) = middle;
    }
    return std::bit_cast<double>(there);
}

} // namespace

SrgbDecodeTable::CodeTable::CodeTable() {
    for (std::size_t code = 0; code < srgb.size(); ++code) {
        srgb[code] = static_cast<float>(static_cast<double>(code) / 255);
        linear[code] = linear_from_srgb(static_cast<double>(srgb[code]));
    }
}
const SrgbDecodeTable::CodeTable SrgbDecodeTable::kStored;

SrgbEncoder::SrgbEncoder() {
    for (std::size_t code = 1; code <= 255; ++code)
        least_[code] = least_linear(static_cast<int>(code));
    least_.back() = 2;
    std::size_t code = 0;
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
        const auto bits = static_cast<std::uint32_t>(i << kDroppedBits);
        const auto value = static_cast<double>(std::bit_cast<float>(bits));
        while (value >= least_[code + 1]) ++code;
        guesses_[i] = static_cast<std::uint8_t>(code);
    }
    for (std::size_t i = 0; i < values_.size(); ++i)
        values_[i] = static_cast<float>(static_cast<double>(i) / 255);
}

const SrgbEncoder& SrgbEncoder::instance() {
    static const SrgbEncoder kCurve;
    return kCurve;
}

} // namespace catoptric::measure
