// Metrics of the processor's work for a frame, which timestamps of the device do not see.
#include "measure/metric.hpp"

namespace catoptric::measure {

namespace {

template <double HostParts::*Part>
Value part_of(const Row& row) {
    return row.host_parts.*Part;
}

const Registered kHostTime{
    {.name = "host_ms",
     .unit = "ms",
     .help = "time of the host's work for a frame, the sum of host_parts, without waiting",
     .better = Better::less,
     .order = 23,
     .columns = {{.title = "host ms", .style = Style::own_times, .order = 990}},
     .get = [](const Row& row) -> Value { return row.host_ms; }}};
const Registered kUpdate{{.name = "host_parts/update",
                          .unit = "ms",
                          .help = "median time to write moved objects and to find views and lights",
                          .better = Better::less,
                          .order = 24,
                          .get = part_of<&HostParts::update>}};
const Registered kHierarchy{{.name = "host_parts/hierarchy",
                             .unit = "ms",
                             .help = "median time to build or refit hierarchies",
                             .better = Better::less,
                             .order = 25,
                             .get = part_of<&HostParts::hierarchy>}};
const Registered kCompile{
    {.name = "host_parts/compile",
     .unit = "ms",
     .help = "median time to declare passes, and to plan them if their shape is new",
     .better = Better::less,
     .order = 26,
     .get = part_of<&HostParts::compile>}};
const Registered kRecord{{.name = "host_parts/record",
                          .unit = "ms",
                          .help = "median time to record the command buffer",
                          .better = Better::less,
                          .order = 27,
                          .get = part_of<&HostParts::record>}};
const Registered kFrameTime{
    {.name = "frame_ms",
     .unit = "ms",
     .help =
         "time of host and device for a frame, which do not overlap; ranks rows of moving scenes",
     .better = Better::less,
     .order = 28,
     .columns = {{.title = "frame ms", .style = Style::own_times, .order = 991}},
     .get = [](const Row& row) -> Value { return row.frame_ms; }}};
const Registered kMoves{
    {.name = "moves",
     .help = "whether the scene moved; rows are then ranked by frame_ms, else by gpu_ms",
     .order = 29,
     .only_where_true = true,
     .get = [](const Row& row) -> Value { return row.moves; }}};

} // namespace

} // namespace catoptric::measure
