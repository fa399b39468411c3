// catoptric choose: chooses the cheapest plan that keeps a limit, and proves it on other views.
#include "study/choose_json.hpp"

#include "compare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "parse.hpp"
#include "progress.hpp"
#include "report/costs.hpp"
#include "report/json.hpp"
#include "report/tables.hpp"
#include "session/exposure.hpp"
#include "study/compare_checks.hpp"
#include "study/path_distance.hpp"
#include "study/reference_cache.hpp"
#include "study/study.hpp"
#include "table.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kChooseExamples = R"(Examples:
  catoptric choose room.glb --max-flip 0.05 -o plan.json
  catoptric choose room.glb --max-ms 4 --costs gtx-1080-ti -o card.json
  catoptric render room.glb --plan plan.json -o look.png
  catoptric choose room.glb --certify plan.json --proof-seed 7

Candidates are judged in drawn views, and techniques are mixed by mirror. Up to five plans that are likely to hold are
then proved on fresh views, the slowest first. plan.json holds the last plan that holds, with its certificate: "at least
this share of drawn views keeps the limit, with this confidence". With --max-ms alone, the certificate states the error
that this share keeps. Times predicted by --costs may hold at best. If no plan keeps the limits, plan.json holds the
nearest plan with what it proves, and the exit code is 1.)";

struct ChooseOptions {
    CommonOptions common;
    study::ChooseRequest limits; ///< request without scene, reference and watcher
    std::string output, certified;
    std::vector<std::string> techniques;
    bool is_share_given = false, is_confidence_given = false, is_proof_seed_given = false;
    std::optional<int> path_distance_seconds; ///< limit of time; none: by the picture's size
    std::vector<std::string> command;
};

void set_error_limit(const std::string& option, study::ErrorQuantity quantity,
                     const std::string& text, study::ChooseRequest& limits) {
    check(!limits.max_error, Failure::usage, option,
          ": wanted one of --max-flip, --max-rmse and --max-error, found several");
    limits.quantity = quantity;
    limits.max_error = parse_real(option, text, 0, 1);
}

void read_error_limit(const std::string& text, study::ChooseRequest& limits) {
    const std::size_t end = text.find('=');
    const std::string quantity = text.substr(0, end);
    check(end != std::string::npos && (quantity == "flip" || quantity == "rmse"), Failure::usage,
          "--max-error: wanted flip=VALUE or rmse=VALUE, found ", quote(text));
    set_error_limit("--max-error",
                    quantity == "flip" ? study::ErrorQuantity::flip : study::ErrorQuantity::rmse,
                    text.substr(end + 1), limits);
}

/// Returns the certificate in a file of a plan; an empty object if the file has none.
nlohmann::json read_certificate(const std::string& file) {
    const auto document = parse_json<nlohmann::json>(file, read_file(file));
    nlohmann::json certificate;
    if (document.is_object()) certificate = document.value("certificate", nlohmann::json());
    return certificate.is_object() ? certificate : nlohmann::json::object();
}

