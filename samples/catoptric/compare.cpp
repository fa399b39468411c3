// catoptric compare: compares all techniques with the reference, with time and error in one table.
#include "compare.hpp"

#include "axis_option.hpp"
#include "baseline.hpp"
#include "compare_words.hpp"
#include "core/error.hpp"
#include "core/text.hpp"
#include "figure_options.hpp"
#include "measure/budget.hpp"
#include "measure/causes.hpp"
#include "measure/lag.hpp"
#include "measure/row_notes.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "parse.hpp"
#include "progress.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "study/compare_checks.hpp"
#include "study/compare_settings.hpp"
#include "study/path_distance.hpp"
#include "study/picture_rows.hpp"
#include "study/reference_cache.hpp"
#include "study/study.hpp"
#include "table.hpp"
#include "verbs.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>

namespace catoptric::cli {

namespace {

constexpr const char* kCompareExamples = R"(Examples:
  catoptric compare -o out
  catoptric compare scene.glb -o out --techniques reuse parallax:face=512
  catoptric compare -o out --together --json > report.json
  catoptric compare -o out --views 30 --techniques secant march layered
  catoptric compare roughness -o out --axis rays=4,16 --techniques raytrace
  catoptric compare cornell-mirrors room.glb -o out
  catoptric compare -o out --model both --techniques parallax hybrid
  catoptric compare -o out --lag --size 256x256 --techniques reuse parallax

SCENE comes before --techniques; several scenes make one report with a section and a front for each. The folder DIR
gets report.html, report.md, report.json, rows.csv and images/. --figures writes plot.svg (time against FLIP),
passes.svg (time by pass), causes.svg (with --causes), the same as PDF if rsvg-convert is installed, crop-*.png, and
figures.tex.)";

struct CompareOptions {
    CommonOptions common; ///< options for all scenes
    std::vector<std::string> scenes;
    std::string folder;
    std::vector<std::string> techniques;
    std::vector<KnobAxis> axes;
    bool together = false;
    double reference_seconds = study::CompareRequest().reference_seconds;
    std::optional<int> cameras_per_instant; ///< of drawn views
    study::ReferencePixelKind truth = study::ReferencePixelKind::centre;
    double max_ms = NAN, max_flip = NAN, max_rmse = NAN; ///< budgets; NaN: none
    BaselineOptions baseline;
    std::optional<int> rounds; ///< none: study::kRounds, or one per frame if there are fewer frames
    report::CsvColumns csv = report::CsvColumns::table;
    bool inlines_pictures = false; ///< pictures are in report.html, however large it becomes
    FigureOptions figures;
    report::PagePictures page_pictures() const {
        return inlines_pictures ? report::PagePictures::inlined : report::PagePictures::automatic;
    }
    std::vector<std::pair<std::string, std::string>> pictures; ///< rows of files: name, PICTURES
    std::vector<study::StudyChoice> studies;
    std::vector<std::string> command;
};

/// Returns the scenes that the user asked for, or the built-in scene if there are none.
std::vector<std::string> compared_scenes(const CompareOptions& options) {
    return options.scenes.empty() ? std::vector{options.common.scene} : options.scenes;
}

/// Throws `usage` for more rounds than frames, because each round measures at least one frame of
/// each row.
void check_round_limit(const CompareOptions& options) {
    const int frames = options.common.frames.value_or(session::Request().frames);
    check(!options.rounds || *options.rounds <= frames, Failure::usage, "--rounds: wanted at most ",
          frames, ", one for each of --frames, found ", options.rounds.value_or(0));
}

/// Returns the request for one scene, with the options for all scenes.
study::CompareRequest make_compare_request(const CompareOptions& options,
                                           const std::string& scene) {
    study::CompareRequest request;
    CommonOptions common = options.common;
    common.scene = scene;
    request.base = make_request(common, study::check_has_mirror);
    const bool keeps = common.both_models || request.base.model == session::RenderedWork::required;
    if (keeps && !common.animate && !common.warmup)
        request.base.warmup = session::Request().total();
    request.base.techniques = options.techniques;
    request.both_models = options.common.both_models;
    request.reference = study::choose_reference(options.common.reference, request.base.scene,
                                                options.truth);
    request.reference_seconds = options.reference_seconds;
    const bool draws_views = std::ranges::any_of(
        options.studies, [](const study::StudyChoice& study) { return study.name == "views"; });
    check(!options.cameras_per_instant || draws_views, Failure::usage,
          "--cameras-per-instant: wanted --views N as well, found no drawn views");
    constexpr int kMinInstants = 6; // fewer would make the effective number of views uncertain
    for (const study::StudyChoice& study : options.studies)
        check(study.name != "views" || !options.cameras_per_instant ||
                  *options.cameras_per_instant * kMinInstants <= study.count,
              Failure::usage, "--cameras-per-instant: wanted at most a sixth of the ", study.count,
              " views, so that they have at least ", kMinInstants, " instants, found ",
              options.cameras_per_instant.value_or(1));
    request.cameras_per_instant = options.cameras_per_instant.value_or(1);
    request.reference_file = options.common.reference_file;
    request.together = options.together;
    request.rounds = options.rounds.value_or(request.rounds);
    request.studies = options.studies;
    request.pictures = options.pictures;
    request.command = options.command;
    return request;
}

std::vector<std::string> requested_rows(const study::CompareRequest& request) {
    const session::Request& base = request.base;
    return base.techniques.empty() ? study::default_techniques(base) : base.techniques;
}

/// Returns the requests for all scenes. All requests are made before any scene is measured, so that
/// an error in the last scene is reported at once.
std::vector<study::CompareRequest> make_compare_requests(const CompareOptions& options) {
    check_round_limit(options);
    check_techniques(options.techniques);
    const std::string& reference = options.common.reference;
    check(options.truth == study::ReferencePixelKind::centre || reference.empty(), Failure::usage,
          "--truth chooses the reference; wanted no --reference beside it, found ", reference);
    // The report of several scenes names one reference: the reference of a scene without rough
    // mirrors.
    const std::string judged_by = study::choose_reference(reference, scene::Scene(), options.truth);
    for (const study::StudyChoice& choice : options.studies) study::check_study(choice, judged_by);
    std::vector<study::CompareRequest> requests;
    const std::vector<std::string> scenes = compared_scenes(options);
    check(options.common.reference_file.empty() || scenes.size() == 1, Failure::usage,
          "--reference ", options.common.reference_file, ": wanted one scene, found ",
          scenes.size());
    check(options.pictures.empty() || scenes.size() == 1, Failure::usage,
          "--row: wanted one scene, found ", scenes.size());
    for (const std::string& scene : scenes) {
        study::CompareRequest request = make_compare_request(options, scene);
        if (scenes.size() > 1)
            request.images = report::images_folder(requests.size(), request.base.scene.name);
        if (!options.axes.empty())
            request.base.techniques = expand_axes(requested_rows(request), options.axes);
        request.base.techniques = requested_rows(request);
        study::check_inputs(request);
        requests.push_back(std::move(request));
    }
    return requests;
}

void check_output_places(const CompareOptions& options,
                         const std::vector<study::CompareRequest>& requests) {
    std::vector<std::filesystem::path> outputs{kStdoutPath}, inputs;
    for (const std::string& file : {options.baseline.summary, options.baseline.junit})
        if (!file.empty()) outputs.emplace_back(file);
    for (const study::CompareRequest& request : requests) {
        std::vector<std::string> images;
        for (const std::string& text : requested_rows(request)) {
            images.push_back(session::parse_technique(text).file_name);
            if (request.both_models) images.push_back(images.back() + "-required");
        }
        for (std::size_t i = 0; i < request.pictures.size(); ++i) {
            images.push_back(study::picture_row_name(request.pictures[i].first, i));
            inputs.emplace_back(request.pictures[i].second);
        }
        const bool is_first = &request == &requests.front();
        for (const std::filesystem::path& file : report::list_files(images, request.images))
            if (is_first || file.has_parent_path()) // the documents cover all scenes
                outputs.push_back(std::filesystem::path(options.folder) / file);
        if (!options.figures.folder.empty())
            for (const std::filesystem::path& file : report::figure_files(images))
                outputs.push_back(options.figures.scene_folder(request.images) / file);
        const std::vector<std::filesystem::path>& files = request.base.scene.files;
        inputs.insert(inputs.end(), files.begin(), files.end());
    }
    check_distinct(outputs, inputs);
    if (!options.baseline.baseline.empty())
        check_distinct(outputs, {options.baseline.baseline}, ", which is the baseline");
}

/// Returns the labels of rows with pixels that are NaN or infinite.
std::vector<std::string> find_broken_rows(const report::Comparison& comparison) {
    std::vector<std::string> broken;
    for (const report::Row& row : comparison.rows)
        if (row.error_all.nonfinite > 0)
            broken.push_back("'" + row.label + "' has " + std::to_string(row.error_all.nonfinite) +
                             " pixels that are not finite");
    return broken;
}

/// Throws the error that ended the comparison early, if any.
void check_not_stopped(const CompareOptions& options, const report::Comparison& comparison) {
    if (comparison.stopped)
        throw_incomplete_run(*comparison.stopped, comparison.rows.size(), comparison.asked,
                             report::describe_unfinished_phase(comparison), options.folder);
}

/// Writes the reports of one or several scenes.
class CompareOutput {
public:
    CompareOutput(const CompareOptions& options, std::size_t count)
        : options_(options), one_(options.folder, options.csv, options.page_pictures()),
          several_(options.folder, compared_scenes(options), options.csv, options.page_pictures()),
          is_one_(count == 1) {}

