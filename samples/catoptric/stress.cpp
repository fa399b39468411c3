// catoptric stress: properties that pictures must have at the extremes, measured beside their
// thresholds.
#include "stress/run.hpp"

#include "core/error.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "places.hpp"
#include "progress.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "stress/property.hpp"
#include "table.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kExamples = R"(Examples:
  catoptric stress                             every property, the table on stdout
  catoptric stress -o out --only N1 C9         two of them; DIR gets stress.json, .html, .md, images/

Exit code 1 when a row fails.)";

struct Options {
    Manners manners;
    std::string folder;
    std::vector<std::string> only;
    uvec2 size{256, 256};
    std::uint64_t seed = 1;
    std::string device;
    bool validate = false;
    std::vector<std::string> command;
};

std::string table_of(const report::Stress& stress) {
    std::vector<std::vector<std::string>> cells{
        {"id", "verdict", "measured", "threshold", "seconds", "what"}};
    for (const report::StressRow& row : stress.rows) {
        const report::StressCase* worst = row.worst();
        const auto figure = [](double value) { return fmt::format("{:.3g}", value); };
        cells.push_back({row.id, report::name_of(row.verdict),
                         worst ? figure(worst->measured) : "-", worst ? figure(worst->limit) : "-",
                         fmt::format("{:.1f}", row.seconds), worst ? worst->what : row.remark});
    }
    return aligned(cells, 5);
}

int run(const Options& options) {
    for (const std::string& id : options.only) stress::find_property(id); // before any work
    if (!options.folder.empty()) {
        check_folder_can_be_made(options.folder);
        const std::filesystem::path folder = options.folder;
        check_apart({kStdout, folder / "stress.json", folder / "stress.html", folder / "stress.md"},
                    {});
    }
    app::Engine engine({.device = options.device, .validate = options.validate});
    if (!options.folder.empty()) report::create_folder(options.folder);
    stop_on_signals();
    Progress progress(options.manners);
    report::StressWriter writer(options.folder);
    const auto write = [&](const report::Stress& so_far) {
        if (!options.folder.empty()) writer.write(so_far);
    };
    const report::Stress found = stress::run(
        engine, {.only = options.only,
                 .size = options.size,
                 .seed = options.seed,
                 .command = options.command,
                 .on_row = [&](const std::string& id, std::size_t index,
                               std::size_t count) { progress.row(id, index, count); },
                 .on_finished_row = write});
    progress.clear();
    write(found);
    put(options.manners.json ? report::to_json(found) : table_of(found));
    if (found.stopped)
        fail_incomplete(*found.stopped, found.rows.size(), found.asked, "", options.folder);
    if (!options.folder.empty()) note(options.manners, "written: " + options.folder);
    if (options.validate) engine.check_validation();
    return found.failed() ? static_cast<int>(Failure::threshold) : 0;
}

} // namespace

void add_stress(CLI::App& program, Run& chosen, std::vector<std::string> command) {
    const auto options = std::make_shared<Options>();
    options->command = std::move(command);
    CLI::App* verb = program.add_subcommand(
        "stress", "rendering at the extremes: measured values beside thresholds");
    verb->footer(kExamples);
    verb->add_option("-o,--output", options->folder,
                     "folder for stress.json, stress.html, stress.md and pictures of what failed")
        ->type_name("DIR");
    verb->add_option("--only", options->only, "ids of properties (all)")->type_name("ID");
    add_text(*verb, "--size", "WxH", "picture size (256x256)",
             [options = options.get()](const std::string& text) {
                 options->size = parse_size("--size", text);
             });
    verb->add_option("--seed", options->seed, "of the scenes, which are made for the run (1)")
        ->type_name("N");
    verb->add_option("--device", options->device, "index or part of a name")
        ->type_name("INDEX|NAME");
    verb->add_flag("--validate", options->validate,
                   "the validation layer watches; any message is an error");
    add_manners(*verb, options->manners);
    verb->callback([verb, options, &chosen] {
        refuse_extras(*verb);
        chosen = [options] { return run(*options); };
    });
}

} // namespace catoptric::cli
