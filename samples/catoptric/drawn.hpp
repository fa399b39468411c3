#pragma once

#include "command_line.hpp"

#include <string>

namespace catoptric::cli {

/// What a verb renders with: one technique for all mirrors, or a plan.
struct Drawn {
    std::string technique, plan;
};

/// Adds --technique and --plan. `drawn` must outlive the parsing.
void add_drawn(Verb& verb, Drawn& drawn);

/// The one that was given, as app::FrameSpec::techniques takes it. Throws `usage` for none, for
/// both and for what cannot be read, and as a plan's file does (app/plan_file.hpp).
std::string checked(const Drawn& drawn, const std::string& verb);

} // namespace catoptric::cli