    void write_scene(std::size_t index, const report::Comparison& comparison) {
        is_one_ ? one_.write(comparison) : several_.write_scene(index, comparison);
    }
    /// Prints the table of one finished scene, and the warnings but the first `known`, which were
    /// printed when the scene was read.
    void print_table(const report::Comparison& comparison, std::size_t known) const {
        const OutputOptions& output_options = options_.common.output_options;
        for (std::size_t i = known; i < comparison.warnings.size(); ++i)
            print_warning(comparison.warnings[i]);
        for (const report::Row& row : comparison.rows)
            for (const std::string& what : measure::row_notes(comparison, row))
                print_note(output_options, row.label + ": " + what);
        for (const std::string& sentence : axes_without_effect(comparison, options_.axes))
            print_note(output_options, sentence);
        std::size_t views = 0;
        for (const report::Row& row : comparison.rows) views = std::max(views, row.views.size());
        if (views > 0 && !output_options.json)
            print_note(output_options, "the report has the errors over " + std::to_string(views) +
                                           " drawn views; the table shows one view");
        if (!output_options.json)
            print_result(
                (is_one_ ? "" : escape(comparison.scene.name) + "\n") + compare_table(comparison) +
                (measure::has_budget(comparison) ? report::describe_budget(comparison) + "\n"
                                                 : "") +
                (comparison.path_distance
                     ? report::describe_path_distance(*comparison.path_distance, comparison.rows) +
                           "\n"
                     : ""));
        else if (is_one_)
            print_result(report::to_json(comparison));
    }
    /// Prints the document of all scenes at the end.
    void print_all_scenes() const {
        if (options_.common.output_options.json && !is_one_)
            print_result(report::to_json(several_.scene_reports()));
    }

private:
    const CompareOptions& options_;
    report::ReportWriter one_;
    report::ScenesWriter several_;
    bool is_one_;
};

/// Asks for the distance of the reference to path tracing, unless an option did. In small pictures
/// it would take longer than the rows.
void ask_for_path_distance(study::CompareRequest& request) {
    if (std::ranges::find(request.studies, study::kPathDistanceStudyName,
                          &study::StudyChoice::name) != request.studies.end())
        return;
    request.studies.push_back(
        {study::kPathDistanceStudyName, study::choose_path_seconds(request.base.size)});
}

/// Measures one scene and writes the report on all scenes so far.
report::Comparison compare_scene(session::Engine& engine, study::CompareRequest& request,
                                 std::size_t index, const CompareOptions& options,
                                 ProgressPrinter& progress, CompareOutput& output,
                                 const BaselineGate& gate) {
    const std::size_t row_count = requested_rows(request).size();
    ask_for_path_distance(request);
    request.watcher = make_watcher(progress);
    report_row(request.watcher, "reference " + request.reference, 0, row_count);
    request.on_finished_row = [&](const report::Comparison& so_far) {
        if (so_far.rows.size() == 1) gate.check_scene(so_far); // its exposure may be known only now
        output.write_scene(index, so_far);
    };
    report::Comparison comparison = study::compare(engine, request);
    comparison.max_ms = options.max_ms;
    comparison.max_flip = options.max_flip, comparison.max_rmse = options.max_rmse;
    progress.clear();
    // If no row was finished, nothing is written, because an earlier report in the folder is worth
    // more.
    if (!comparison.rows.empty()) output.write_scene(index, comparison);
    output.print_table(comparison, request.base.scene.warnings.size());
    return comparison;
}

int run_compare(const CompareOptions& options) {
    const OutputOptions& output_options = options.common.output_options;
    for (const std::string& scene : compared_scenes(options)) scene::check_exists(scene);
    require_option(!options.folder.empty(), "compare", "-o DIR", "the folder for the report");
    check_output_folder(options.folder);
    check_output_folder(std::filesystem::path(options.folder) / "images");
    check_figure_options(options.figures, options.common.size);
    check_baseline_options(options.baseline);
    BaselineGate gate(options.baseline);
    ProgressPrinter progress(output_options, ProgressPrinter::OffTerminal::tenths,
                             "reading scenes, opening the device");
    std::vector<study::CompareRequest> requests = make_compare_requests(options);
    check_output_places(options, requests);
    for (const study::CompareRequest& request : requests) {
        if (options.baseline.baseline.empty()) break;
        report::Comparison settings;
        study::fill_settings(request, settings);
        gate.check_scene(settings);
    }
    session::Engine engine(engine_options(options.common.device));
    progress.clear();
    print_device(engine, options.common.output_options);
    report::create_folder(options.folder);
    for (const study::CompareRequest& request : requests)
        report::create_folder(std::filesystem::path(options.folder) / "images" / request.images);
    const report::DrawingConverter make_pdf = pdf_converter();
    if (!options.figures.folder.empty()) {
        for (const study::CompareRequest& request : requests)
            report::create_folder(options.figures.scene_folder(request.images));
        if (!make_pdf)
            print_note(output_options,
                       "--figures: SVG without PDF: wanted the program rsvg-convert "
                       "in PATH (apt install librsvg2-bin), found none");
    }

    CompareOutput output(options, requests.size());
    std::vector<std::string> broken;
    bool keeps_budgets = true;
    std::exception_ptr figure_failure; ///< the first failure to write figures
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const report::Comparison comparison = compare_scene(engine, requests[i], i, options,
                                                            progress, output, gate);
        if (comparison.stopped || i + 1 == requests.size()) output.print_all_scenes();
        if (!comparison.stopped && i + 1 == requests.size())
            print_note(output_options, "written: " + options.folder);
        check_not_stopped(options, comparison);
        try {
            if (!options.figures.folder.empty())
                report::write_figures(comparison, options.figures.scene_folder(requests[i].images),
                                      options.figures.crop, make_pdf);
        } catch (const Error&) { // the other scenes and the verdict matter more
            if (!figure_failure) figure_failure = std::current_exception();
        }
        gate.judge(comparison);
        for (const std::string& row : find_broken_rows(comparison)) broken.push_back(row);
        keeps_budgets = keeps_budgets && (!measure::has_budget(comparison) ||
                                          measure::find_best_rows(comparison).row);
        requests[i].base.scene = scene::Scene(); // frees the memory of the scene
    }
    if (const std::string verdict = gate.finish(); !verdict.empty())
        output_options.json ? print_message(verdict) : print_result(verdict);
    if (figure_failure) std::rethrow_exception(figure_failure);
    check(broken.empty(), Failure::internal, broken.empty() ? "" : broken.front(),
          broken.size() > 1 ? " (and " + std::to_string(broken.size() - 1) + " more rows)" : "");
    if (options.common.device.validate) engine.check_validation();
    return keeps_budgets && gate.passes() ? 0 : 1;
}

