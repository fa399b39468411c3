// Writes benchmarks as JSON, and reads them from JSON that other programs may have written.
#include "report/benchmarks.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"
#include "report/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::report {

namespace {

using measure::BenchmarkResult;
using measure::BenchmarkRound;
using measure::BenchmarkRun;
using measure::CostKind;

Json context_json(const BenchmarkRun& run) {
    Json context{{"date", run.date}};
    context["executable"] = run.command.empty() ? "" : run.command.front();
    context["num_cpus"] = run.processors;
    context["load_avg"] = Json::array({number_json(run.load)});
    context["schema"] = "catoptric/bench/1";
    context["version"] = run.version;
    context["commit"] = run.commit;
    context["command"] = run.command;
    context["device"] = device_json(run.device);
    context["cycles"] = run.uncounted.empty() ? "user mode, all threads"
                                              : "not counted: " + run.uncounted;
    context["noisy"] = run.noisy ? Json(*run.noisy) : Json();
    return context;
}

Json make_benchmark_entry(const BenchmarkResult& benchmark, std::size_t family) {
    return {{"name", benchmark.name},
            {"family_index", family},
            {"per_family_instance_index", 0},
            {"run_name", benchmark.name}};
}

Json round_json(const BenchmarkResult& benchmark, std::size_t family, std::size_t index) {
    const BenchmarkRound& round = benchmark.rounds[index];
    Json json = make_benchmark_entry(benchmark, family);
    json["run_type"] = "iteration";
    json["repetitions"] = benchmark.rounds.size();
    json["repetition_index"] = index;
    json["threads"] = 1;
    json["iterations"] = round.iterations;
    json["real_time"] = number_json(round.real_ms);
    json["cpu_time"] = number_json(round.cpu_ms);
    json["time_unit"] = "ms";
    if (round.cycles) json["cycles"] = number_json(*round.cycles);
    if (round.instructions) json["instructions"] = number_json(*round.instructions);
    for (const auto& [name, value] : round.counters) json[name] = number_json(value);
    return json;
}

void add_median_field(Json& json, const char* name, const std::vector<double>& values) {
    json[name] = number_json(measure::percentile(values, .5));
    json[std::string(name) + "_ci95"] = interval_json(measure::median_interval(values));
}

Json median_json(const BenchmarkResult& benchmark, std::size_t family) {
    Json json = make_benchmark_entry(benchmark, family);
    json["name"] = benchmark.name + "_median";
    json["run_type"] = "aggregate";
    json["repetitions"] = benchmark.rounds.size();
    json["threads"] = 1;
    json["aggregate_name"] = "median";
    json["aggregate_unit"] = "time";
    json["iterations"] = benchmark.rounds.size();
    add_median_field(json, "real_time", measure::round_costs(benchmark, CostKind::real_time));
    add_median_field(json, "cpu_time", measure::round_costs(benchmark, CostKind::cpu_time));
    json["time_unit"] = "ms";
    if (benchmark.rounds.front().cycles)
        add_median_field(json, "cycles", measure::round_costs(benchmark, CostKind::cycles));
    return json;
}

Json ratio_json(const measure::CostRatio& ratio) {
    return {{"median", number_json(ratio.median)}, {"ci95", interval_json(ratio.ci95)}};
}

/// One entry of the list and its place in the document.
struct BenchmarkEntry {
    const Json& json;
    std::string place;

