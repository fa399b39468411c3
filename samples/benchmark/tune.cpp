#include "benchmark/tune.hpp"

#include "benchmark/bench_subjects.hpp"
#include "session/embedding.hpp"
#include "session/profile.hpp"

#include <memory>

namespace catoptric::benchmark {

namespace {

std::vector<double> device_times(const measure::BenchmarkResult& benchmark) {
    std::vector<double> ms;
    for (const measure::BenchmarkRound& round : benchmark.rounds)
        ms.push_back(round.counters.at("gpu_ms"));
    return ms;
}

std::string tuning_name(const Request& request) {
    return "frame/" + request.scene.name + "/" + std::to_string(request.size.x) + "x" +
           std::to_string(request.size.y) + "/" + kTuningTechnique;
}

} // namespace

TuningResult tune_shaders(Engine& engine, const Request& request, const BenchOptions& options) {
    const UsageMeter meter(UsageMeter::Threads::process);
    const auto session = std::make_shared<Session>(engine, request.scene);
    std::vector<Subject> subjects;
    const auto add = [&](const std::string& name, const gpu::VariantChoices& choices) {
        Subject subject = make_frame_subject(session, request, options.iterations);
        subject.work = [&engine, choices, work = std::move(subject.work)] {
            EmbedAccess::choose_variants(engine, choices);
            return work();
        };
        subject.name = name;
        subject.caller.clear();
        subjects.push_back(std::move(subject));
    };
    const gpu::VariantChoices defaults = default_variants(engine.device());
    add("default", defaults);
    for (std::size_t i = 0; i < gpu::kVariantCount; ++i) {
        gpu::VariantChoices choices = defaults;
        choices[i] = 1 - choices[i];
        add(std::string(gpu::shader_variants()[i].name), choices);
    }
    const measure::BenchmarkRun run = run_benchmarks(subjects, meter, options, {}, {});
    EmbedAccess::choose_variants(engine, defaults);
    TuningResult tuned{.tried = {}, .noisy = run.noisy.value_or(false)};
    for (std::size_t i = 0; i < gpu::kVariantCount; ++i) {
        const gpu::ShaderVariant& variant = gpu::shader_variants()[i];
        tuned.tried.push_back({.variant = std::string(variant.name),
                               .choice = std::string(variant.choices[1 - defaults[i]]),
                               .standard = std::string(variant.choices[defaults[i]]),
                               .benchmark = tuning_name(request),
                               .ms = device_times(run.benchmarks[i + 1]),
                               .standard_ms = device_times(run.benchmarks.front())});
    }
    return tuned;
}

} // namespace catoptric::benchmark
