#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace catoptric {

/// The number of a mirror of a scene: 1, 2, ... in the order of the file; 0: none.
class MirrorId {
public:
    constexpr MirrorId() = default;
    constexpr explicit MirrorId(std::uint32_t number) : number_(number) {}
    /// Returns the id of the mirror at `index` of a list with one entry per mirror.
    static constexpr MirrorId from_index(std::size_t index) {
        return MirrorId(static_cast<std::uint32_t>(index) + 1);
    }

    constexpr std::uint32_t number() const { return number_; }
    /// Returns the mirror's index, from 0, in a list of all mirrors. Not valid for the id 0.
    constexpr std::size_t index() const { return number_ - 1; }
    constexpr explicit operator bool() const { return number_ != 0; }
    constexpr auto operator<=>(const MirrorId&) const = default;

private:
    std::uint32_t number_ = 0;
};

} // namespace catoptric
