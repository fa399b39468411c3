#pragma once

#include <atomic>

namespace catoptric::cli {

/// From now on SIGHUP, SIGINT and SIGTERM end the program at once, with a sentence on stderr after
/// `program` (which must live on) and exit code 128 + number. A signal that is being ignored
/// (nohup) stays so. Needs nothing that is made before main.
void answer_signals(const char* program);

/// From now on the first of these signals is stored in what is returned (0 before), so that work
/// can end after its frame. More of them within a second count as one with it (`timeout` sends
/// two); a later one ends the program at once.
const std::atomic<int>& stop_on_signals();

} // namespace catoptric::cli
