#pragma once

#include <cstddef>
#include <string>

namespace catoptric {

/// Throws `exhausted` where this process has no room for so many bytes more, as under `ulimit -v`:
/// libraries that are loaded without it crash, or say something else. `wanted_for` is what there is
/// "no memory for".
void check_address_space(std::size_t bytes, const std::string& wanted_for);

} // namespace catoptric
