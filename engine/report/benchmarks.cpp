// Writes benchmarks as JSON. New versions add fields and never remove any.
#include "report/benchmarks.hpp"

#include "measure/statistics.hpp"
#include "report/json.hpp"

namespace catoptric::report {

namespace {

using measure::Benchmark;
using measure::BenchmarkRound;
using measure::BenchmarkRun;
using measure::Cost;

Json context_json(const BenchmarkRun& run) {
    Json context{{"date", run.date}};
    context["executable"] = run.command.empty() ? "" : run.command.front();
    context["num_cpus"] = run.processors;
    context["load_avg"] = Json::array({number(run.load)});
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

Json entry(const Benchmark& benchmark, std::size_t family) {
    return {{"name", benchmark.name},
            {"family_index", family},
            {"per_family_instance_index", 0},
            {"run_name", benchmark.name}};
}

Json round_json(const Benchmark& benchmark, std::size_t family, std::size_t index) {
    const BenchmarkRound& round = benchmark.rounds[index];
    Json json = entry(benchmark, family);
    json["run_type"] = "iteration";
    json["repetitions"] = benchmark.rounds.size();
    json["repetition_index"] = index;
    json["threads"] = 1;
    json["iterations"] = round.iterations;
    json["real_time"] = number(round.real_ms);
    json["cpu_time"] = number(round.cpu_ms);
    json["time_unit"] = "ms";
    if (round.cycles) json["cycles"] = number(*round.cycles);
    if (round.instructions) json["instructions"] = number(*round.instructions);
    for (const auto& [name, value] : round.counters) json[name] = number(value);
    return json;
}

void put_median(Json& json, const char* name, const std::vector<double>& values) {
    json[name] = number(measure::percentile(values, .5));
    json[std::string(name) + "_ci95"] = interval_json(measure::median_interval(values));
}

Json median_json(const Benchmark& benchmark, std::size_t family) {
    Json json = entry(benchmark, family);
    json["name"] = benchmark.name + "_median";
    json["run_type"] = "aggregate";
    json["repetitions"] = benchmark.rounds.size();
    json["threads"] = 1;
    json["aggregate_name"] = "median";
    json["aggregate_unit"] = "time";
    json["iterations"] = benchmark.rounds.size();
    put_median(json, "real_time", measure::costs_of(benchmark, Cost::real_time));
    put_median(json, "cpu_time", measure::costs_of(benchmark, Cost::cpu_time));
    json["time_unit"] = "ms";
    if (benchmark.rounds.front().cycles)
        put_median(json, "cycles", measure::costs_of(benchmark, Cost::cycles));
    return json;
}

Json ratio_json(const measure::Ratio& ratio) {
    return {{"median", number(ratio.median)}, {"ci95", interval_json(ratio.ci95)}};
}

} // namespace

std::string to_json(const BenchmarkRun& run) {
    Json document{{"context", context_json(run)}};
    Json& list = document["benchmarks"] = Json::array();
    for (std::size_t i = 0; i < run.benchmarks.size(); ++i) {
        const Benchmark& benchmark = run.benchmarks[i];
        for (std::size_t k = 0; k < benchmark.rounds.size(); ++k)
            list.push_back(round_json(benchmark, i, k));
        if (!benchmark.rounds.empty()) list.push_back(median_json(benchmark, i));
    }
    return written(document);
}

std::string to_json(const measure::Changes& changes) {
    Json document{{"schema", "catoptric/bench-compare/1"}};
    Json& list = document["benchmarks"] = Json::array();
    for (const measure::Change& change : changes.list)
        list.push_back({{"name", change.name},
                        {"cost", name_of(change.cost)},
                        {"before", number(change.medians[0])},
                        {"after", number(change.medians[1])},
                        {"ratio", ratio_json(change.ratio)},
                        {"real_time_ratio", ratio_json(change.real_ratio)},
                        {"outcome", name_of(change.outcome())}});
    document["only_before"] = changes.only_before;
    document["only_after"] = changes.only_after;
    return written(document);
}

} // namespace catoptric::report
