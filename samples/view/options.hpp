#pragma once

#include "catoptric/options.hpp"
#include "catoptric/technique_option.hpp"

#include <string>
#include <vector>

namespace catoptric::view {

struct ViewOptions {
    cli::CommonOptions common;
    cli::TechniqueOption drawn;
    std::string technique; ///< technique text as session::FrameSpec::techniques takes it
    std::string screenshot;
    std::string audit;        ///< file of `catoptric choose` whose plan is audited; empty: none
    int audit_every = 60;     ///< frames of a block, from which one frame is drawn for the audit
    double audit_percent = 5; ///< limit of the audits' time, in percent of the frames' time
    std::vector<std::string> words; ///< all words without the program's name
};

/// Parses `catoptric-view WORDS...` and returns the function to call, which may print help. Throws
/// `usage`, and `cannot_create` for a screenshot that cannot be written.
std::function<int()> parse_view_command(const std::vector<std::string>& words,
                                        const std::function<int(const ViewOptions&)>& run);

/// Returns the request for the scene and its first frame.
cli::ResolvedRequest resolve_view_request(const ViewOptions& options);

} // namespace catoptric::view
