#pragma once

#include "session/engine.hpp"

namespace catoptric::session {

/// Returns how many 32-bit lanes of a shader run together. Counts them by a dispatch.
int count_lanes(const Engine& engine);
/// Returns a warning if a software driver uses another vector width than LP_NATIVE_VECTOR_WIDTH
/// asks for. Returns an empty text if the widths agree or the variable asks for none. Counts lanes
/// if the variable asks for a width.
std::string vector_width_warning(const Engine& engine);

} // namespace catoptric::session
