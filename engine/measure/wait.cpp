// Metric of the time that the host waits for the device, which is work of neither.
#include "measure/metric.hpp"

namespace catoptric::measure {

namespace {

const RegisteredMetric kDeviceWaitTimeMetric{
    {.name = "wait_ms",
     .unit = "ms",
     .help = "time that the host waited for the device; no other time includes it",
     .better = BetterDirection::less,
     .order = 28,
     .columns = {{.title = "wait ms", .style = ValueFormat::own_times, .order = 992}},
     .get = [](const Row& row) -> MetricValue { return row.wait_ms; }}};

} // namespace

} // namespace catoptric::measure