enum class StudyOptionKind : std::uint8_t { number, words, flag };

StudyOptionKind option_kind(const study::Study& study) {
    if (!study.number.empty()) return StudyOptionKind::number;
    return study.words.empty() ? StudyOptionKind::flag : StudyOptionKind::words;
}

/// Adds the options of all studies whose option is of this kind. `options` must outlive the
/// parsing.
void add_study_options(Verb& verb, CompareOptions& options, StudyOptionKind kind) {
    for (const study::Study& study : study::studies()) {
        const std::string option = "--" + std::string(study.name), help(study.help);
        const auto choose = [&options, &study](int count) {
            options.studies.push_back({std::string(study.name), count});
        };
        if (option_kind(study) != kind) continue;
        if (kind == StudyOptionKind::flag) {
            verb.flag(option, help, [choose] { choose(1); });
            continue;
        }
        if (kind == StudyOptionKind::words) {
            verb.repeated(option, std::string(study.words), help, [&](const std::string& text) {
                const auto known = std::ranges::find(options.studies, study.name,
                                                     &study::StudyChoice::name);
                if (known == options.studies.end())
                    options.studies.push_back({std::string(study.name), 1, {text}});
                else
                    known->texts.push_back(text);
            });
            continue;
        }
        verb.option(option, std::string(study.number), help, [=, &study](const std::string& text) {
            const auto count = static_cast<int>(parse_integer(option, text, study.low, study.high));
            if (study.check_count != nullptr) study.check_count(option, count);
            choose(count);
        });
    }
}

