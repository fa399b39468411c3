#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace catoptric {

/// A content hash: a 64-bit number for a sequence of values. Different sequences have different
/// hashes, except by chance.
class ContentHash {
public:
    explicit ContentHash(std::uint64_t seed = 0) { mix(seed); }

    template <typename Value>
    ContentHash& add(const Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        return add_bytes(&value, sizeof value);
    }
    template <typename Value>
    ContentHash& add_values(std::span<const Value> values) {
        add(values.size());
        return add_bytes(values.data(), values.size_bytes());
    }
    std::uint64_t sum() const { return sum_; }

private:
    ContentHash& add_bytes(const void* data, std::size_t size) {
        const auto* from = static_cast<const unsigned char*>(data);
        for (; size > 0;) {
            std::uint64_t next = 0;
            const std::size_t part = size < sizeof next ? size : sizeof next;
            std::memcpy(&next, from, part);
            mix(next);
            from += part, size -= part;
        }
        return *this;
    }
    /// Mixes a word into the running sum with SplitMix64's finaliser.
    void mix(std::uint64_t next) {
        std::uint64_t z = (sum_ ^ next) + 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        sum_ = z ^ (z >> 31);
    }

    std::uint64_t sum_ = 0;
};

} // namespace catoptric
