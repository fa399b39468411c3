#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

/// Long work looks at a stop signal between pieces of counted size, and reports them. The watch
/// belongs to a thread, so that a function deep inside the work needs no argument for it.
namespace catoptric {

struct WorkWatch {
    /// Number of the signal that asks the work to stop; 0: none. Null: nobody asks.
    const std::atomic<int>* stop = nullptr;
    /// Called after each piece of a frame with the rays so far and the most rays of the frame. A
    /// frame whose rays fit into one piece has no call.
    std::function<void(std::uint64_t, std::uint64_t)> on_piece = {};
    /// Most rays of a piece; 0: as the device says (graph/frame_pieces.hpp).
    std::uint64_t most_rays = 0;
};

/// Sets the watch of this thread for the scope's life.
class WatchScope {
public:
    /// `watch`: must outlive the scope; null: nobody watches.
    explicit WatchScope(const WorkWatch* watch);
    ~WatchScope();
    WatchScope(const WatchScope&) = delete;
    WatchScope& operator=(const WatchScope&) = delete;

private:
    const WorkWatch* outer_;
};

/// Returns the watch of this thread; null: none.
const WorkWatch* current_watch();

/// Throws for this signal: `hangup` (1), `terminated` (15), else `interrupted`. 0: does nothing.
void throw_if_signalled(int signal);
/// Looks at the signal of this thread's watch.
void look_at_stop();
/// Returns whether a signal was seen: `throw_if_signalled` has thrown.
bool has_seen_signal();

} // namespace catoptric
