#pragma once

#include "graph/plan.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace catoptric::graph {

/// An access state as a number from 1. The number 0 stands for no access.
using AccessStateCode = std::uint8_t;
constexpr AccessStateCode kNoAccessState = 0;
constexpr int kAccessStateCodeCount = 64; ///< every code of an access state is smaller

constexpr AccessStateCode encode_access_state(const AccessState& touch) {
    if (touch.nothing) return kNoAccessState;
    return static_cast<AccessStateCode>(4 * static_cast<int>(touch.use) + 2 * touch.write +
                                        touch.raster + 1);
}
constexpr AccessState make_access_state(AccessStateCode code) {
    if (code == kNoAccessState) return {};
    const int bits = code - 1;
    return {.nothing = false,
            .use = static_cast<ResourceUse>(bits / 4),
            .write = (bits & 2) != 0,
            .raster = (bits & 1) != 0};
}
constexpr ResourceUse decode_access_use(AccessStateCode code) {
    return static_cast<ResourceUse>((code - 1) / 4);
}

/// A list of at most 8 distinct accesses to a resource, in the order in which they were added.
class AccessStateList {
public:
    AccessStateList() = default;
    explicit AccessStateList(AccessStateCode touch) { add_access_state(touch); }
    bool empty() const { return count_ == 0; }
    std::size_t size() const { return count_; }
    AccessStateCode first_access_state() const { return codes_[0]; }
    AccessStateCode operator[](std::size_t i) const { return codes_[i]; }
    bool contains_access_state(AccessStateCode touch) const {
        return std::find(codes_.begin(), codes_.begin() + count_, touch) != codes_.begin() + count_;
    }
    /// Adds the access state unless the list contains it. A resource can have at most 8 kinds of
    /// reads: 4 uses, each by a raster pass or another pass.
    void add_access_state(AccessStateCode touch) {
        if (contains_access_state(touch)) return;
        assert(count_ < codes_.size());
        codes_[count_++] = touch;
    }
    void remove_all() { *this = {}; }
    friend bool operator==(const AccessStateList&, const AccessStateList&) = default;

private:
    std::array<AccessStateCode, 8> codes_{};
    std::uint8_t count_ = 0;
};

/// A set of access states: one bit for each AccessStateCode.
using AccessStateSet = std::uint64_t;
constexpr AccessStateSet access_state_set_of_code(AccessStateCode code) {
    return AccessStateSet{1} << code;
}

} // namespace catoptric::graph
