#pragma once

#include "core/work.hpp"
#include "session/run.hpp"

#include <vector>

namespace catoptric::session {

/// Returns the work of the request's first measured frame, pass by pass, in order of execution.
/// Begins with a cut, renders the warm-up, and then one frame that counts its work. The session
/// must show the request's scene. Counts repeat to the last digit on the same device and driver.
/// Throws as Session::frame does.
std::vector<PassWork> count_frame_work(Session& session, const Request& request,
                                       const Watcher& watcher = {});

} // namespace catoptric::session