    Json member_or_null(const char* member) const { return json.value(member, Json()); }
    std::string read_text(const char* member) const {
        const Json value = member_or_null(member);
        check(value.is_string(), Failure::bad_data, place, ".", member, ": wanted text, found ",
              describe(value));
        return value.get<std::string>();
    }
    /// Returns a member that must be a finite number of at least 0.
    double read_measured_number(const char* member) const {
        const Json value = member_or_null(member);
        const double found = value.is_number() ? value.get<double>() : NAN;
        check(std::isfinite(found) && found >= 0, Failure::bad_data, place, ".", member,
              ": wanted a number of at least 0, found ", describe(value));
        return found;
    }
    std::optional<double> read_optional_count(const char* member) const {
        return json.contains(member) ? std::optional(read_measured_number(member)) : std::nullopt;
    }
    double ms_per_unit() const {
        constexpr std::array<std::pair<const char*, double>, 4> kTimeUnits{
            {{"ns", 1e-6}, {"us", 1e-3}, {"ms", 1}, {"s", 1e3}}};
        const std::string unit = read_text("time_unit");
        for (const auto& [name, ms] : kTimeUnits)
            if (unit == name) return ms;
        fail(Failure::bad_data, place, ".time_unit: wanted ns, us, ms or s, found ", quote(unit));
    }
    /// Returns whether the entry is a round: it is no aggregate and reports no error.
    bool is_single_round() const {
        const Json type = member_or_null("run_type"), failed = member_or_null("error_occurred");
        return (!type.is_string() || type == "iteration") && failed != true;
    }
};

constexpr std::array kNonCounterKeys{"family_index", "per_family_instance_index",
                                     "repetitions",  "repetition_index",
                                     "threads",      "iterations",
                                     "real_time",    "cpu_time",
                                     "cycles",       "instructions"};

BenchmarkRound read_round(const BenchmarkEntry& entry) {
    const double unit = entry.ms_per_unit();
    BenchmarkRound round{.iterations = 1,
                         .real_ms = unit * entry.read_measured_number("real_time"),
                         .cpu_ms = unit * entry.read_measured_number("cpu_time"),
                         .cycles = entry.read_optional_count("cycles"),
                         .instructions = entry.read_optional_count("instructions"),
                         .counters = {}};
    if (const Json count = entry.member_or_null("iterations"); count.is_number_unsigned())
        round.iterations = count.get<std::uint64_t>();
    for (const auto& [name, value] : entry.json.items())
        if (value.is_number() && std::ranges::find(kNonCounterKeys, name) == kNonCounterKeys.end())
            round.counters[name] = value.get<double>();
    return round;
}

std::string read_optional_text(const Json& object, const char* member) {
    const Json value = object.is_object() ? object.value(member, Json()) : Json();
    return value.is_string() ? value.get<std::string>() : "";
}

void read_context(const Json& document, BenchmarkRun& run) {
    const Json context = document.value("context", Json::object());
    run.date = read_optional_text(context, "date");
    run.version = read_optional_text(context, "version");
    run.commit = read_optional_text(context, "commit");
    if (!context.is_object()) return;
    const Json device = context.value("device", Json());
    run.device.name = read_optional_text(device, "name");
    run.device.driver = read_optional_text(device, "driver");
    run.device.type = read_optional_text(device, "type");
    if (const Json noisy = context.value("noisy", Json()); noisy.is_boolean())
        run.noisy = noisy.get<bool>();
}

BenchmarkResult& find_or_add(std::vector<BenchmarkResult>& list, const std::string& name) {
    const auto found = std::ranges::find(list, name, &BenchmarkResult::name);
    return found == list.end() ? list.emplace_back(BenchmarkResult{name, {}}) : *found;
}

} // namespace

std::string to_json(const BenchmarkRun& run) {
    Json document{{"context", context_json(run)}};
    Json& list = document["benchmarks"] = Json::array();
    for (std::size_t i = 0; i < run.benchmarks.size(); ++i) {
        const BenchmarkResult& benchmark = run.benchmarks[i];
        for (std::size_t k = 0; k < benchmark.rounds.size(); ++k)
            list.push_back(round_json(benchmark, i, k));
        if (!benchmark.rounds.empty()) list.push_back(median_json(benchmark, i));
    }
    return serialise(document);
}

std::string to_json(const measure::BenchmarkChanges& changes) {
    Json document{{"schema", "catoptric/bench-compare/1"}};
    document["benchmarks"] = list_json(changes.list, [](const measure::BenchmarkChange& change) {
        return Json{{"name", change.name},
                    {"cost", cost_kind_name(change.cost)},
                    {"before", number_json(change.medians[0])},
                    {"after", number_json(change.medians[1])},
                    {"ratio", ratio_json(change.ratio)},
                    {"real_time_ratio", ratio_json(change.real_ratio)},
                    {"outcome", outcome_name(change.outcome())},
                    {"counts", list_json(change.counts, [](const measure::WorkChange& count) {
                         return Json{{"name", count.name},
                                     {"before", number_json(count.before)},
                                     {"after", number_json(count.after)}};
                     })}};
    });
    document["only_before"] = changes.only_before;
    document["only_after"] = changes.only_after;
    return serialise(document);
}

BenchmarkRun read_benchmarks(const std::string& text, const std::string& file) {
    const Json document = parse_json<Json>(file, text);
    const Json list = document.is_object() ? document.value("benchmarks", Json()) : Json();
    check(list.is_array(), Failure::bad_data, file,
          ": wanted an object with a list 'benchmarks', as 'catoptric bench --json' writes it, "
          "found ",
          document.is_object() ? "benchmarks: " + describe(list) : describe(document));
    BenchmarkRun run;
    read_context(document, run);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const BenchmarkEntry entry{list[i], file + ": benchmarks[" + std::to_string(i) + "]"};
        check(list[i].is_object(), Failure::bad_data, entry.place, ": wanted an object, found ",
              describe(list[i]));
        if (!entry.is_single_round()) continue;
        const std::string name = entry.read_text(list[i].contains("run_name") ? "run_name"
                                                                              : "name");
        find_or_add(run.benchmarks, name).rounds.push_back(read_round(entry));
    }
    check(!run.benchmarks.empty(), Failure::bad_data, file,
          ": benchmarks: wanted at least one that was measured, found none among ", list.size(),
          list.size() == 1 ? " entry" : " entries");
    return run;
}

} // namespace catoptric::report
