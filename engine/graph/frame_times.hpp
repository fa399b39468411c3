#pragma once

#include <string>
#include <vector>

namespace catoptric::graph {

/// How the passes of a frame are timed.
/// - isolated: an execution barrier follows each timestamp. No two passes overlap, and their times
/// add up.
/// - pipelined: only the barriers of the plan. Passes may overlap, and only the span is meaningful.
enum class PassTiming { isolated, pipelined };

struct GraphPassTime {
    std::string name;
    double begin_ms = 0; ///< begin of the pass, after the frame's first timestamp
    double end_ms = 0;
    double elapsed_ms() const { return end_ms - begin_ms; }
};

/// Times of one frame in milliseconds. On a cpu device the GPU times are processor time of the
/// driver's threads. compile_ms and record_ms are the host's work and do not contain wait_ms.
struct GraphFrameTimes {
    std::vector<GraphPassTime> passes; ///< passes in order of execution
    double span_ms = 0;                ///< time from the first to the last timestamp
    double compile_ms = 0; ///< host time to order passes, place barriers and make images
    double record_ms = 0;  ///< filling the command buffer, host clock
    double wait_ms =
        0; ///< waiting for a place among the frames in flight, and for this frame's end
    double wall_ms = 0; ///< host time from submit until the wait for the frame returned
};

} // namespace catoptric::graph
