// catoptric sweep: plans, runs and merges many comparisons.
#include "core/error.hpp"
#include "core/file.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "report.hpp"
#include "report/json.hpp"
#include "sweep_merge.hpp"
#include "sweep_plan.hpp"
#include "sweep_run.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSweepExamples = R"(Examples:
  catoptric sweep plan sweep.json -o sweep
  catoptric sweep run sweep            again after any interruption
  catoptric sweep check sweep
  catoptric sweep merge sweep -o merged

sweep.json names scenes, techniques, axes and views, such as
{"scenes": ["room", "car.glb"], "techniques": ["parallax", "secant"],
"axes": {"size": ["128x128", "256x256"]}, "views": {"count": 30}}.
'plan' cuts the sweep into pieces. 'run' runs those that have no result, in as many processes and on as many machines
as share the folder. 'check' names what is missing, and 'merge' writes one table of all results.)";

struct SweepOptions {
    std::string action, path, output;
    SweepRunOptions run;
    bool across_identities = false;
};

void plan_action(const SweepOptions& options) {
    check(fs::exists(options.path), Failure::missing_input, options.path,
          ": cannot be opened: No such file or directory");
    require_option(!options.output.empty(), "sweep plan", "-o DIR",
                   "the folder for the plan and its results");
    const fs::path folder = options.output;
    check_output_folder(folder);
    const SweepPlan plan = make_plan(options.path, folder);
    report::create_folder(folder);
    write_plan(plan, folder);
    const auto timings = static_cast<std::size_t>(
        std::ranges::count_if(plan.pieces, &SweepPiece::is_timing));
    print_note(options.run.output_options,
               fmt::format("written: {}: {} picture pieces, {} timing pieces; run "
                           "them with 'catoptric sweep run {}'",
                           (folder / "plan.json").string(), plan.pieces.size() - timings, timings,
                           folder.string()));
    if (options.run.output_options.json)
        print_result(report::serialise({{"schema", "catoptric/sweep-planned/1"},
                                        {"pictures", plan.pieces.size() - timings},
                                        {"timings", timings}}));
}

void run_action(const SweepOptions& options) {
    const fs::path folder = options.path;
    const SweepPlan plan = read_plan(folder);
    const SweepRunCounts counts = run_pieces(folder, plan, options.run);
    std::string text = fmt::format("{} pieces run, {} were finished before", counts.run,
                                   counts.finished_before);
    if (counts.elsewhere > 0)
        text += fmt::format(", {} are in work in other processes", counts.elsewhere);
    print_note(options.run.output_options, text);
    if (options.run.output_options.json)
        print_result(report::serialise({{"schema", "catoptric/sweep-run/1"},
                                        {"run", counts.run},
                                        {"finished_before", counts.finished_before},
                                        {"elsewhere", counts.elsewhere}}));
}

report::Json state_json(const SweepState& state) {
    report::Json json{{"schema", "catoptric/sweep-state/1"},
                      {"pieces", state.pieces},
                      {"finished", state.finished},
                      {"missing", state.missing},
                      {"in_work", state.in_work}};
    json["broken"] = report::list_json(state.broken, [](const auto& piece) {
        return report::Json{{"id", piece.first}, {"why", piece.second}};
    });
    json["unknown"] = state.unknown;
    json["identities"] = state.identities;
    return json;
}

/// Returns a line for each of the first ids, and a line with the number of all further ids.
std::string first_pieces(const std::vector<std::string>& ids, const std::string& what, bool all) {
    constexpr std::size_t kMaxListedPieces = 10;
    const std::size_t shown = all ? ids.size() : std::min(ids.size(), kMaxListedPieces);
    std::string text;
    for (std::size_t i = 0; i < shown; ++i) text += what + ": " + ids[i] + "\n";
    if (shown < ids.size())
        text += fmt::format("{}: {} more (-v lists all)\n", what, ids.size() - shown);
    return text;
}

