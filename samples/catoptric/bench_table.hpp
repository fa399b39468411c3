#pragma once

#include "measure/benchmark.hpp"

#include <string>

namespace catoptric::cli {

/// Returns the interval in `unit`, such as "[0.981 - 1.020]"; "-" if it is unknown.
std::string format_interval(const measure::Interval& interval, double unit = 1);
/// Returns the output of `bench`: a line about the device, then one line per benchmark.
std::string bench_table(const measure::BenchmarkRun& run);
/// Returns the output of `bench --compare` and `--against`.
std::string changes_table(const measure::BenchmarkChanges& changes);
/// Returns the benchmarks that are slower, such as "frame/x 1.21 [1.18 - 1.25]", separated by
/// commas; empty if none is.
std::string describe_slower(const measure::BenchmarkChanges& changes);
/// Returns the counts of work that have grown by more than a hundredth, such as "frame/x work/nodes
/// 120 instead of 100", separated by commas; empty if none has.
std::string describe_grown_work(const measure::BenchmarkChanges& changes);

} // namespace catoptric::cli