/// Sets size, exposure, reference, limits, share, confidence and seeds from a plan's certificate,
/// where the options give none.
void read_certificate(const ChooseOptions& options, study::ChooseRequest& request) {
    const std::string& file = options.certified;
    const nlohmann::json certificate = read_certificate(file);
    const auto number = [&](const char* name, double low, double high) -> std::optional<double> {
        const nlohmann::json value = certificate.value(name, nlohmann::json());
        if (value.is_null()) return std::nullopt;
        const bool fits = value.is_number() && value.get<double>() >= low &&
                          value.get<double>() <= high;
        check(fits, Failure::bad_data, file, ": certificate.", name, ": wanted a number from ", low,
              " to ", high, ", found ", report::describe(value));
        return value.get<double>();
    };
    constexpr double kMaxEdge = 1 << 20; // as of --size
    const std::optional<double> width = number("width", 1, kMaxEdge),
                                height = number("height", 1, kMaxEdge);
    check(width.has_value() == height.has_value(), Failure::bad_data, file,
          ": certificate: wanted width and height, found one of them");
    if (width && !options.common.is_size_given)
        request.base.size = {static_cast<unsigned>(*width), static_cast<unsigned>(*height)};
    if (!options.common.overrides.exposure)
        if (const std::optional<double> exposure = number("exposure", -scene::kMaxExposureStops,
                                                          scene::kMaxExposureStops)) {
            request.base.exposure = *exposure;
            request.base.auto_exposure = false;
        }
    const nlohmann::json reference = certificate.value("reference", nlohmann::json());
    check(reference.is_null() || reference.is_string(), Failure::bad_data, file,
          ": certificate.reference: wanted a technique, found ", report::describe(reference));
    if (reference.is_string() && options.common.reference.empty()) {
        try {
            request.reference = parse_reference(reference.get<std::string>());
        } catch (const Error& error) {
            throw_error(Failure::bad_data, file + ": certificate.reference: " + error.what());
        }
    }
    constexpr double kMaxSeed = 0x1p53; // integers of a double
    if (!request.max_error) {
        request.max_error = number("max_error", 0, 1);
        if (certificate.value("quantity", nlohmann::json()) == "rmse")
            request.quantity = study::ErrorQuantity::rmse;
    }
    if (!request.max_ms) request.max_ms = number("max_ms", 0, 1e6);
    // A plan that keeps no requested limit states the error that it keeps.
    if (!request.max_error && !request.max_ms) request.max_error = number("error_bound", 0, 1);
    check(request.max_error || request.max_ms, Failure::usage, file,
          ": has no certificate with a limit; wanted --max-flip, --max-rmse or --max-ms");
    if (!options.is_share_given) request.share = number("share", .5, .9999).value_or(request.share);
    if (!options.is_confidence_given)
        request.confidence = number("confidence", .5, .9999).value_or(request.confidence);
    if (const std::optional<double> seed = number("training_seed", 0, kMaxSeed))
        request.base.seed = static_cast<std::uint64_t>(*seed);
    const std::optional<double> proved = number("proof_seed", 0, kMaxSeed);
    if (!options.is_proof_seed_given) // other views than those of the certificate
        request.proof_seed = std::max(static_cast<std::uint64_t>(proved.value_or(1)),
                                      request.base.seed) +
                             1;
    check(!proved || static_cast<std::uint64_t>(*proved) != request.proof_seed, Failure::usage,
          "--proof-seed: wanted another than that of the certificate, found ", request.proof_seed);
    check(certificate.value("times", nlohmann::json()) != "predicted" || !request.costs.empty() ||
              !request.max_ms,
          Failure::usage, file, ": its limit of time is for another device; wanted --costs of it");
}

std::string candidate_table(const study::ChooseRequest& request, const study::PlanChoice& choice) {
    std::vector<std::vector<std::string>> rows{
        {"candidate", request.costs.empty() ? "ms [95 %]" : "ms [range]",
         fmt::format("largest {}", study::quantity_name(request.quantity)), "views", "result"}};
    for (const study::JudgedPlan& plan : choice.candidates)
        rows.push_back(
            {plan.text, study::format_time_range(plan),
             std::isnan(plan.largest_error) ? "-" : fmt::format("{:.5f}", plan.largest_error),
             fmt::format("{}", std::max<std::size_t>(1, plan.errors.size())), plan.why});
    return align_columns(rows, rows.front().size() - 1);
}

/// Returns the table of candidates, a line for each proof, and the choice or the nearest plan.
std::string describe_choice(const study::ChooseRequest& request, const study::PlanChoice& choice) {
    std::string text = candidate_table(request, choice);
    for (const study::PlanProof& proof : choice.proofs)
        text += study::describe_verdict(request, proof) + ": " +
                study::describe_proof(request, proof) + "\n";
    if (choice.chosen) {
        const study::JudgedPlan& plan = choice.proofs[*choice.chosen].plan;
        const std::string drawn = plan.drawn.empty()
                                      ? ""
                                      : ", which drew " + plan.drawn + " in the request's own view";
        return text + "chosen: " + plan.text + drawn + "\n";
    }
    return text + "no plan: " + choice.failure + "\nnearest: " +
           study::describe_nearest_proof(request, choice.proofs.at(choice.nearest.value())) + "\n";
}

study::ChooseRequest make_choose_request(const ChooseOptions& options, ProgressPrinter& progress) {
    study::ChooseRequest request = options.limits;
    request.base = make_request(options.common, study::check_has_mirror);
    request.base.techniques = options.techniques;
    request.reference = study::choose_reference(options.common.reference, request.base.scene,
                                                study::ReferencePixelKind::centre);
    if (!options.certified.empty()) {
        study::check_techniques({"plan:" + options.certified});
        read_certificate(options, request);
    }
    if (!request.costs.empty()) report::read_costs_file(request.costs); // before any work
    request.watcher = make_watcher(progress);
    request.tell = [&progress, &options](const std::string& step) {
        progress.clear();
        print_note(options.common.output_options, step);
    };
    return request;
}

