#pragma once

namespace catoptric::cli {

/// From now on the first SIGHUP, SIGINT or SIGTERM lets the frame loop end after its frame. More of
/// them within a second count as one with it (`timeout` sends two); a later one ends the program at
/// once. A signal that is being ignored (nohup) stays so.
void stop_on_signals();

} // namespace catoptric::cli
