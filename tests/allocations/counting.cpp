// The program's own operators new and delete have a separate source file, because a compiler that
// sees both warns about free().
#include "allocations/counting.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t taken = 0;
constexpr std::size_t kAllAllocationsAllowed = ~std::size_t{0};
std::atomic<std::size_t> granted = kAllAllocationsAllowed; // allocations left before one is refused

bool is_allocation_refused() { return granted != kAllAllocationsAllowed && granted-- == 0; }

} // namespace

std::size_t test::allocations() { return taken; }

test::ScopedAllocationRefusal::ScopedAllocationRefusal(std::size_t after) { granted = after; }
test::ScopedAllocationRefusal::~ScopedAllocationRefusal() { granted = kAllAllocationsAllowed; }

// NOLINTBEGIN(cppcoreguidelines-no-malloc): this is what malloc is for
void* operator new(std::size_t bytes) {
    ++taken;
    if (void* const memory = is_allocation_refused() ? nullptr : std::malloc(bytes ? bytes : 1))
        return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t bytes) { return operator new(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
// NOLINTEND(cppcoreguidelines-no-malloc)