/// `options` must outlive the parsing.
void add_compare_options(Verb& verb, const std::shared_ptr<CompareOptions>& options) {
    verb.arguments(
        "SCENE",
        "built-in scenes (see 'list scenes') or .glb, .gltf or .obj files (cornell-mirrors)",
        options->scenes);
    verb.option("-o,--output", "DIR", "folder for the report, created if missing; required",
                options->folder);
    verb.option(
        "--techniques", "T",
        "rows to compare, each name[:knob=value,...], plan:FILE.json or \"PATTERN=name ...\", see "
        "'list techniques' (a built-in list)",
        options->techniques);
    verb.repeated(
        "--axis", "KNOB=VALUES",
        "compare each technique that has the knob with each of several values, such as "
        "rays=1,4,16,64; may be repeated",
        [options](const std::string& text) { options->axes.push_back(parse_axis(text)); });
    verb.repeated(
        "--row", "NAME=PICTURES",
        "further row: another renderer's picture of the same camera, time and size, or "
        "a folder with one for each view, see 'help views'. EXR and HDR files hold linear "
        "light, a PNG what is displayed; NAME=FILE:LAYER for a layer; may be repeated",
        [options](const std::string& text) {
            const std::size_t end = text.find('=');
            check(end != std::string::npos && end > 0 && end + 1 < text.size(), Failure::usage,
                  "--row: wanted NAME=PICTURES, found ", quote(text));
            options->pictures.emplace_back(text.substr(0, end), text.substr(end + 1));
        });
    verb.option("--max-ms", "M",
                "say which row has the least error within M milliseconds; exit code 1 if none is",
                [options](const std::string& text) {
                    options->max_ms = parse_real("--max-ms", text, 0, 1e6);
                });
    verb.option(
        "--max-flip", "F",
        "say which row is the fastest with a FLIP of at most F, within --max-ms if given; exit "
        "code 1 if none is",
        [options](const std::string& text) {
            options->max_flip = parse_real("--max-flip", text, 0, 1);
        });
    verb.option("--max-rmse", "E", "the same with a root mean square error of at most E",
                [options](const std::string& text) {
                    options->max_rmse = parse_real("--max-rmse", text, 0, 1);
                });
    verb.heading(kMeasuringOptions);
    add_study_options(verb, *options, StudyOptionKind::number);
    verb.option("--cameras-per-instant", "M",
                "neighbouring views of --views that share an instant, which costs less time; the "
                "report then states the effective number of views (1)",
                [options](const std::string& text) {
                    options->cameras_per_instant = static_cast<int>(
                        parse_integer("--cameras-per-instant", text, 1, 10'000));
                });
    verb.flag("--together", "draw all rows in one command buffer, on one timeline",
              options->together);
    verb.option("--rounds", "N",
                "number of rounds, in each of which all rows are measured; from 6 to --frames (6)",
                [options](const std::string& text) {
                    options->rounds = static_cast<int>(
                        parse_integer("--rounds", text, study::kRounds, 10000));
                });
    add_baseline_options(verb, options->baseline);
    verb.option("--truth", "T",
                "pixels of the reference: centre (one camera ray, as techniques draw them), "
                "converged (the mean over the pixel's area) or paths (as centre, by path tracing: "
                "with light between surfaces, lamps as areas and a shadowed environment) (centre)",
                [options](const std::string& text) {
                    options->truth = static_cast<study::ReferencePixelKind>(
                        parse_choice("--truth", text, {"centre", "converged", "paths"}));
                });
    verb.option(
        "--reference-seconds", "S",
        "most seconds for a reference with rays=N, if a surface is rough; 0: all its rays in one "
        "frame a half, however long they take (60)",
        [options](const std::string& text) {
            options->reference_seconds = parse_real("--reference-seconds", text, 0, 1e6);
        });
    add_study_options(verb, *options, StudyOptionKind::words);
    add_study_options(verb, *options, StudyOptionKind::flag);
    add_sceneless_options(verb, options->common);
    verb.option("--csv", "COLUMNS", "columns of rows.csv: table (as in the report) or all (table)",
                [options](const std::string& text) {
                    const bool all = parse_choice("--csv", text, {"table", "all"}) == 1;
                    options->csv = all ? report::CsvColumns::all : report::CsvColumns::table;
                });
    verb.flag("--inline",
              "put all pictures into report.html; without it, a page with more than 16 MiB of "
              "pictures loads them from images/",
              options->inlines_pictures);
    add_figure_options(verb, options->figures);
}

} // namespace

void add_compare_verb(CommandLine& program, std::vector<std::string> command) {
    const auto options = std::make_shared<CompareOptions>();
    options->command = std::move(command);
    Verb& verb = program.add_verb(
        "compare", "compare techniques with the reference: time and error in one table");
    verb.examples(kCompareExamples);
    add_compare_options(verb, options);
    verb.action([options] { return run_compare(*options); });
}

std::vector<CompletionOption> compare_options() {
    CommandLine program("catoptric", "", "", "");
    add_compare_verb(program, {});
    return program.completion_verbs().front().options;
}

CompareWords parse_compare_words(std::vector<std::string> words) {
    const auto options = std::make_shared<CompareOptions>();
    CommandLine program("catoptric compare", "", "", "");
    Verb& verb = program.only_verb();
    add_compare_options(verb, options);
    bool is_comparison = false;
    verb.action([&] {
        is_comparison = true;
        return 0;
    });
    program.parse(std::move(words))();
    check(is_comparison, Failure::usage, "wanted a comparison, found --help or --version");
    std::vector<study::CompareRequest> requests = make_compare_requests(*options);
    check(requests.size() == 1, Failure::usage, "wanted one scene, found ", requests.size());
    CompareWords parsed{std::move(requests.front()), options->common.device};
    parsed.request.base.techniques = requested_rows(parsed.request);
    return parsed;
}

} // namespace catoptric::cli
