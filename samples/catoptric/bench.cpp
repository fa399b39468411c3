// catoptric bench: measures the cost of frames and of their preparation, and compares runs or
// builds.
#include "bench_against.hpp"
#include "bench_calibrate.hpp"
#include "bench_costs.hpp"
#include "bench_table.hpp"
#include "bench_tune.hpp"
#include "benchmark/bench_subjects.hpp"
#include "compare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "parse.hpp"
#include "progress.hpp"
#include "report/benchmarks.hpp"
#include "session/device_facts.hpp"
#include "study/compare_checks.hpp"
#include "verbs.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kBenchExamples = R"(Examples:
  catoptric bench -o now.json
  catoptric bench --techniques raytrace:depth=4 parallax:face=512 --rounds 12
  catoptric bench scene.glb --size 256x256 --json > scene.json
  catoptric bench --compare before.json now.json
  catoptric bench --against ../before/build/release/catoptric
  catoptric bench --tune
  catoptric bench --costs -o device.json
  catoptric bench --calibrate

SCENE comes before --techniques. frame/...: a whole frame on all threads; host/...: the calling thread's part of it;
load/: making or reading the scene; session/: putting it on the device; hierarchy/: building its tree.
Cycles are user-mode cycles. If the system does not count them (perf_event), processor time is used.
--tune measures frames of the ray tracer with each shader variant and with the default, and stores variants that are
certainly faster in the profile; pictures stay equal, byte for byte.
Exit code 1 if --compare or --against finds a slower benchmark (the interval of its ratio lies above 1), or a
benchmark whose counted work has grown by more than a hundredth.)";

/// Techniques that are measured by default.
const std::vector<std::string> kBenchTechniques{"raytrace:depth=4",
                                                "raytrace:depth=4,sphere=exact",
                                                "parallax:face=64",
                                                "parallax",
                                                "parallax:face=512",
                                                "secant",
                                                "march",
                                                "pyramid",
                                                "layered",
                                                "hybrid"};
constexpr const char* kOneModelMessage =
    "--model both: wanted everything or required, of which a benchmark has one";
constexpr const char* kFlatMirrorScene = "flat"; // `planar` needs a flat mirror
constexpr const char* kFlatTechnique = "planar";

struct BenchArguments {
    CommonOptions common; ///< options for all scenes
    std::vector<std::string> scenes;
    std::vector<std::string> techniques;
    std::string output;
    int rounds = study::kRounds;
    std::vector<std::string> before_and_after; ///< files to compare
    std::string against;                       ///< program of another build
    bool tunes = false;
    bool fits_costs = false, calibrates = false;
    std::string times; ///< with `fits_costs`: file of times of another device
    std::vector<std::string> command;
};

/// A scene and the techniques to measure.
struct SceneSelection {
    CommonOptions common;
    std::vector<std::string> techniques;
};

std::vector<SceneSelection> requested_scenes(const BenchArguments& options) {
    std::vector<SceneSelection> list;
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) scenes.push_back(options.common.scene);
    for (const std::string& scene : scenes) {
        list.push_back(
            {options.common, options.techniques.empty() ? kBenchTechniques : options.techniques});
        list.back().common.scene = scene;
    }
    if (options.scenes.empty() && options.techniques.empty()) {
        list.push_back({options.common, {kFlatTechnique}});
        list.back().common.scene = kFlatMirrorScene;
    }
    return list;
}

int choose_frame_count(const BenchArguments& options) {
    return options.common.frames.value_or(session::Request().frames);
}

void load_benchmark_scene(const CommonOptions& common) {
    session::resolve_scene(common.scene, {.load = scene_file_options(common),
                                          .overrides = common.overrides,
                                          .use_scene_file = common.use_scene_file});
}

void add_subjects(session::Engine& engine, const SceneSelection& asked, session::Request request,
                  int iterations, std::vector<benchmark::Subject>& subjects) {
    const CommonOptions common = asked.common;
    subjects.push_back(benchmark::make_subject("load/" + request.scene.name,
                                               [common] { load_benchmark_scene(common); }));
    subjects.push_back(benchmark::make_session_subject(engine, request.scene));
    subjects.push_back(benchmark::make_bvh_subject(request.scene));
    const auto session = std::make_shared<session::Session>(engine, request.scene);
    for (const std::string& technique : asked.techniques) {
        request.techniques = {technique};
        subjects.push_back(benchmark::make_frame_subject(session, request, iterations));
    }
}

void check_output_options(const BenchArguments& options,
                          const std::vector<std::filesystem::path>& inputs,
                          const std::string& read) {
    if (options.output.empty()) return;
    check_output_file(options.output);
    check_distinct({kStdoutPath, options.output}, inputs, read);
}

