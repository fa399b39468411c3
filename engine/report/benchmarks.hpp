#pragma once

#include "measure/benchmark.hpp"

#include <string>

/// What `bench` measured and compared, written and read.
namespace catoptric::report {

/// In the shape of Google Benchmark's: `context`, and in `benchmarks` an entry a round
/// ("run_type": "iteration") and one with the medians of each benchmark ("aggregate"). Schema
/// "catoptric/bench/1" in the context.
std::string to_json(const measure::BenchmarkRun& run);
/// What such a document says, ours or Google Benchmark's: rounds are the repetitions of one
/// `run_name`; aggregates and entries that say they failed are left out. Throws `bad_data`, naming
/// `file`, the place, what was wanted and found.
measure::BenchmarkRun read_benchmarks(const std::string& text, const std::string& file);

/// Schema "catoptric/bench-compare/1".
std::string to_json(const measure::Changes& changes);

} // namespace catoptric::report
