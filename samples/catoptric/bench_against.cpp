// Benchmarks two builds of the program, one round of each in turn.
#include "bench_against.hpp"

#include "child.hpp"
#include "report/benchmarks.hpp"
#include "session/watcher.hpp"

#include <algorithm>
#include <atomic>
#include <string_view>

namespace catoptric::cli {

namespace {

struct AgainstOption {
    std::string_view name;
    bool has_value;
};
/// Options of `bench --against` that are not passed on to the rounds.
constexpr std::array kAgainstOptions{
    AgainstOption{"--against", true}, AgainstOption{"--rounds", true},
    AgainstOption{"--frames", true},  AgainstOption{"--output", true},
    AgainstOption{"-o", true},        AgainstOption{"--progress", true},
    AgainstOption{"--json", false},   AgainstOption{"--quiet", false},
    AgainstOption{"-q", false},       AgainstOption{"--verbose", false},
    AgainstOption{"-v", false}};

/// Returns how many words this option and its value take; 0 if the option is passed on.
std::size_t count_option_words(const std::string& word) {
    for (const AgainstOption& own : kAgainstOptions) {
        if (word == own.name) return own.has_value ? 2 : 1;
        const bool is_long = own.name.starts_with("--");
        // "--rounds=8", "-oFILE"
        if (own.has_value && word.starts_with(own.name) &&
            (!is_long || word[own.name.size()] == '='))
            return 1;
    }
    return 0;
}

} // namespace

std::vector<std::string> round_words(const std::vector<std::string>& words, int frames) {
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < words.size();) {
        const std::size_t taken = count_option_words(words[i]);
        if (taken == 0) kept.push_back(words[i]);
        i += std::max<std::size_t>(taken, 1);
    }
    const std::vector<std::string> more{"--json", "--quiet",  "--rounds",
                                        "1",      "--frames", std::to_string(frames)};
    kept.insert(kept.end(), more.begin(), more.end());
    return kept;
}

std::array<measure::BenchmarkRun, 2> bench_programs(const std::array<std::string, 2>& programs,
                                                    const std::vector<std::string>& words,
                                                    int rounds, const session::Watcher& watcher) {
    static const std::atomic<int> kNeverStop{0};
    std::array<measure::BenchmarkRun, 2> runs;
    for (int round = 0; round < rounds; ++round)
        for (int place = 0; place < 2; ++place) {
            const auto which = static_cast<std::size_t>(round % 2 == 0 ? place : 1 - place);
            const std::string& program = programs[which];
            report_row(
                watcher,
                program + ", round " + std::to_string(round + 1) + " of " + std::to_string(rounds),
                static_cast<std::size_t>(2 * round + place), static_cast<std::size_t>(2 * rounds));
            std::vector<std::string> command{program, "bench"};
            command.insert(command.end(), words.begin(), words.end());
            const measure::BenchmarkRun found = report::read_benchmarks(
                output_of(command, watcher.stop ? *watcher.stop : kNeverStop),
                program + ": its stdout");
            runs[which] = round == 0 ? found : join_runs(runs[which], found);
            report_frame(watcher, 1, 1);
        }
    return runs;
}

} // namespace catoptric::cli