/// Writes the result to stdout, and also to a file if the user asks for one.
void write_result(const BenchArguments& options, const std::string& json,
                  const std::string& table) {
    print_result(options.common.output_options.json ? json : table);
    if (options.output.empty()) return;
    write_file(options.output, json);
    print_note(options.common.output_options, "written: " + options.output);
}

int run_measurement(const BenchArguments& options) {
    // Created before the driver's threads, to count them as well.
    const session::UsageMeter meter(session::UsageMeter::Threads::process);
    check(!options.common.both_models, Failure::usage, kOneModelMessage);
    check_techniques(options.techniques);
    const std::vector<SceneSelection> list = requested_scenes(options);
    std::vector<session::Request> requests;
    std::vector<std::filesystem::path> inputs;
    for (const SceneSelection& asked : list) {
        requests.push_back(make_request(asked.common));
        const std::vector<std::filesystem::path>& files = requests.back().scene.files;
        inputs.insert(inputs.end(), files.begin(), files.end());
    }
    check_output_options(options, inputs, ", which the scene is read from");
    session::Engine engine(engine_options(options.common.device));
    print_device(engine, options.common.output_options);
    const int iterations = choose_frame_count(options);
    std::vector<benchmark::Subject> subjects;
    for (std::size_t i = 0; i < list.size(); ++i)
        add_subjects(engine, list[i], std::move(requests[i]), iterations, subjects);
    ProgressPrinter progress(options.common.output_options);
    const measure::BenchmarkRun run = benchmark::run_benchmarks(
        subjects, meter,
        {.iterations = iterations, .rounds = options.rounds, .watcher = make_watcher(progress)},
        session::make_device_facts(engine), options.command);
    progress.clear();
    write_result(options, report::to_json(run), bench_table(run));
    if (options.common.device.validate) engine.check_validation();
    return 0;
}

/// Warns of circumstances other than the program, such as the device, that may cause different
/// times.
void warn_of_differences(const measure::BenchmarkRun& before, const measure::BenchmarkRun& after) {
    if (before.device.name != after.device.name || before.device.driver != after.device.driver)
        print_warning("the devices differ: " + before.device.name + ", " + before.device.driver +
                      " and " + after.device.name + ", " + after.device.driver);
    if (before.noisy.value_or(false) || after.noisy.value_or(false))
        print_warning("others were at work beside what was measured; times are not to be trusted");
}

int report_changes(const BenchArguments& options, const measure::BenchmarkRun& before,
                   const measure::BenchmarkRun& after) {
    warn_of_differences(before, after);
    const measure::BenchmarkChanges changes = measure::compare_runs(before, after);
    if (options.against.empty() &&
        std::ranges::any_of(changes.list, [](const measure::BenchmarkChange& change) {
            return change.cost != measure::CostKind::cycles &&
                   change.cost != measure::CostKind::instructions;
        }))
        print_warning(
            "the files hold times, not cycles: what the machine did otherwise when the second was "
            "measured is in the ratios; --against measures two programs in turn");
    write_result(options, report::to_json(changes), changes_table(changes));
    const std::string slower = describe_slower(changes);
    const std::string grown = describe_grown_work(changes);
    check(slower.empty() && grown.empty(), Failure::threshold,
          slower.empty() ? "" : "slower: ", slower, slower.empty() || grown.empty() ? "" : "; ",
          grown.empty() ? "" : "more work: ", grown);
    return 0;
}

int compare_runs(const BenchArguments& options) {
    const std::vector<std::string>& files = options.before_and_after;
    check(files.size() == 2, Failure::usage, "--compare: wanted OLD and NEW, found ", files.size(),
          files.size() == 1 ? " file" : " files");
    check_output_options(options, {files.begin(), files.end()}, ", which is compared");
    std::vector<measure::BenchmarkRun> runs;
    for (const std::string& file : files)
        runs.push_back(report::read_benchmarks(read_file(file), file));
    return report_changes(options, runs[0], runs[1]);
}

int run_against_program(const BenchArguments& options) {
    study::check_round_limit(options.rounds);
    check_output_options(options, {options.against}, ", which is run");
    const std::string own = std::filesystem::read_symlink("/proc/self/exe").string();
    const int frames = std::max(1, (choose_frame_count(options) + options.rounds - 1) /
                                       options.rounds);
    const std::vector<std::string> words(options.command.begin() + 2, options.command.end());
    ProgressPrinter progress(options.common.output_options);
    const std::array runs = bench_programs({options.against, own}, round_words(words, frames),
                                           options.rounds, make_watcher(progress));
    progress.clear();
    return report_changes(options, runs[0], runs[1]);
}

