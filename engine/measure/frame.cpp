// Metrics of the frames that a row rendered: their cost and their contents.
#include "measure/metric.hpp"

#include <cmath>

namespace catoptric::measure {

namespace {

double value_or_nan(const std::optional<double>& value) { return value.value_or(NAN); }

MetricValue list_pass_times(const Row& row) {
    std::vector<MetricParts> list;
    for (const PassFacts& pass : row.passes)
        list.push_back({"name", pass.name, {{"gpu_ms", pass.gpu_ms}}});
    return list;
}

/// Returns a count of rays, or no value if the row traces none.
template <std::uint64_t RayCounts::*Kind>
MetricValue ray_count(const Row& row) {
    return row.rays ? static_cast<double>((*row.rays).*Kind) : NAN;
}

const RegisteredMetric kScenePassesMetric{
    {.name = "scene_passes",
     .help = "renders of the scene per frame, a cube counted once: the seed report's R",
     .better = BetterDirection::less,
     .order = 10,
     .columns = {{"R", ValueFormat::fixed}},
     .get = [](const Row& row) -> MetricValue { return static_cast<double>(row.scene_passes); }}};
const RegisteredMetric kSceneDrawsMetric{
    {.name = "scene_draws",
     .help = "renders of the scene per frame, with every face of a cube counted",
     .better = BetterDirection::less,
     .order = 11,
     .columns = {{"Draws", ValueFormat::fixed}},
     .get = [](const Row& row) -> MetricValue { return static_cast<double>(row.scene_draws); }}};
const RegisteredMetric kGpuTimeMetric{
    {.name = "gpu_ms",
     .unit = "ms",
     .help = "time of a frame on the device, from the first to the last time stamp",
     .better = BetterDirection::less,
     .order = 20,
     .columns = {{"ms", ValueFormat::times}, {"95 %", ValueFormat::time_interval}},
     .get = [](const Row& row) -> MetricValue { return row.gpu_ms; }}};
const RegisteredMetric kRecordTimeMetric{
    {.name = "cpu_record_ms",
     .unit = "ms",
     .help = "time to record the command buffer",
     .better = BetterDirection::less,
     .order = 21,
     .columns = {{.title = "record ms", .style = ValueFormat::own_times, .order = 23}},
     .get = [](const Row& row) -> MetricValue { return row.cpu_record_ms; }}};
const RegisteredMetric kWallTimeMetric{
    {.name = "wall_ms",
     .unit = "ms",
     .help = "time from submit to fence, without recording and read-back",
     .better = BetterDirection::less,
     .order = 22,
     .columns = {{"wall ms", ValueFormat::times}},
     .get = [](const Row& row) -> MetricValue { return row.wall_ms; }}};
const RegisteredMetric kProcessorTimeMetric{
    {.name = "cpu_ms",
     .unit = "ms",
     .help = "processor time of the whole process per frame, if the device is a processor",
     .better = BetterDirection::less,
     .order = 24,
     .columns = {{.title = "cpu ms", .style = ValueFormat::times, .order = 22},
                 {.title = "cpu 95 %", .style = ValueFormat::time_interval, .order = 22}},
     .get = [](const Row& row) -> MetricValue { return row.cpu_ms; }}};
const RegisteredMetric kWaitedShareMetric{
    {.name = "waited",
     .help =
         "share of time in which the row's threads waited for a processor that other programs used",
     .better = BetterDirection::less,
     .order = 29,
     .get = [](const Row& row) -> MetricValue { return row.waited; }}};
const RegisteredMetric kNoisyTimesMetric{
    {.name = "noisy",
     .help = "whether the row's threads waited for more than 5 % of the time, because of other "
             "programs; its times are then unreliable",
     .order = 29,
     .get = [](const Row& row) -> MetricValue { return row.noisy; }}};
const RegisteredMetric kPassTimesMetric{
    {.name = "passes",
     .unit = "ms",
     .help = "time of each pass on the device, in order of execution",
     .better = BetterDirection::less,
     .order = 30,
     .get = list_pass_times}};
const RegisteredMetric kPassTimeSumMetric{
    {.name = "closure",
     .help =
         "sum of the times of all passes, divided by wall_ms; near 1 if time stamps are correct",
     .order = 40,
     .get = [](const Row& row) -> MetricValue { return row.closure; }}};
const RegisteredMetric kGraphMemoryMetric{
    {.name = "memory_bytes",
     .unit = "bytes",
     .help = "memory of the frame's images",
     .better = BetterDirection::less,
     .order = 210,
     .columns = {{"MiB", ValueFormat::mebibytes}},
     .get = [](const Row& row) -> MetricValue { return static_cast<double>(row.memory_bytes); }}};
const RegisteredMetric kTracedFractionMetric{
    {.name = "traced_fraction",
     .help = "share of the mirror pixels that were traced because the search answered unknown",
     .mask = kMirrorMaskName,
     .better = BetterDirection::less,
     .order = 220,
     .columns = {{"Traced, %", ValueFormat::percent, 2, TableKind::lookup, 999}},
     .get = [](const Row& row) -> MetricValue { return value_or_nan(row.traced_fraction); }}};
const RegisteredMetric kAutoFaceEdgeMetric{
    {.name = "auto_face/edge",
     .unit = "texels",
     .help = "edge of captures that face=auto chose, in texels",
     .order = 230,
     .get = [](const Row& row) -> MetricValue {
         return row.auto_face ? static_cast<double>(row.auto_face->edge) : NAN;
     }}};
const RegisteredMetric kAutoFaceNeedsMetric{
    {.name = "auto_face/needs",
     .unit = "texels",
     .help = "edge that each mirror alone needs, in texels; 0: not in view",
     .order = 231,
     .get = [](const Row& row) -> MetricValue {
         return row.auto_face ? row.auto_face->needs : std::vector<double>();
     }}};
const RegisteredMetric kPrimaryRaysMetric{{.name = "rays/primary",
                                           .unit = "rays",
                                           .help = "number of camera rays of a frame",
                                           .order = 240,
                                           .get = ray_count<&RayCounts::primary>}};
const RegisteredMetric kMirrorRaysMetric{{.name = "rays/mirror",
                                          .unit = "rays",
                                          .help = "number of reflected rays of a frame",
                                          .order = 241,
                                          .get = ray_count<&RayCounts::mirror>}};
const RegisteredMetric kShadowRaysMetric{{.name = "rays/shadow",
                                          .unit = "rays",
                                          .help = "number of shadow rays of a frame",
                                          .order = 242,
                                          .get = ray_count<&RayCounts::shadow>}};
const RegisteredMetric kSaturatedTexelsMetric{
    {.name = "saturated_texels",
     .unit = "texels",
     .help = "number of texels of half-float captures that are cut off at 65504",
     .better = BetterDirection::less,
     .order = 250,
     .get = [](const Row& row) -> MetricValue {
         return row.saturated_texels ? static_cast<double>(*row.saturated_texels) : NAN;
     }}};

} // namespace

} // namespace catoptric::measure
