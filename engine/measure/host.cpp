// Metrics of the processor's work for a frame, which timestamps of the device do not see.
#include "measure/metric.hpp"

namespace catoptric::measure {

namespace {

template <double HostTimes::*Part>
MetricValue host_time(const Row& row) {
    return row.host_parts.*Part;
}

const RegisteredMetric kHostTimeMetric{
    {.name = "host_ms",
     .unit = "ms",
     .help = "time of the host's work for a frame, the sum of host_parts, without waiting",
     .better = BetterDirection::less,
     .order = 23,
     .columns = {{.title = "host ms", .style = ValueFormat::own_times, .order = 990}},
     .get = [](const Row& row) -> MetricValue { return row.host_ms; }}};
const RegisteredMetric kSceneUpdateTimeMetric{
    {.name = "host_parts/update",
     .unit = "ms",
     .help = "median time to write moved objects and to find views and lights",
     .better = BetterDirection::less,
     .order = 24,
     .get = host_time<&HostTimes::update>}};
const RegisteredMetric kHierarchyTimeMetric{{.name = "host_parts/hierarchy",
                                             .unit = "ms",
                                             .help = "median time to build or refit hierarchies",
                                             .better = BetterDirection::less,
                                             .order = 25,
                                             .get = host_time<&HostTimes::hierarchy>}};
const RegisteredMetric kGraphCompileTimeMetric{
    {.name = "host_parts/compile",
     .unit = "ms",
     .help = "median time to declare passes, and to plan them if their shape is new",
     .better = BetterDirection::less,
     .order = 26,
     .get = host_time<&HostTimes::compile>}};
const RegisteredMetric kRecordTimePartMetric{{.name = "host_parts/record",
                                              .unit = "ms",
                                              .help = "median time to record the command buffer",
                                              .better = BetterDirection::less,
                                              .order = 27,
                                              .get = host_time<&HostTimes::record>}};
const RegisteredMetric kFrameTimeMetric{
    {.name = "frame_ms",
     .unit = "ms",
     .help =
         "time of host and device for a frame, which do not overlap; ranks rows of moving scenes",
     .better = BetterDirection::less,
     .order = 28,
     .columns = {{.title = "frame ms", .style = ValueFormat::own_times, .order = 991}},
     .get = [](const Row& row) -> MetricValue { return row.frame_ms; }}};
const RegisteredMetric kMovedObjectsMetric{
    {.name = "moves",
     .help = "whether the scene moved; rows are then ranked by frame_ms, else by gpu_ms",
     .order = 29,
     .only_where_true = true,
     .get = [](const Row& row) -> MetricValue { return row.moves; }}};

} // namespace

} // namespace catoptric::measure