int check_action(const SweepOptions& options) {
    const SweepState state = check_sweep(options.path, read_plan(options.path));
    const OutputOptions& output_options = options.run.output_options;
    if (output_options.json) {
        print_result(report::serialise(state_json(state)));
        return state.is_complete() ? 0 : 1;
    }
    std::string text = fmt::format("{} of {} pieces have a result, {} are in work\n",
                                   state.finished, state.pieces, state.in_work.size());
    text += first_pieces(state.in_work, "in work", output_options.verbose);
    text += first_pieces(state.missing, "missing", output_options.verbose);
    for (const auto& [id, why] : state.broken)
        text += "broken: " + why + "; delete this file and run the piece again\n";
    text += first_pieces(state.unknown, "belongs to no piece", output_options.verbose);
    if (state.identities.size() > 1)
        text += fmt::format("results come from {} identities\n", state.identities.size());
    print_result(text);
    return state.is_complete() ? 0 : 1;
}

void merge_action(const SweepOptions& options) {
    const SweepPlan plan = read_plan(options.path);
    require_option(!options.output.empty(), "sweep merge", "-o DIR",
                   "the folder for the merged results");
    const fs::path out = options.output;
    check_output_folder(out);
    const MergedSweep merged = merge_sweep(options.path, plan,
                                           options.across_identities ? AcrossIdentities::allowed
                                                                     : AcrossIdentities::refused);
    report::create_folder(out);
    for (const auto& [name, content] : merged.files) write_file(out / name, content);
    if (merged.is_mixed)
        print_note(
            options.run.output_options,
            fmt::format("results of {} identities: {:.3g} % of {} pixels of their common pictures "
                        "differ by more than 1/255",
                        merged.identities.size(), 100 * merged.difference.share(),
                        merged.difference.pixels));
    if (options.run.output_options.json) print_result(merged.files.back().second); // merged.json
    print_note(options.run.output_options, "written: " + out.string());
}

int run_sweep(const SweepOptions& options) {
    const std::size_t action = parse_choice("sweep", options.action,
                                            {"plan", "run", "merge", "check"});
    const auto refuse = [&](bool is_given, const char* option) {
        check(!is_given, Failure::usage, "'sweep ", options.action, "' has no option '", option,
              "'");
    };
    // The option --output may come from the user's file of default options, so actions that do not
    // use it ignore it.
    refuse(action != 1 && !options.run.pieces.empty(), "--piece");
    refuse(action != 1 && options.run.kinds != SweepRunOptions::PieceKinds::all, "--kind");
    refuse(action != 2 && options.across_identities, "--across-identities");
    check(options.run.pieces.empty() || options.run.kinds == SweepRunOptions::PieceKinds::all,
          Failure::usage, "--piece names pieces of one kind; wanted no --kind beside it");
    switch (action) {
    case 0: plan_action(options); break;
    case 1: run_action(options); break;
    case 2: merge_action(options); break;
    default: return check_action(options);
    }
    return 0;
}

} // namespace

void add_sweep_verb(CommandLine& program) {
    const auto options = std::make_shared<SweepOptions>();
    Verb& verb = program.add_verb(
        "sweep", "compare many scenes, techniques and views, in pieces on many machines");
    verb.examples(kSweepExamples);
    verb.argument("ACTION", "plan, run, check or merge", options->action, Verb::Need::required);
    verb.argument("PATH", "plan: the sweep's file; otherwise the folder of the plan", options->path,
                  Verb::Need::required);
    verb.option("-o,--output", "DIR",
                "plan: folder for the plan and its results; merge: folder for the tables",
                options->output);
    verb.repeated("--piece", "ID",
                  "run only this piece, and wait if another process works on it; may be repeated",
                  [options](const std::string& text) { options->run.pieces.push_back(text); });
    verb.option("--kind", "KIND", "run only pieces of this kind: all, pictures or timings (all)",
                [options](const std::string& text) {
                    options->run.kinds = static_cast<SweepRunOptions::PieceKinds>(
                        parse_choice("--kind", text, {"all", "pictures", "timings"}));
                });
    verb.flag("--across-identities",
              "merge pictures of different programs, drivers or processors, and say how much they "
              "differ",
              options->across_identities);
    add_output_options(verb, options->run.output_options);
    verb.action([options] { return run_sweep(*options); });
}

} // namespace catoptric::cli
