// Metrics of the frames that a row rendered: their cost and their contents.
#include "measure/metric.hpp"

#include <cmath>

namespace catoptric::measure {

namespace {

double or_nothing(const std::optional<double>& value) { return value.value_or(NAN); }

Value times_of_passes(const Row& row) {
    std::vector<Parts> list;
    for (const PassFacts& pass : row.passes)
        list.push_back({"name", pass.name, {{"gpu_ms", pass.gpu_ms}}});
    return list;
}

/// Returns a count of rays, or no value if the row traces none.
template <std::uint64_t Rays::*Kind>
Value count_of(const Row& row) {
    return row.rays ? static_cast<double>((*row.rays).*Kind) : NAN;
}

const Registered kScenePasses{
    {.name = "scene_passes",
     .help = "renders of the scene per frame, a cube counted once: the seed report's R",
     .better = Better::less,
     .order = 10,
     .columns = {{"R", Style::fixed}},
     .get = [](const Row& row) -> Value { return static_cast<double>(row.scene_passes); }}};
const Registered kSceneDraws{
    {.name = "scene_draws",
     .help = "renders of the scene per frame, with every face of a cube counted",
     .better = Better::less,
     .order = 11,
     .columns = {{"Draws", Style::fixed}},
     .get = [](const Row& row) -> Value { return static_cast<double>(row.scene_draws); }}};
const Registered kGpuTime{
    {.name = "gpu_ms",
     .unit = "ms",
     .help = "time of a frame on the device, from the first to the last time stamp",
     .better = Better::less,
     .order = 20,
     .columns = {{"ms", Style::times}, {"95 %", Style::time_interval}},
     .get = [](const Row& row) -> Value { return row.gpu_ms; }}};
const Registered kRecordTime{
    {.name = "cpu_record_ms",
     .unit = "ms",
     .help = "time to record the command buffer",
     .better = Better::less,
     .order = 21,
     .columns = {{.title = "record ms", .style = Style::own_times, .order = 23}},
     .get = [](const Row& row) -> Value { return row.cpu_record_ms; }}};
const Registered kWallTime{{.name = "wall_ms",
                            .unit = "ms",
                            .help = "time from submit to fence, without recording and read-back",
                            .better = Better::less,
                            .order = 22,
                            .columns = {{"wall ms", Style::times}},
                            .get = [](const Row& row) -> Value { return row.wall_ms; }}};
const Registered kProcessorTime{
    {.name = "cpu_ms",
     .unit = "ms",
     .help = "processor time of the whole process per frame, if the device is a processor",
     .better = Better::less,
     .order = 24,
     .columns = {{.title = "cpu ms", .style = Style::times, .order = 22}},
     .get = [](const Row& row) -> Value { return row.cpu_ms; }}};
const Registered kWaited{
    {.name = "waited",
     .help =
         "share of time in which the row's threads waited for a processor that other programs used",
     .better = Better::less,
     .order = 29,
     .get = [](const Row& row) -> Value { return row.waited; }}};
const Registered kNoisy{
    {.name = "noisy",
     .help = "whether the row's threads waited for more than 5 % of the time, because of other "
             "programs; its times are then unreliable",
     .order = 29,
     .get = [](const Row& row) -> Value { return row.noisy; }}};
const Registered kPasses{{.name = "passes",
                          .unit = "ms",
                          .help = "time of each pass on the device, in order of execution",
                          .better = Better::less,
                          .order = 30,
                          .get = times_of_passes}};
const Registered kClosure{
    {.name = "closure",
     .help =
         "sum of the times of all passes, divided by wall_ms; near 1 if time stamps are correct",
     .order = 40,
     .get = [](const Row& row) -> Value { return row.closure; }}};
const Registered kMemory{
    {.name = "memory_bytes",
     .unit = "bytes",
     .help = "memory of the frame's images",
     .better = Better::less,
     .order = 210,
     .columns = {{"MiB", Style::mebibytes}},
     .get = [](const Row& row) -> Value { return static_cast<double>(row.memory_bytes); }}};
const Registered kTraced{
    {.name = "traced_fraction",
     .help = "share of the mirror pixels that were traced because the search answered unknown",
     .mask = "mirrors",
     .better = Better::less,
     .order = 220,
     .columns = {{"Traced, %", Style::percent, 2, MetricTable::lookup, 999}},
     .get = [](const Row& row) -> Value { return or_nothing(row.traced_fraction); }}};
const Registered kAutoEdge{{.name = "auto_face/edge",
                            .unit = "texels",
                            .help = "edge of captures that face=auto chose, in texels",
                            .order = 230,
                            .get = [](const Row& row) -> Value {
                                return row.auto_face ? static_cast<double>(row.auto_face->edge)
                                                     : NAN;
                            }}};
const Registered kAutoNeeds{{.name = "auto_face/needs",
                             .unit = "texels",
                             .help = "edge that each mirror alone needs, in texels; 0: not in view",
                             .order = 231,
                             .get = [](const Row& row) -> Value {
                                 return row.auto_face ? row.auto_face->needs
                                                      : std::vector<double>();
                             }}};
const Registered kPrimaryRays{{.name = "rays/primary",
                               .unit = "rays",
                               .help = "number of camera rays of a frame",
                               .order = 240,
                               .get = count_of<&Rays::primary>}};
const Registered kMirrorRays{{.name = "rays/mirror",
                              .unit = "rays",
                              .help = "number of reflected rays of a frame",
                              .order = 241,
                              .get = count_of<&Rays::mirror>}};
const Registered kShadowRays{{.name = "rays/shadow",
                              .unit = "rays",
                              .help = "number of shadow rays of a frame",
                              .order = 242,
                              .get = count_of<&Rays::shadow>}};
const Registered kSaturated{
    {.name = "saturated_texels",
     .unit = "texels",
     .help = "number of texels of half-float captures that are cut off at 65504",
     .better = Better::less,
     .order = 250,
     .get = [](const Row& row) -> Value {
         return row.saturated_texels ? static_cast<double>(*row.saturated_texels) : NAN;
     }}};

} // namespace

} // namespace catoptric::measure
