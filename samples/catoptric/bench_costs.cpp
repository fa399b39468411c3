#include "bench_costs.hpp"

#include "benchmark/costs.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "output_checks.hpp"
#include "progress.hpp"
#include "report/costs.hpp"
#include "scene/built_in.hpp"
#include "session/device_facts.hpp"
#include "study/compare_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::cli {

namespace {

/// Number of measured frames of each row, and frames before them in which captures settle.
constexpr int kCostFitFrames = 12, kCostWarmupFrames = 14;

/// Returns one request per scene.
std::vector<session::Request> cost_requests(const CostsArguments& arguments) {
    std::vector<std::string> scenes = arguments.scenes;
    if (scenes.empty())
        for (const scene::BuiltInScene& scene : scene::built_in_scenes())
            scenes.emplace_back(scene.name);
    std::vector<session::Request> requests;
    for (const std::string& scene : scenes) {
        CommonOptions common = arguments.common;
        common.scene = scene;
        session::Request request = make_request(common, study::check_has_mirror);
        request.frames = common.frames.value_or(kCostFitFrames);
        request.warmup = common.warmup.value_or(kCostWarmupFrames);
        request.techniques = arguments.techniques.empty() ? study::default_techniques(request)
                                                          : arguments.techniques;
        requests.push_back(std::move(request));
    }
    return requests;
}

measure::DeviceCosts fit_this_device(const CostsArguments& arguments, session::Engine& engine,
                                     const std::vector<session::Request>& requests,
                                     const session::Watcher& watcher) {
    std::vector<measure::TimedWork> samples;
    for (const session::Request& request : requests)
        for (measure::TimedWork& sample : benchmark::measure_cost_samples(
                 engine, request,
                 {.iterations = request.frames, .rounds = arguments.rounds, .watcher = watcher}))
            samples.push_back(std::move(sample));
    const measure::DeviceFacts device = session::make_device_facts(engine);
    return measure::fit_costs(device.name + ", " + device.driver, std::move(samples),
                              benchmark::fitted_kinds());
}

/// Fits unit costs of another device. The file gives the times of rows on that device, and the work
/// of the rows is counted on this device.
measure::DeviceCosts fit_other_device(const CostsArguments& arguments, session::Engine& engine,
                                      session::Request request, const session::Watcher& watcher) {
    const report::OtherDeviceTimes times = report::read_times_file(arguments.times);
    request.techniques.clear();
    for (const report::OtherDeviceTimes::TimedRow& row : times.rows)
        request.techniques.push_back(row.technique);
    std::vector<measure::TimedWork> samples = benchmark::count_work_samples(engine, request,
                                                                            watcher);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i].ms = times.rows[i].ms;
    measure::DeviceCosts costs = measure::fit_costs(times.device, std::move(samples), times.kinds);
    costs.note = times.note;
    return costs;
}

} // namespace

std::string costs_table(const measure::DeviceCosts& costs) {
    std::string text = costs.device + "\n";
    for (const measure::UnitCost& unit : costs.units) {
        const WorkKindInfo& kind = kWorkKinds[static_cast<std::size_t>(unit.kind)];
        text += fmt::format("  {:<17} {:>12.5g} ns  {}\n", kind.name, unit.ns, kind.help);
    }
    const measure::FitQuality& fit = *costs.fit;
    text += fmt::format("{} rows, each predicted by costs that were fitted to the others: {:.0f} % "
                        "within 20 %, {:.0f} % within 50 %\n",
                        fit.samples.size(), 100 * fit.share_within(1.2),
                        100 * fit.share_within(1.5));
    return text;
}

int run_cost_fit(const CostsArguments& arguments) {
    check(!arguments.common.both_models && !arguments.common.model, Failure::usage,
          "--model: --costs measures each row with both models, so it takes none");
    check(arguments.times.empty() || arguments.techniques.empty(), Failure::usage,
          "--techniques: the techniques are those of --times");
    CostsArguments asked = arguments;
    if (!asked.times.empty() && asked.scenes.empty()) asked.scenes = {asked.common.scene};
    check(asked.times.empty() || asked.scenes.size() == 1, Failure::usage,
          "--times: wanted the one scene whose times were measured, found ", asked.scenes.size());
    if (!asked.times.empty()) report::read_times_file(asked.times); // refuses it before any work
    std::vector<session::Request> requests = cost_requests(asked);
    if (!asked.output.empty()) check_output_file(asked.output);
    std::vector<std::filesystem::path> inputs;
    for (const session::Request& request : requests)
        inputs.insert(inputs.end(), request.scene.files.begin(), request.scene.files.end());
    if (!asked.times.empty()) inputs.emplace_back(asked.times);
    if (!asked.output.empty()) check_distinct({asked.output}, inputs);
    session::Engine engine(engine_options(asked.common.device));
    print_device(engine, asked.common.output_options);
    ProgressPrinter progress(asked.common.output_options);
    const session::Watcher watcher = make_watcher(progress);
    const session::WatchedWork watched(watcher);
    const measure::DeviceCosts costs = asked.times.empty()
                                           ? fit_this_device(asked, engine, requests, watcher)
                                           : fit_other_device(asked, engine,
                                                              std::move(requests.front()), watcher);
    progress.clear();
    const std::string json = report::to_json(costs);
    print_result(asked.common.output_options.json ? json : costs_table(costs));
    if (asked.output.empty()) return 0;
    write_file(asked.output, json);
    print_note(asked.common.output_options, "written: " + asked.output);
    return 0;
}

} // namespace catoptric::cli
