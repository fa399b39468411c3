// catoptric diff: measures the difference of two pictures.
#include "measure/picture.hpp"

#include "core/error.hpp"
#include "json.hpp"
#include "measure/file_difference.hpp"
#include "measure/flip.hpp"
#include "measure/metric.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

namespace catoptric::cli {

namespace {

constexpr const char* kDiffExamples = R"(Examples:
  catoptric diff a.exr b.exr
  catoptric diff a.png b.png --mask mirrors.png --json
  catoptric diff new.exr golden.exr --max-flip 0.01 --max-rmse 0.001

All figures use linear RGB times 2^STOPS, clamped to [0,1]. FLIP compares the pictures as displayed, at 67 pixels
per degree; if one of them is a PNG, both are rounded to 8 bits.

Exit code 1 if a figure is over its threshold, or if a threshold is given and a pixel is not finite.)";

struct DiffOptions {
    OutputOptions output_options;
    std::string a, b, mask, layer;
    double exposure = 0;
    std::optional<double> most_flip, most_rmse;
};

void check_threshold(DiffFacts& facts, const char* option, double value,
                     std::optional<double> most) {
    if (!most) return;
    // NaN (no pixel to judge) exceeds every threshold.
    if (!(value <= *most))
        facts.over.push_back(
            fmt::format("{} {:.6g} is over --max-{} {:.6g}", option, value, option, *most));
}

DiffFacts compare_files(const DiffOptions& options) {
    const std::string layer = options.layer.empty() ? "" : ":" + options.layer;
    const measure::FileDifference found = measure::compare_files(
        options.a + layer, options.b + layer, options.mask, options.exposure);
    DiffFacts facts{
        options.a,
        options.b,
        options.mask,
        {found.width, found.height},
        options.exposure,
        std::string(found.is_of_bytes ? measure::kFlipSourceBytes : measure::kFlipSourceFloats),
        found.difference,
        found.a_mean,
        found.b_mean,
        found.a_clamped,
        found.b_clamped,
        {}};
    check_threshold(facts, "flip", facts.difference.flip, options.most_flip);
    check_threshold(facts, "rmse", facts.difference.rmse, options.most_rmse);
    if ((options.most_flip || options.most_rmse) && facts.difference.nonfinite > 0)
        facts.over.push_back(fmt::format("{} pixels are not finite", facts.difference.nonfinite));
    return facts;
}

std::string format_mean(const char* name, const measure::Mean& mean, const measure::Mean& clamped) {
    return fmt::format("mean {}  {:.6f} {:.6f} {:.6f}  clamped {:.6f} {:.6f} {:.6f}\n", name,
                       mean.rgb.x, mean.rgb.y, mean.rgb.z, clamped.rgb.x, clamped.rgb.y,
                       clamped.rgb.z);
}

std::string format_metric_value(const measure::MetricValue& value) {
    if (measure::is_missing(value)) return "none";
    if (const auto* place = std::get_if<measure::PixelPosition>(&value))
        return fmt::format("({}, {})", place->x, place->y);
    const double number = std::get<double>(value);
    return number == std::trunc(number) ? fmt::format("{:.0f}", number)
                                        : fmt::format("{:.6f}", number);
}

std::string format_facts(const DiffFacts& facts) {
    std::string text;
    for (const measure::Metric& metric : measure::difference_metrics())
        text += fmt::format("{:<12}  {}{}{}\n", metric.name,
                            format_metric_value(measure::metric_value(metric, facts.difference)),
                            metric.unit.empty() ? "" : " ", metric.unit);
    return text + format_mean("A", facts.a_mean, facts.a_clamped) +
           format_mean("B", facts.b_mean, facts.b_clamped);
}

int run_diff(const DiffOptions& options) {
    const DiffFacts facts = compare_files(options);
    print_result(options.output_options.json ? diff_json(facts) : format_facts(facts));
    check(facts.over.empty(), Failure::threshold, join_with_commas(facts.over));
    return 0;
}

} // namespace

void add_diff_verb(CommandLine& program) {
    const auto options = std::make_shared<DiffOptions>();
    Verb& verb = program.add_verb("diff", "compare two pictures");
    verb.examples(kDiffExamples);
    verb.argument("A", "picture, .exr, .hdr or .png", options->a, Verb::Need::required);
    verb.argument("B", "picture of the same size", options->b, Verb::Need::required);
    verb.option("--mask", "M", "PNG of the same size; only pixels that are not black count",
                options->mask);
    verb.option(
        "--layer", "NAME",
        "layer of both pictures, if they have several; A:NAME for one of them (OpenEXR: the "
        "channels R, G, B, or those of the only layer that has them)",
        options->layer);
    verb.option("--max-flip", "X", "largest FLIP allowed; exit code 1 above it",
                [options](const std::string& text) {
                    options->most_flip = parse_real("--max-flip", text, 0);
                });
    verb.option("--max-rmse", "X", "largest rmse allowed; exit code 1 above it",
                [options](const std::string& text) {
                    options->most_rmse = parse_real("--max-rmse", text, 0);
                });
    verb.option("--exposure", "STOPS",
                "exposure: light is multiplied by 2^STOPS before the comparison (0)",
                [options](const std::string& text) { options->exposure = parse_stops(text); });
    add_output_options(verb, options->output_options);
    verb.action([options] { return run_diff(*options); });
}

} // namespace catoptric::cli
