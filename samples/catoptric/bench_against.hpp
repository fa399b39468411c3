#pragma once

#include "measure/benchmark.hpp"
#include "session/watcher.hpp"

#include <array>
#include <string>
#include <vector>

namespace catoptric::cli {

/// Returns the command-line words for one round of one of the two programs. `words` are those after
/// "bench" of a `bench --against` line. Words about output files and repetitions are removed, and
/// "--json" and the number of frames are added.
std::vector<std::string> round_words(const std::vector<std::string>& words, int frames);

/// Runs `PROGRAM bench WORDS...` of both programs for this number of rounds, and returns the
/// measurements of each over all rounds. The order of the two alternates between rounds. Throws as
/// output_of and report::read_benchmarks do.
std::array<measure::BenchmarkRun, 2> bench_programs(const std::array<std::string, 2>& programs,
                                                    const std::vector<std::string>& words,
                                                    int rounds, const session::Watcher& watcher);

} // namespace catoptric::cli