/// Measures how far the reference is from path tracing, in a session of its own. Called before the
/// choice, so that a signal meanwhile loses no chosen plan.
std::optional<measure::PathDistance> measure_distance(const ChooseOptions& options,
                                                      const study::ChooseRequest& request,
                                                      session::Engine& engine,
                                                      ProgressPrinter& progress) {
    session::Request base = request.base;
    session::Session session(engine, base.scene);
    session::resolve_exposure(session, base);
    auto distance = study::measure_path_distance(
        engine, session, base, request.reference,
        options.path_distance_seconds.value_or(study::choose_path_seconds(base.size)),
        request.watcher, [&](const std::string& warning) {
            progress.clear();
            print_warning(warning);
        });
    progress.clear();
    return distance;
}

/// Adds the distance of the reference to path tracing to the file of a plan.
void add_path_distance(report::Json& document,
                       const std::optional<measure::PathDistance>& distance) {
    if (distance) document["path_distance"] = report::path_distance_json(*distance);
}

std::string distance_line(const std::optional<measure::PathDistance>& distance) {
    return distance ? report::describe_path_distance(*distance, {}) + "\n" : "";
}

int certify_plan(const ChooseOptions& options, const study::ChooseRequest& request,
                 session::Engine& engine, ProgressPrinter& progress) {
    const std::string plan = "plan:" + options.certified;
    const auto distance = measure_distance(options, request, engine, progress);
    const study::PlanProof proof = study::prove_plan(engine, request, plan);
    progress.clear();
    report::Json document = study::proved_plan_json(request, plan, proof, options.common.scene);
    add_path_distance(document, distance);
    document["command"] = options.command;
    if (!options.output.empty() && proof.may_hold())
        write_file(options.output, report::serialise(document));
    if (options.common.device.validate) engine.check_validation();
    print_result(options.common.output_options.json
                     ? report::serialise(document)
                     : study::describe_verdict(request, proof) + ": " +
                           study::describe_proof(request, proof) + "\n" + distance_line(distance));
    return proof.may_hold() ? 0 : 1;
}

/// Throws `usage` if the file of the chosen plan would replace a file that the program reads.
void check_output_place(const ChooseOptions& options, const study::ChooseRequest& request) {
    check_distinct({options.output}, request.base.scene.files);
    std::vector<std::filesystem::path> read;
    for (const std::string& file : {options.certified, request.costs})
        if (!file.empty()) read.emplace_back(file);
    for (const std::string& text : options.techniques)
        if (text.starts_with("plan:")) read.emplace_back(text.substr(5));
    check_distinct({options.output}, read, ", which is read");
}

int run_choose(const ChooseOptions& options) {
    scene::check_exists(options.common.scene);
    if (!options.certified.empty()) read_certificate(options.certified);
    if (!options.limits.costs.empty()) report::read_costs_file(options.limits.costs);
    check(options.certified.empty() || options.techniques.empty(), Failure::usage,
          "--certify: wanted no --techniques beside it");
    if (options.certified.empty()) {
        require_option(options.limits.max_error || options.limits.max_ms, "choose",
                       "--max-flip, --max-rmse or --max-ms", "the limit to keep");
        require_option(!options.output.empty(), "choose", "-o PLAN.json", "the file for the plan");
        check_techniques(options.techniques);
    }
    check(!options.common.both_models, Failure::usage,
          "--model both: wanted everything or required, of which a plan has one");
    check(options.common.reference_file.empty(), Failure::usage,
          "--reference: wanted a technique, found a file");
    if (!options.output.empty()) check_output_file(options.output);
    ProgressPrinter progress(options.common.output_options, ProgressPrinter::OffTerminal::tenths);
    const study::ChooseRequest request = make_choose_request(options, progress);
    if (!options.output.empty()) check_output_place(options, request);
    session::Engine engine(engine_options(options.common.device));
    print_device(engine, options.common.output_options);
    if (!options.certified.empty()) return certify_plan(options, request, engine, progress);
    const auto distance = measure_distance(options, request, engine, progress);
    const study::PlanChoice choice = study::choose_plan(engine, request);
    progress.clear();
    report::Json document = study::choice_json(request, choice, options.common.scene);
    add_path_distance(document, distance);
    document["command"] = options.command;
    write_file(options.output, report::serialise(document));
    print_result(options.common.output_options.json
                     ? report::serialise(document)
                     : describe_choice(request, choice) + distance_line(distance));
    print_note(options.common.output_options,
               (choice.chosen ? "written: " : "written, the nearest plan: ") + options.output);
    if (options.common.device.validate) engine.check_validation();
    return choice.chosen ? 0 : 1;
}