int run_shader_tuning(const BenchArguments& options) {
    check(options.techniques.empty() && options.scenes.size() <= 1, Failure::usage,
          "--tune: wanted at most one SCENE and no --techniques, since ",
          benchmark::kTuningTechnique, " is what is measured");
    check(!options.common.both_models, Failure::usage, kOneModelMessage);
    CommonOptions common = options.common;
    if (!options.scenes.empty()) common.scene = options.scenes.front();
    return tune_device(common, std::min(options.rounds, choose_frame_count(options)),
                       options.output);
}

int run_calibration(const BenchArguments& options) {
    const CommonOptions& common = options.common;
    check(options.scenes.empty() && options.techniques.empty() &&
              options.rounds == study::kRounds && !common.frames && !common.warmup &&
              !common.is_size_given && !common.model && !common.both_models && !common.time &&
              !common.animate,
          Failure::usage,
          "--calibrate: wanted no SCENE, --techniques, --rounds, --frames, --warmup, --size, "
          "--model, --time or --animate, since it measures rows of its own; --costs fits costs to "
          "other rows");
    return calibrate_device(common, options.output);
}

int run_bench(const BenchArguments& options) {
    const bool compares = !options.before_and_after.empty(), in_turn = !options.against.empty();
    for (const auto& [both, names] :
         {std::pair{compares && in_turn, "--compare and --against"},
          {options.tunes && compares, "--tune and --compare"},
          {options.tunes && in_turn, "--tune and --against"},
          {options.fits_costs && compares, "--costs and --compare"},
          {options.fits_costs && in_turn, "--costs and --against"},
          {options.fits_costs && options.tunes, "--costs and --tune"},
          {options.calibrates && options.tunes, "--calibrate and --tune"},
          {options.calibrates && compares, "--calibrate and --compare"},
          {options.calibrates && in_turn, "--calibrate and --against"},
          {options.calibrates && options.fits_costs, "--calibrate and --costs"}})
        check(!both, Failure::usage, names, ": wanted one of them, found both");
    check(options.times.empty() || options.fits_costs, Failure::usage,
          "--times: wanted together with --costs, found it alone");
    if (options.fits_costs)
        return run_cost_fit({.common = options.common,
                             .scenes = options.scenes,
                             .techniques = options.techniques,
                             .times = options.times,
                             .output = options.output,
                             .rounds = options.rounds});
    if (options.tunes) return run_shader_tuning(options);
    if (options.calibrates) return run_calibration(options);
    return compares  ? compare_runs(options)
           : in_turn ? run_against_program(options)
                     : run_measurement(options);
}

} // namespace

void add_bench_verb(CommandLine& program, std::vector<std::string> command) {
    const auto options = std::make_shared<BenchArguments>();
    options->command = std::move(command);
    Verb& verb = program.add_verb(
        "bench", "measure times of frames and scenes; compare with another run or build");
    verb.examples(kBenchExamples);
    verb.arguments(
        "SCENE",
        "built-in scenes (see 'list scenes') or .glb, .gltf or .obj files (cornell-mirrors; flat "
        "for planar)",
        options->scenes);
    verb.option("-o,--output", "FILE", "file for the result, as JSON in Google Benchmark's format",
                options->output);
    verb.option(
        "--techniques", "T",
        "techniques to measure, each name[:knob=value,...], see 'list techniques' (a built-in "
        "list)",
        options->techniques);
    verb.heading(kMeasuringOptions);
    verb.option(
        "--rounds", "N",
        "number of rounds, in each of which all benchmarks run; from 6 on medians have an interval "
        "(6)",
        [options](const std::string& text) {
            options->rounds = static_cast<int>(parse_integer("--rounds", text, 1, 10000));
        });
    verb.option("--compare", "OLD NEW",
                "compare two result files instead of measuring; exit code 1 if NEW is slower",
                options->before_and_after);
    verb.option(
        "--against", "PROGRAM",
        "compare with another build of this program (a path), taking turns; exit code 1 if this "
        "build is slower",
        options->against);
    verb.flag("--tune",
              "find the shader variants that suit the device; write a profile to the user's "
              "configuration or to -o FILE",
              options->tunes);
    verb.flag("--costs",
              "fit the costs of this device: nanoseconds for each ray, look-up, fragment and so "
              "on, for 'compare --costs'; all built-in scenes if no SCENE is named",
              options->fits_costs);
    verb.flag("--calibrate",
              "fit the costs of this device to a few small rows, in about a minute; 'auto' then "
              "compares plans by them (a file in the user's configuration, or -o FILE)",
              options->calibrates);
    verb.option("--times", "FILE",
                "with --costs: fit the costs of another device to its times in FILE",
                options->times);
    add_sceneless_options(verb, options->common);
    verb.action([options] { return run_bench(*options); });
}

} // namespace catoptric::cli
