#pragma once

#include "command_line.hpp"

#include <string>

namespace catoptric::cli {

/// The choice of techniques of a verb: one technique for all mirrors, or a plan.
struct TechniqueOption {
    std::string technique, plan;
};

/// Adds --technique and --plan. `drawn` must outlive the parsing. `otherwise` is the technique that
/// the verb takes without both; empty: it takes none.
void add_technique_options(Verb& verb, TechniqueOption& drawn, const std::string& otherwise = "");

/// Returns the technique or plan that was given, as session::FrameSpec::techniques takes it. Throws
/// `usage` if none or both were given or the text is invalid, and as reading a plan's file does
/// (session/plan_file.hpp).
std::string check_choice(const TechniqueOption& drawn, const std::string& verb);

} // namespace catoptric::cli
