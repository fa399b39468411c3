#pragma once

#include "measure/benchmark.hpp"

#include <string>

namespace catoptric::cli {

/// "[0.981 - 1.020]", in `unit`; "-" where it is not known.
std::string interval_text(const measure::Interval& interval, double unit = 1);
/// What bench prints: a line about where it was measured, then one a benchmark.
std::string bench_table(const measure::BenchmarkRun& run);
/// What `bench --compare` and `--against` print.
std::string changes_table(const measure::Changes& changes);
/// "frame/x 1.21 [1.18 - 1.25]" of each that is slower, separated by commas; empty: none is.
std::string slower_text(const measure::Changes& changes);

} // namespace catoptric::cli
