#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

namespace catoptric::gpu {

/// The shader with these constants (bits by constant_id) in place, all others at their defaults,
/// and without what is then never reached. A driver inlines every call of what it is given before
/// it looks at a constant: that is a quarter of the instructions for the ray tracer of a plain
/// scene. Takes tens of milliseconds of the host. Throws `internal` for what is not SPIR-V.
std::vector<std::uint32_t> specialise(std::string_view name, std::span<const std::uint32_t> words,
                                      const std::map<std::uint32_t, std::uint32_t>& constants);

} // namespace catoptric::gpu
