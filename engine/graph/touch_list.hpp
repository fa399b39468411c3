#pragma once

#include "graph/plan.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace catoptric::graph {

/// A touch as a number from 1; 0 stands for `nothing`.
using TouchCode = std::uint8_t;
constexpr TouchCode kNoTouch = 0;
constexpr int kTouchCodeCount = 64; ///< every code is smaller

constexpr TouchCode encode_touch(const ResourceTouch& touch) {
    if (touch.nothing) return kNoTouch;
    return static_cast<TouchCode>(4 * static_cast<int>(touch.use) + 2 * touch.write + touch.raster +
                                  1);
}
constexpr ResourceTouch make_touch(TouchCode code) {
    if (code == kNoTouch) return {};
    const int bits = code - 1;
    return {.nothing = false,
            .use = static_cast<ResourceUse>(bits / 4),
            .write = (bits & 2) != 0,
            .raster = (bits & 1) != 0};
}
constexpr ResourceUse decode_touch_use(TouchCode code) {
    return static_cast<ResourceUse>((code - 1) / 4);
}

/// A list of at most 8 distinct accesses to a resource, in the order in which they were added.
class TouchList {
public:
    TouchList() = default;
    explicit TouchList(TouchCode touch) { add(touch); }
    bool empty() const { return count_ == 0; }
    std::size_t size() const { return count_; }
    TouchCode front() const { return codes_[0]; }
    TouchCode operator[](std::size_t i) const { return codes_[i]; }
    bool contains(TouchCode touch) const {
        return std::find(codes_.begin(), codes_.begin() + count_, touch) != codes_.begin() + count_;
    }
    /// Adds the touch unless it is contained. Reads of one resource have at most 8 kinds: 4 uses,
    /// each by a raster pass or not.
    void add(TouchCode touch) {
        if (contains(touch)) return;
        assert(count_ < codes_.size());
        codes_[count_++] = touch;
    }
    void clear() { *this = {}; }
    friend bool operator==(const TouchList&, const TouchList&) = default;

private:
    std::array<TouchCode, 8> codes_{};
    std::uint8_t count_ = 0;
};

/// A set of touches without order: a bit for each code.
using TouchSet = std::uint64_t;
constexpr TouchSet touch_set_of(TouchCode code) { return TouchSet{1} << code; }

} // namespace catoptric::graph
