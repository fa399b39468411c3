#pragma once

#include <string>
#include <vector>

namespace catoptric::graph {

/// isolated: an execution barrier follows each stamp, so the times of passes add up and no two
/// passes overlap. pipelined: only the barriers that the plan needs; believe the span, not the
/// parts.
enum class Timing { isolated, pipelined };

struct PassTime {
    std::string name;
    double begin_ms = 0; ///< from the frame's first stamp
    double end_ms = 0;
    double ms() const { return end_ms - begin_ms; }
};

/// One frame on the clock. On a cpu device "gpu" time is processor time of the driver's threads.
/// The host's work is compile and record; what it waited is told apart and no part of them.
struct FrameTimes {
    std::vector<PassTime> passes; ///< in order of execution
    double span_ms = 0;           ///< first to last stamp
    double compile_ms = 0;        ///< finding or making the plan, making its images; host clock
    double record_ms = 0;         ///< filling the command buffer, host clock
    double wait_ms =
        0; ///< waiting for a place among the frames in flight, and for this frame's end
    double wall_ms = 0; ///< submit until the wait for it returned, host clock
};

} // namespace catoptric::graph
