// catoptric stress: tests properties that pictures must have in extreme cases, with measured values
// and thresholds.
#include "stress/run.hpp"

#include "core/error.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "parse.hpp"
#include "progress.hpp"
#include "report/writer.hpp"
#include "stress/property.hpp"
#include "table.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kStressExamples = R"(Examples:
  catoptric stress                             every property
  catoptric stress -o out --only N1 C9         two properties

Exit code 1 if a row fails.)";

struct StressOptions {
    OutputOptions output_options;
    std::string folder;
    std::vector<std::string> only;
    uvec2 size{256, 256};
    std::uint64_t seed = 1;
    DeviceOptions device;
    std::vector<std::string> command;
};

std::string make_stress_text(const report::StressResults& stress) {
    std::vector<std::vector<std::string>> cells{
        {"id", "verdict", "measured", "threshold", "seconds", "what"}};
    for (const report::StressRow& row : stress.rows) {
        const report::StressCase* worst = row.worst_case();
        const auto figure = [](double value) { return fmt::format("{:.3g}", value); };
        cells.push_back({row.id, report::verdict_name(row.verdict),
                         worst ? figure(worst->measured) : "-", worst ? figure(worst->limit) : "-",
                         fmt::format("{:.1f}", row.seconds), worst ? worst->what : row.remark});
    }
    return align_columns(cells, 5);
}

int run_stress(const StressOptions& options) {
    for (const std::string& id : options.only)
        stress::find_property(id); // an unknown id fails before any work
    if (!options.folder.empty()) {
        const std::filesystem::path folder = options.folder;
        check_output_folder(folder);
        check_output_folder(folder / "images");
        std::vector<std::filesystem::path> outputs{kStdoutPath, folder / "stress.json",
                                                   folder / "stress.html", folder / "stress.md"};
        std::error_code none_yet; // earlier failure pictures may be replaced
        for (const auto& entry : std::filesystem::directory_iterator(folder / "images", none_yet))
            outputs.push_back(entry.path());
        check_distinct(outputs, {});
    }
    session::Engine engine(engine_options(options.device));
    print_device(engine, options.output_options);
    if (!options.folder.empty())
        report::create_folder(std::filesystem::path(options.folder) / "images");
    ProgressPrinter progress(options.output_options);
    report::StressWriter writer(options.folder);
    const auto write = [&](const report::StressResults& so_far) {
        if (!options.folder.empty()) writer.write(so_far);
    };
    const report::StressResults found = stress::run_properties(engine,
                                                               {.only = options.only,
                                                                .size = options.size,
                                                                .seed = options.seed,
                                                                .command = options.command,
                                                                .watcher = make_watcher(progress),
                                                                .on_finished_row = write});
    progress.clear();
    if (!found.rows.empty()) write(found); // an empty table would replace an earlier one
    print_result(options.output_options.json ? report::to_json(found) : make_stress_text(found));
    if (found.stopped)
        throw_incomplete_run(*found.stopped, found.rows.size(), found.asked, "", options.folder);
    if (!options.folder.empty()) print_note(options.output_options, "written: " + options.folder);
    for (const std::string& part : found.parts_not_run())
        print_note(options.output_options, "not run: " + part);
    if (options.device.validate) engine.check_validation();
    return found.has_failed_row() ? static_cast<int>(Failure::threshold) : 0;
}

} // namespace

void add_stress_verb(CommandLine& program, std::vector<std::string> command) {
    const auto options = std::make_shared<StressOptions>();
    options->command = std::move(command);
    Verb& verb = program.add_verb("stress",
                                  "measure properties of extreme scenes against thresholds");
    verb.examples(kStressExamples);
    verb.option("-o,--output", "DIR",
                "folder for stress.json, stress.html, stress.md and pictures of failed properties",
                options->folder);
    verb.option("--only", "ID", "properties to measure, by id (all)", options->only);
    verb.option("--size", "WxH", "size of the pictures in pixels (256x256)",
                [options](const std::string& text) { options->size = parse_size("--size", text); });
    verb.option("--seed", "N", "seed from which the scenes are made (1)",
                [options](const std::string& text) { options->seed = parse_seed("--seed", text); });
    add_device_options(verb, options->device);
    add_validate_option(verb, options->device);
    add_output_options(verb, options->output_options);
    verb.action([options] { return run_stress(*options); });
}

} // namespace catoptric::cli
