#pragma once

#include <cstddef>
#include <cstdint>
#include <sys/mman.h>

namespace catoptric {

/// Asks for pages of two megabytes where memory that nobody has written yet has room for some: each
/// page is cleared at its first touch and looked up once in a while. Only a wish: nothing tells
/// whether the system has them.
inline void advise_large_pages(void* memory, std::size_t bytes) {
    constexpr std::uintptr_t kLarge = std::uintptr_t{1} << 21;
    const auto start = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (start + kLarge - 1) & ~(kLarge - 1),
                         end = (start + bytes) & ~(kLarge - 1);
    if (first < end)
        madvise(static_cast<std::byte*>(memory) + (first - start), end - first, MADV_HUGEPAGE);
}

} // namespace catoptric
