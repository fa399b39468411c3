#pragma once

namespace catoptric::cli {

/// From now on the first SIGINT or SIGTERM lets the frame loop end after its frame; the second one
/// ends the program at once. A signal that is being ignored (nohup) stays so.
void stop_on_signals();

} // namespace catoptric::cli
