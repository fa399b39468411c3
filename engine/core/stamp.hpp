#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace catoptric {

/// 64-bit FNV-1a of values without padding: what is made from equal values has equal stamps.
class Stamp {
public:
    template <typename Value>
    Stamp& add(const Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        std::array<unsigned char, sizeof(Value)> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        for (const unsigned char byte : bytes) sum_ = (sum_ ^ byte) * 0x100000001b3;
        return *this;
    }
    std::uint64_t value() const { return sum_; }

private:
    std::uint64_t sum_ = 0xcbf29ce484222325;
};

} // namespace catoptric
