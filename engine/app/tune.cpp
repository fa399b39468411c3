#include "app/tune.hpp"

#include "app/bench_subjects.hpp"
#include "gpu/variants.hpp"

#include <deque>

namespace catoptric::app {

namespace {

std::vector<double> device_ms(const measure::Benchmark& benchmark) {
    std::vector<double> ms;
    for (const measure::BenchmarkRound& round : benchmark.rounds)
        ms.push_back(round.counters.at("gpu_ms"));
    return ms;
}

} // namespace

Tuned tune(const EngineOptions& engine, const Request& request, const BenchOptions& options) {
    const UsageMeter meter(UsageMeter::Of::process);
    std::deque<Engine> engines; // they outlive the sessions in the subjects
    std::vector<Subject> subjects;
    const auto add = [&](const std::string& name, const Variants& variants) {
        EngineOptions own = engine;
        own.variants = variants;
        engines.emplace_back(own);
        Subject subject = frame_subject(std::make_shared<Session>(engines.back(), request.scene),
                                        request, options.iterations);
        subject.name = name;
        subject.caller.clear();
        subjects.push_back(std::move(subject));
    };
    const std::string benchmark = "frame/" + request.scene.name + "/" +
                                  std::to_string(request.size.x) + "x" +
                                  std::to_string(request.size.y) + "/" + kTunedTechnique;
    Tuned tuned;
    std::vector<measure::Tried>& tried = tuned.tried;
    for (const gpu::Variant& variant : gpu::variants())
        tried.push_back({.variant = std::string(variant.name),
                         .choice = std::string(variant.choices[1]),
                         .standard = std::string(variant.choices[0]),
                         .benchmark = benchmark,
                         .ms = {},
                         .standard_ms = {}});
    add("default", {{tried.front().variant, tried.front().standard}});
    for (const measure::Tried& one : tried)
        add(one.variant + "=" + one.choice, {{one.variant, one.choice}});
    const measure::BenchmarkRun run = bench(subjects, meter, options, {}, {});
    tuned.noisy = run.noisy.value_or(false);
    for (std::size_t i = 0; i < tried.size(); ++i) {
        tried[i].standard_ms = device_ms(run.benchmarks.front());
        tried[i].ms = device_ms(run.benchmarks[i + 1]);
    }
    if (engine.validate)
        for (const Engine& one : engines) one.check_validation();
    return tuned;
}

} // namespace catoptric::app
