#pragma once

#include "app/engine.hpp"

namespace catoptric::app {

/// Counts by a dispatch the lanes of a shader that run together, of 32 bits each.
int lanes_of(const Engine& engine);
/// Says that a software driver computes with other vectors than LP_NATIVE_VECTOR_WIDTH asks for;
/// empty where it does not, or nothing is asked for. Counts lanes where something is.
std::string width_warning(const Engine& engine);

} // namespace catoptric::app