void add_limit_options(Verb& verb, ChooseOptions& options) {
    study::ChooseRequest& limits = options.limits;
    const auto add_limit = [&](const char* option, const char* value, const char* help,
                               study::ErrorQuantity quantity) {
        verb.option(option, value, help, [=, &limits](const std::string& text) {
            set_error_limit(option, quantity, text, limits);
        });
    };
    add_limit("--max-flip", "F", "limit of FLIP over the mirrors in a view, from 0 to 1",
              study::ErrorQuantity::flip);
    add_limit("--max-rmse", "E", "limit of the root mean square error there, from 0 to 1",
              study::ErrorQuantity::rmse);
    verb.option("--max-error", "Q=V", "the same as flip=V or rmse=V",
                [&limits](const std::string& text) { read_error_limit(text, limits); });
    verb.option("--max-ms", "M",
                "limit of the time of a frame, milliseconds; alone: choose the least error",
                [&limits](const std::string& text) {
                    limits.max_ms = parse_real("--max-ms", text, 0, 1e6);
                });
    verb.option("--share", "Q", "share of views that must keep the limit of error (0.95)",
                [&options](const std::string& text) {
                    options.limits.share = parse_real("--share", text, .5, .9999);
                    options.is_share_given = true;
                });
    verb.option("--confidence", "C", "confidence of the statement (0.95)",
                [&options](const std::string& text) {
                    options.limits.confidence = parse_real("--confidence", text, .5, .9999);
                    options.is_confidence_given = true;
                });
    verb.option(
        "--reference-seconds", "S",
        "most seconds to reduce the noise of a reference with rays=N, in each comparison, if "
        "a surface is rough (60)",
        [&limits](const std::string& text) {
            limits.reference_seconds = parse_real("--reference-seconds", text, 0, 1e6);
        });
    verb.option("--path-distance", "S",
                std::string(study::find_study(study::kPathDistanceStudyName).help),
                [&options](const std::string& text) {
                    options.path_distance_seconds = static_cast<int>(
                        parse_integer("--path-distance", text, 0, 86'400));
                });
    verb.option(
        "--costs", "COSTS",
        "choose for another device, by times predicted from its costs: a file, or a name of "
        "'list costs'",
        options.limits.costs);
}

void add_count_options(Verb& verb, ChooseOptions& options) {
    study::ChooseRequest& limits = options.limits;
    verb.option("--cameras-per-instant", "M",
                "neighbouring training views of one instant, which share captures (3)",
                [&limits](const std::string& text) {
                    limits.cameras_per_instant = static_cast<int>(
                        parse_integer("--cameras-per-instant", text, 1, 10'000));
                });
    verb.option(
        "--training-views", "N",
        "views on which plans are found, at least 6 (as many as show a breach of the share, 59 "
        "for 95 %)",
        [&limits](const std::string& text) {
            limits.training_views = static_cast<int>(
                parse_integer("--training-views", text, 6, 10'000));
        });
    verb.option("--proof-views", "N",
                "fresh views on which plans are proved, at least as many as can prove the share "
                "(59 for 95 % with 95 % confidence)",
                [&limits](const std::string& text) {
                    limits.proof_views = static_cast<int>(
                        parse_integer("--proof-views", text, 6, 10'000));
                });
    verb.option("--proof-seed", "N",
                "seed of the fresh views, another than --seed (2; with --certify another than the "
                "certificate's)",
                [&options](const std::string& text) {
                    options.limits.proof_seed = static_cast<std::uint64_t>(
                        parse_integer("--proof-seed", text, 0, 1'000'000'000));
                    options.is_proof_seed_given = true;
                });
}

} // namespace

void add_choose_verb(CommandLine& program, std::vector<std::string> command) {
    const auto options = std::make_shared<ChooseOptions>();
    options->command = std::move(command);
    Verb& verb = program.add_verb(
        "choose", "choose the cheapest plan within a limit of error or time, with a certificate");
    verb.examples(kChooseExamples);
    verb.argument("SCENE", "built-in scene or .glb, .gltf or .obj file (cornell-mirrors)",
                  options->common.scene, Verb::Need::optional);
    verb.option("-o,--output", "FILE", "file for the plan; required without --certify",
                options->output);
    verb.option("--techniques", "T", "candidates, as of compare (a built-in list)",
                options->techniques);
    verb.option(
        "--certify", "FILE",
        "prove the plan of this file again on fresh views, by its certificate's limits, size, "
        "exposure and reference",
        options->certified);
    add_limit_options(verb, *options);
    verb.heading(kMeasuringOptions);
    add_count_options(verb, *options);
    add_sceneless_options(verb, options->common);
    verb.action([options] { return run_choose(*options); });
}

} // namespace catoptric::cli
