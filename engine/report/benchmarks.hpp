#pragma once

#include "measure/benchmark.hpp"

#include <string>

/// Writing and reading of benchmark results of `bench`.
namespace catoptric::report {

/// Returns a run in the format of Google Benchmark. `benchmarks` has one entry a round ("run_type":
/// "iteration") and one entry with the medians of each benchmark ("aggregate"). `context` names the
/// schema "catoptric/bench/1".
std::string to_json(const measure::BenchmarkRun& run);
/// Reads such a document, ours or Google Benchmark's. Rounds are the repetitions of one `run_name`.
/// Aggregates and entries that report an error are left out. Throws `bad_data` with `file`, the
/// place, the expected and the found value.
measure::BenchmarkRun read_benchmarks(const std::string& text, const std::string& file);

/// Returns a comparison as JSON, schema "catoptric/bench-compare/1".
std::string to_json(const measure::BenchmarkChanges& changes);

} // namespace catoptric::report
