#include "benchmark/tune.hpp"

#include "benchmark/bench_subjects.hpp"
#include "session/embedding.hpp"
#include "session/profile.hpp"

#include <memory>

namespace catoptric::app {

namespace {

std::vector<double> device_ms(const measure::Benchmark& benchmark) {
    std::vector<double> ms;
    for (const measure::BenchmarkRound& round : benchmark.rounds)
        ms.push_back(round.counters.at("gpu_ms"));
    return ms;
}

std::string benchmark_of(const Request& request) {
    return "frame/" + request.scene.name + "/" + std::to_string(request.size.x) + "x" +
           std::to_string(request.size.y) + "/" + kTunedTechnique;
}

} // namespace

Tuned tune(Engine& engine, const Request& request, const BenchOptions& options) {
    const UsageMeter meter(UsageMeter::Of::process);
    const auto session = std::make_shared<Session>(engine, request.scene);
    std::vector<Subject> subjects;
    const auto add = [&](const std::string& name, const gpu::Choices& choices) {
        Subject subject = frame_subject(session, request, options.iterations);
        subject.work = [&engine, choices, work = std::move(subject.work)] {
            Embedding::choose(engine, choices);
            return work();
        };
        subject.name = name;
        subject.caller.clear();
        subjects.push_back(std::move(subject));
    };
    const gpu::Choices defaults = default_choices(engine.device());
    add("default", defaults);
    for (std::size_t i = 0; i < gpu::kVariants; ++i) {
        gpu::Choices choices = defaults;
        choices[i] = 1 - choices[i];
        add(std::string(gpu::variants()[i].name), choices);
    }
    const measure::BenchmarkRun run = bench(subjects, meter, options, {}, {});
    Embedding::choose(engine, defaults);
    Tuned tuned{.tried = {}, .noisy = run.noisy.value_or(false)};
    for (std::size_t i = 0; i < gpu::kVariants; ++i) {
        const gpu::Variant& variant = gpu::variants()[i];
        tuned.tried.push_back({.variant = std::string(variant.name),
                               .choice = std::string(variant.choices[1 - defaults[i]]),
                               .standard = std::string(variant.choices[defaults[i]]),
                               .benchmark = benchmark_of(request),
                               .ms = device_ms(run.benchmarks[i + 1]),
                               .standard_ms = device_ms(run.benchmarks.front())});
    }
    return tuned;
}

} // namespace catoptric::app
