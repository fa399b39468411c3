#pragma once

#include <atomic>

namespace catoptric::cli {

/// From now on the first SIGHUP, SIGINT or SIGTERM is stored in what is returned (0 before), so
/// that work can end after its frame. More of
/// them within a second count as one with it (`timeout` sends two); a later one ends the program at
/// once. A signal that is being ignored (nohup) stays so.
const std::atomic<int>& stop_on_signals();

} // namespace catoptric::cli
