// Reads benchmarks from JSON, which other programs may have written.
#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "report/benchmarks.hpp"
#include "report/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::report {

namespace {

using measure::Benchmark;
using measure::BenchmarkRound;
using measure::BenchmarkRun;

/// One entry of the list and its place in the document.
struct Entry {
    const Json& json;
    std::string place;

    Json at(const char* member) const { return json.value(member, Json()); }
    std::string text(const char* member) const {
        const Json value = at(member);
        check(value.is_string(), Failure::bad_data, place, ".", member, ": wanted text, found ",
              shown(value));
        return value.get<std::string>();
    }
    /// Returns a member that must be a finite number of at least 0.
    double measured(const char* member) const {
        const Json value = at(member);
        const double found = value.is_number() ? value.get<double>() : NAN;
        check(std::isfinite(found) && found >= 0, Failure::bad_data, place, ".", member,
              ": wanted a number of at least 0, found ", shown(value));
        return found;
    }
    std::optional<double> counted(const char* member) const {
        return json.contains(member) ? std::optional(measured(member)) : std::nullopt;
    }
    double milliseconds_a_unit() const {
        constexpr std::array<std::pair<const char*, double>, 4> kUnits{
            {{"ns", 1e-6}, {"us", 1e-3}, {"ms", 1}, {"s", 1e3}}};
        const std::string unit = text("time_unit");
        for (const auto& [name, ms] : kUnits)
            if (unit == name) return ms;
        fail(Failure::bad_data, place, ".time_unit: wanted ns, us, ms or s, found ",
             in_quotes(unit));
    }
    /// Returns whether the entry is a round: it is no aggregate and reports no error.
    bool is_round() const {
        const Json type = at("run_type"), failed = at("error_occurred");
        return (!type.is_string() || type == "iteration") && failed != true;
    }
};

constexpr std::array kKnown{"family_index", "per_family_instance_index",
                            "repetitions",  "repetition_index",
                            "threads",      "iterations",
                            "real_time",    "cpu_time",
                            "cycles",       "instructions"};

BenchmarkRound round_of(const Entry& entry) {
    const double unit = entry.milliseconds_a_unit();
    BenchmarkRound round{.iterations = 1,
                         .real_ms = unit * entry.measured("real_time"),
                         .cpu_ms = unit * entry.measured("cpu_time"),
                         .cycles = entry.counted("cycles"),
                         .instructions = entry.counted("instructions"),
                         .counters = {}};
    if (const Json count = entry.at("iterations"); count.is_number_unsigned())
        round.iterations = count.get<std::uint64_t>();
    for (const auto& [name, value] : entry.json.items())
        if (value.is_number() && std::ranges::find(kKnown, name) == kKnown.end())
            round.counters[name] = value.get<double>();
    return round;
}

std::string text_or_none(const Json& object, const char* member) {
    const Json value = object.is_object() ? object.value(member, Json()) : Json();
    return value.is_string() ? value.get<std::string>() : "";
}

void read_context(const Json& document, BenchmarkRun& run) {
    const Json context = document.value("context", Json::object());
    run.date = text_or_none(context, "date");
    run.version = text_or_none(context, "version");
    run.commit = text_or_none(context, "commit");
    if (!context.is_object()) return;
    const Json device = context.value("device", Json());
    run.device.name = text_or_none(device, "name");
    run.device.driver = text_or_none(device, "driver");
    run.device.type = text_or_none(device, "type");
    if (const Json noisy = context.value("noisy", Json()); noisy.is_boolean())
        run.noisy = noisy.get<bool>();
}

Benchmark& named(std::vector<Benchmark>& list, const std::string& name) {
    const auto found = std::ranges::find(list, name, &Benchmark::name);
    return found == list.end() ? list.emplace_back(Benchmark{name, {}}) : *found;
}

} // namespace

BenchmarkRun read_benchmarks(const std::string& text, const std::string& file) {
    const Json document = parse_json<Json>(file, text);
    const Json list = document.is_object() ? document.value("benchmarks", Json()) : Json();
    check(list.is_array(), Failure::bad_data, file,
          ": wanted an object with a list 'benchmarks', as 'catoptric bench --json' writes it, "
          "found ",
          document.is_object() ? "benchmarks: " + shown(list) : shown(document));
    BenchmarkRun run;
    read_context(document, run);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Entry entry{list[i], file + ": benchmarks[" + std::to_string(i) + "]"};
        check(list[i].is_object(), Failure::bad_data, entry.place, ": wanted an object, found ",
              shown(list[i]));
        if (!entry.is_round()) continue;
        const std::string name = entry.text(list[i].contains("run_name") ? "run_name" : "name");
        named(run.benchmarks, name).rounds.push_back(round_of(entry));
    }
    check(!run.benchmarks.empty(), Failure::bad_data, file,
          ": benchmarks: wanted at least one that was measured, found none among ", list.size(),
          list.size() == 1 ? " entry" : " entries");
    return run;
}

} // namespace catoptric::report
