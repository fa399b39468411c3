#pragma once

#include <cstddef>
#include <cstdint>
#include <sys/mman.h>

namespace catoptric {

/// Asks the system for 2 MB pages in the part of the memory that can hold them. Call it before the
/// memory is written, because pages are allocated and cleared at first touch. Larger pages need
/// fewer address translations. The request is only a hint, and the function does not find out
/// whether the system follows it.
inline void advise_large_pages(void* memory, std::size_t bytes) {
    constexpr std::uintptr_t kLargePageBytes = std::uintptr_t{1} << 21;
    const auto start = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (start + kLargePageBytes - 1) & ~(kLargePageBytes - 1),
                         end = (start + bytes) & ~(kLargePageBytes - 1);
    if (first < end)
        madvise(static_cast<std::byte*>(memory) + (first - start), end - first, MADV_HUGEPAGE);
}

} // namespace catoptric
