#include "baseline.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "output.hpp"
#include "parse.hpp"

#include <algorithm>

namespace catoptric::cli {

void add_baseline_options(Verb& verb, BaselineOptions& options) {
    verb.option(
        "--baseline", "FILE",
        "report.json of an earlier run: say which rows err more or take longer now; exit code "
        "1 if any does",
        options.baseline);
    verb.option("--max-flip-rise", "S",
                "largest rise of FLIP, as a share of the earlier FLIP (0.02)",
                [&options](const std::string& text) {
                    options.limits.max_flip_rise = parse_real("--max-flip-rise", text, 0, 1e6);
                });
    verb.option("--max-time-ratio", "R",
                "largest time of a row or pass, divided by the earlier time (1.1)",
                [&options](const std::string& text) {
                    options.limits.max_time_ratio = parse_real("--max-time-ratio", text, 1, 1e6);
                });
    verb.option("--summary", "FILE", "Markdown file for the verdict on the baseline",
                options.summary);
    verb.option("--junit", "FILE", "JUnit XML file for the verdict on the baseline", options.junit);
}

void check_baseline_options(const BaselineOptions& options) {
    const report::BaselineLimits usual;
    const bool has_others = !options.summary.empty() || !options.junit.empty() ||
                            options.limits.max_flip_rise != usual.max_flip_rise ||
                            options.limits.max_time_ratio != usual.max_time_ratio;
    check(
        !options.baseline.empty() || !has_others, Failure::usage,
        "--max-flip-rise, --max-time-ratio, --summary and --junit: wanted --baseline beside them");
    for (const std::string& file : {options.summary, options.junit})
        if (!file.empty()) check_output_file(file);
}

BaselineGate::BaselineGate(const BaselineOptions& options) : options_(options) {
    if (options.baseline.empty()) return;
    json_ = read_file(options.baseline);
    check_json(options.baseline, json_);
}

void BaselineGate::check_scene(const report::Comparison& comparison) const {
    if (json_.empty()) return;
    report::check_baseline(comparison, json_, options_.baseline);
}

void BaselineGate::judge(const report::Comparison& comparison) {
    if (json_.empty()) return;
    const std::vector<report::BaselineFinding> findings = report::judge_comparison(
        comparison, json_, options_.baseline, options_.limits);
    text_ += comparison.scene.name + "\n" + report::format_findings(findings);
    summary_ += (summary_.empty() ? "" : "\n") +
                report::to_markdown(findings, comparison.scene.name);
    junit_ += report::to_junit(findings, comparison.scene.name);
    passes_ = passes_ && std::ranges::none_of(findings, report::is_failure);
}

std::string BaselineGate::finish() {
    if (!options_.summary.empty()) write_file(options_.summary, summary_);
    if (!options_.junit.empty())
        write_file(options_.junit, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n" +
                                       junit_ + "</testsuites>\n");
    return text_;
}

} // namespace catoptric::cli
