// catoptric graph: shows the compiled render graph of a frame.
#include "core/error.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "parse.hpp"
#include "session/access.hpp"
#include "session/calibration.hpp"
#include "session/culling_report.hpp"
#include "session/session.hpp"
#include "technique_option.hpp"
#include "verbs.hpp"

#include <memory>
#include <optional>

namespace catoptric::cli {

namespace {

constexpr const char* kGraphExamples = R"(Examples:
  catoptric graph --technique naive:bounces=2
  catoptric graph --technique reuse --format dot | dot -Tsvg > reuse.svg
  catoptric graph --technique parallax --json
  catoptric graph --plan "1=reuse:face=64 *=raytrace"
  catoptric graph gallery --why
  catoptric graph gallery --why --technique parallax --budget-ms 40

Prints the passes of a frame in order, with the images that each reads and writes, the culled
passes with reasons, and the memory that images share. The frame follows another frame.
--why prints instead the mirrors and lights that the picture requires, the captures and shadow
maps that are left out, with reasons, and the plan that suits the picture.)";

struct GraphOptions {
    CommonOptions common;
    TechniqueOption drawn;
    std::string technique; ///< technique or plan, checked
    std::optional<session::PlanFormat> format;
    bool why = false;
};

session::PlanFormat graph_format(const GraphOptions& options) {
    const session::PlanFormat asked = options.common.output_options.json
                                          ? session::PlanFormat::json
                                          : session::PlanFormat::text;
    const session::PlanFormat format = options.format.value_or(asked);
    check(!options.common.output_options.json || format == session::PlanFormat::json,
          Failure::usage, "--json and --format: stdout has room for one of them");
    check(!options.why || format != session::PlanFormat::dot, Failure::usage,
          "--why: wanted --format text or json, found dot");
    return format;
}

/// Returns the unit costs of the device that draws, or the default ones if the machine has none.
require::DeviceUnitCosts find_unit_costs(const DeviceOptions& options) {
    const session::EngineOptions opened = engine_options(options);
    const auto warn = [](const session::DeviceInfo& device) {
        if (!device.warning.empty()) print_warning(device.warning);
    };
    if (!options.name.empty()) {
        const session::Engine engine(opened);
        warn(engine.device());
        return session::Access::unit_costs(engine);
    }
    try {
        if (std::vector<session::DeviceInfo> list = session::devices(); !list.empty()) {
            const require::DeviceUnitCosts costs = session::choose_unit_costs(opened.calibrations,
                                                                              list.front());
            warn(list.front());
            return costs;
        }
    } catch (const NoDevice&) {
    }
    require::DeviceUnitCosts costs;
    costs.note = costs.costs.file + ", because this machine has no device";
    return costs;
}

void print_culling_report(const session::Request& request, session::PlanFormat format,
                          const require::DeviceUnitCosts& costs,
                          const std::optional<session::CaptureBudget>& capture_budget) {
    print_result(format == session::PlanFormat::json
                     ? session::culling_to_json(request, costs, capture_budget)
                     : session::culling_to_text(request, costs, capture_budget));
}

int run_graph(const GraphOptions& options) {
    const session::PlanFormat format = graph_format(options);
    check(!options.common.both_models, Failure::usage,
          "--model both: wanted everything or required, of which a plan has one");
    const bool is_limited = options.common.budget_ms > 0;
    check_budget_option(options.common);
    check(!is_limited || options.why, Failure::usage,
          "--budget-ms: wanted --why, since the plan is that of a frame at rest");
    session::Request request = make_request(options.common);
    request.techniques = {options.technique};
    check_distinct({kStdoutPath}, request.scene.files);
    if (options.why && !is_limited) {
        print_culling_report(request, format, find_unit_costs(options.common.device), std::nullopt);
        return 0;
    }
    session::Engine engine(engine_options(options.common.device));
    print_device(engine, options.common.output_options);
    if (options.why) {
        request.model = session::RenderedWork::required;
        print_culling_report(request, format, session::Access::unit_costs(engine),
                             session::measure_capture_budget(engine, request));
        return 0;
    }
    session::Session session(engine, request.scene);
    std::string plan = session::Access::format_plan(session, request, format);
    if (!plan.ends_with('\n')) plan += '\n';
    print_result(plan);
    if (options.common.device.validate) engine.check_validation();
    return 0;
}

} // namespace

void add_graph_verb(CommandLine& program) {
    const auto options = std::make_shared<GraphOptions>();
    Verb& verb = program.add_verb("graph", "print the passes of a technique's frame");
    verb.examples(kGraphExamples);
    add_technique_options(verb, options->drawn);
    verb.option("--format", "F", "output format: text, dot or json (text)",
                [options](const std::string& text) {
                    constexpr session::PlanFormat kGraphPlanFormats[] = {session::PlanFormat::text,
                                                                         session::PlanFormat::dot,
                                                                         session::PlanFormat::json};
                    options->format =
                        kGraphPlanFormats[parse_choice("--format", text, {"text", "dot", "json"})];
                });
    verb.flag("--why",
              "print what the picture requires and what is left out, with reasons, instead of the "
              "frame's passes; needs no device, except with --budget-ms",
              options->why);
    add_budget_option(verb, options->common);
    add_common_options(verb, options->common);
    verb.action([options] {
        scene::check_exists(options->common.scene);
        const bool is_given = !options->drawn.technique.empty() || !options->drawn.plan.empty();
        if (is_given || !options->why || options->common.budget_ms > 0)
            options->technique = check_choice(options->drawn, "graph");
        return run_graph(*options);
    });
}

} // namespace catoptric::cli
