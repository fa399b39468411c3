#pragma once

#include "app/watcher.hpp"
#include "measure/benchmark.hpp"

#include <array>
#include <string>
#include <vector>

namespace catoptric::cli {

/// The words after "bench" of a line that ran `bench --against`, for one round of one of the two
/// programs: without what says where results go and how often, with "--json" and as many frames.
std::vector<std::string> words_for_round(const std::vector<std::string>& words, int frames);

/// Runs `PROGRAM bench WORDS...` of both in turn, there and back, so often, and returns what each
/// measured in all of its runs. Throws as output_of and report::read_benchmarks do.
std::array<measure::BenchmarkRun, 2> bench_in_turn(const std::array<std::string, 2>& programs,
                                                   const std::vector<std::string>& words,
                                                   int rounds, const app::Watcher& watcher);

} // namespace catoptric::cli
