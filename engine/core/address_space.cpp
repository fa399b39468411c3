#include "core/address_space.hpp"

#include "core/error.hpp"

#include <sys/mman.h>

namespace catoptric {

void check_address_space(std::size_t bytes, const std::string& wanted_for) {
    void* const room = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    check(room != MAP_FAILED, Failure::exhausted, "no memory for ", wanted_for, ": wanted ", bytes,
          " bytes of address space; is it limited (ulimit -v)?");
    ::munmap(room, bytes);
}

} // namespace catoptric
