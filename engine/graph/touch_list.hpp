#pragma once

#include "graph/plan.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace catoptric::graph {

/// An access state as a number from 1. The number 0 stands for no access.
using AccessCode = std::uint8_t;
constexpr AccessCode kNoAccess = 0;
constexpr int kAccessCodeCount = 64; ///< every code of an access state is smaller

constexpr AccessCode encode_access(const AccessState& touch) {
    if (touch.nothing) return kNoAccess;
    return static_cast<AccessCode>(4 * static_cast<int>(touch.use) + 2 * touch.write +
                                   touch.raster + 1);
}
constexpr AccessState access_state(AccessCode code) {
    if (code == kNoAccess) return {};
    const int bits = code - 1;
    return {.nothing = false,
            .use = static_cast<ResourceUse>(bits / 4),
            .write = (bits & 2) != 0,
            .raster = (bits & 1) != 0};
}
constexpr ResourceUse decode_use(AccessCode code) {
    return static_cast<ResourceUse>((code - 1) / 4);
}

/// A list of at most 8 distinct accesses to a resource, in the order in which they were added.
class AccessList {
public:
    AccessList() = default;
    explicit AccessList(AccessCode touch) { add(touch); }
    bool empty() const { return count_ == 0; }
    std::size_t size() const { return count_; }
    AccessCode first() const { return codes_[0]; }
    AccessCode operator[](std::size_t i) const { return codes_[i]; }
    bool contains(AccessCode touch) const {
        return std::find(codes_.begin(), codes_.begin() + count_, touch) != codes_.begin() + count_;
    }
    /// Adds the access state unless the list contains it. A resource can have at most 8 kinds of
    /// reads: 4 uses, each by a raster pass or another pass.
    void add(AccessCode touch) {
        if (contains(touch)) return;
        assert(count_ < codes_.size());
        codes_[count_++] = touch;
    }
    void remove_all() { *this = {}; }
    friend bool operator==(const AccessList&, const AccessList&) = default;

private:
    std::array<AccessCode, 8> codes_{};
    std::uint8_t count_ = 0;
};

/// A set of access states: one bit for each AccessCode.
using AccessSet = std::uint64_t;
constexpr AccessSet to_access_set(AccessCode code) { return AccessSet{1} << code; }

} // namespace catoptric::graph
