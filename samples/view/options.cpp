#include "options.hpp"

#include "catoptric/output_checks.hpp"
#include "catoptric/parse.hpp"
#include "core/error.hpp"
#include "session/engine.hpp"

#include <memory>

namespace catoptric::view {

namespace {

constexpr const char* kViewExamples = R"(Examples:
  catoptric-view
  catoptric-view gallery --technique reuse --animate
  catoptric-view scene.glb --plan "1=planar *=hybrid"
  catoptric-view scene.glb --audit plan.json --animate
  catoptric-view --frames 20 --screenshot last.png

F1 in the window lists the keys. --frames N ends the program after N frames. Frame k equals frame k of
'catoptric render' with --frames N --warmup 0. --screenshot writes the last frame without controls, with the same
bytes.)";

void check_screenshot_options(const ViewOptions& options) {
    if (options.screenshot.empty()) return;
    check(options.common.frames.has_value(), Failure::usage,
          "--screenshot is of the last frame: wanted --frames N, found none");
    check(options.screenshot.ends_with(".exr") || options.screenshot.ends_with(".png"),
          Failure::usage, "--screenshot: wanted a name ending in .exr or .png, found '",
          options.screenshot, "'");
    cli::check_output_file(options.screenshot);
}

/// Returns the technique or plan that the window shows first.
std::string choose_first_technique(const ViewOptions& options) {
    cli::TechniqueOption drawn = options.drawn;
    const bool is_given = !drawn.technique.empty() || !drawn.plan.empty();
    if (!options.audit.empty()) {
        check(!is_given, Failure::usage,
              "--audit: its file has the plan: wanted no --technique and no --plan beside it");
        return study::PlanAudit(options.audit).plan();
    }
    if (!is_given) drawn.technique = "secant";
    return check_choice(drawn, "catoptric-view");
}

void add_audit_options(cli::Verb& verb, ViewOptions& options) {
    verb.option("--audit", "FILE",
                "run the plan of this file of 'catoptric choose', compare drawn frames with ray "
                "tracing, and change to a surer plan if too many break the limit",
                options.audit);
    verb.option("--audit-every", "N", "audit at most one frame of N (60)",
                [&options](const std::string& text) {
                    options.audit_every = static_cast<int>(
                        cli::parse_integer("--audit-every", text, 1, 1'000'000));
                });
    verb.option("--audit-percent", "P",
                "limit of the audits' time, in percent of the frames' time (5)",
                [&options](const std::string& text) {
                    options.audit_percent = cli::parse_real("--audit-percent", text, .01, 1e6);
                });
}

} // namespace

std::function<int()> parse_view_command(const std::vector<std::string>& words,
                                        const std::function<int(const ViewOptions&)>& run) {
    auto program = std::make_shared<cli::CommandLine>(
        "catoptric-view", "Shows a scene in a window, drawn by any technique.",
        "catoptric-view " + session::version() + " (" + session::commit() + ")", kViewExamples);
    const auto options = std::make_shared<ViewOptions>();
    options->words = words;
    cli::Verb& verb = program->only_verb();
    add_technique_options(verb, options->drawn);
    verb.option("--screenshot", "OUT",
                "file OUT.png or OUT.exr for the picture of the last of --frames, without controls",
                options->screenshot);
    add_audit_options(verb, *options);
    add_budget_option(verb, options->common);
    add_common_options(verb, options->common);
    verb.action([options, run] {
        options->technique = choose_first_technique(*options);
        check(!options->common.both_models, Failure::usage,
              "--model both: wanted everything or required, of which a picture has one");
        check_budget_option(options->common);
        check_screenshot_options(*options);
        return run(*options);
    });
    const std::function<int()> work = program->parse(words);
    return [program, work] { return work(); };
}

cli::ResolvedRequest resolve_view_request(const ViewOptions& options) {
    cli::ResolvedRequest asked = resolve_request(options.common);
    session::Request& request = asked.request;
    request.techniques = {options.technique};
    request.model = options.common.model.value_or(session::RenderedWork::required);
    if (!options.screenshot.empty()) cli::check_distinct({options.screenshot}, request.scene.files);
    return asked;
}

} // namespace catoptric::view
