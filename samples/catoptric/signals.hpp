#pragma once

#include <atomic>

namespace catoptric::cli {

/// Makes SIGHUP, SIGINT and SIGTERM end the program at once. The program writes a sentence to
/// stderr after `program`, and its exit code is 128 + number. The string `program` must stay valid.
/// A signal that is already ignored (nohup) stays ignored. May be called before static objects are
/// constructed.
void exit_on_signals(const char* program);

/// After this call, the first SIGHUP, SIGINT or SIGTERM is stored and does not end the program, so
/// that work can end after its frame or a piece of it. If nothing looks at the signal for 1.5 s,
/// such as while a driver compiles a shader, the program ends at once. Returns the stored number; 0
/// before a signal. Further signals within a second count as the same one (`timeout` sends two). A
/// later one ends the program at once.
const std::atomic<int>& stop_on_signals();

/// Ends the program, as `exit_on_signals` does, this many seconds after a signal that
/// `stop_on_signals` stored, whatever the program then waits for: a driver, a compiler or the
/// display. For programs without results that must be kept.
void limit_time_after_signal(unsigned seconds);

} // namespace catoptric::cli
