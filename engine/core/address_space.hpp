#pragma once

#include <cstddef>
#include <string>

namespace catoptric {

/// Throws `exhausted` if the process cannot map `bytes` more, as under `ulimit -v`. Libraries that
/// are loaded without enough address space crash or report another cause. `wanted_for` completes
/// the message "no memory for".
void check_address_space(std::size_t bytes, const std::string& wanted_for);

} // namespace catoptric
