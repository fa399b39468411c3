#pragma once

#include "session/session.hpp"

#include <string>

namespace catoptric::session {

/// Returns a sentence that says how old captured content can be: "captures: at most 3 of 16 mirrors
/// a frame; ...".
std::string describe_budget(const CaptureBudget& capture_budget);

} // namespace catoptric::session
