#pragma once

#include "benchmark/bench.hpp"
#include "measure/costs.hpp"
#include "session/run.hpp"

#include <string>
#include <vector>

/// Functions that measure the rows from whose times and counted work the unit costs of a device are
/// fitted.
namespace catoptric::benchmark {

using namespace session;

/// Measures each technique of the request in rounds, at the request's size and at half of it, with
/// the model `everything` and with `required`. Returns the median time of a frame, and the counted
/// work of one frame. On a processor, the time is processor time divided by the device's threads,
/// which other programs hardly change. On other devices it is the device's time. Names of samples
/// are "SCENE/WxH/MODEL/TECHNIQUE". `iterations` and `rounds` are those of each row.
std::vector<measure::TimedWork> measure_cost_samples(Engine& engine, const Request& request,
                                                     const BenchOptions& options);

/// Measures rows of the session's scene as measure_cost_samples does, and appends them to
/// `samples`. Each row has one technique.
void measure_cost_rows(Session& session, const std::vector<Request>& rows, const DeviceInfo& device,
                       const BenchOptions& options, std::vector<measure::TimedWork>& samples);

/// Counts the work of one frame of each technique of the request. The times of the samples are 0.
std::vector<measure::TimedWork> count_work_samples(Engine& engine, const Request& request,
                                                   const Watcher& watcher);

/// Returns the kinds of work whose unit costs are fitted to measured times: all kinds. The counts
/// of lanes depend on the number of lanes in a subgroup, and their costs hold only on devices with
/// subgroups of the same size.
std::vector<WorkKind> fitted_kinds();

} // namespace catoptric::benchmark
