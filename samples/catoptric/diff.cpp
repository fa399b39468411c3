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
    Manners manners;
    std::string a, b, mask;
    double exposure = 0;
    std::optional<double> most_flip, most_rmse;
};

void judge(DiffFacts& facts, const char* option, double value, std::optional<double> most) {
    if (!most) return;
    // NaN (no pixel to judge) exceeds every threshold.
    if (!(value <= *most))
        facts.over.push_back(
            fmt::format("{} {:.6g} is over --max-{} {:.6g}", option, value, option, *most));
}

DiffFacts compare_files(const DiffOptions& options) {
    const measure::FileDifference found = measure::difference_of_files(
        options.a, options.b, options.mask, options.exposure);
    DiffFacts facts{options.a,
                    options.b,
                    options.mask,
                    {found.width, found.height},
                    options.exposure,
                    std::string(found.is_of_bytes ? measure::kFlipOfBytes : measure::kFlipOfFloats),
                    found.difference,
                    found.a_mean,
                    found.b_mean,
                    found.a_clamped,
                    found.b_clamped,
                    {}};
    judge(facts, "flip", facts.difference.flip, options.most_flip);
    judge(facts, "rmse", facts.difference.rmse, options.most_rmse);
    if ((options.most_flip || options.most_rmse) && facts.difference.nonfinite > 0)
        facts.over.push_back(fmt::format("{} pixels are not finite", facts.difference.nonfinite));
    return facts;
}

std::string mean_text(const char* name, const measure::Mean& mean, const measure::Mean& clamped) {
    return fmt::format("mean {}  {:.6f} {:.6f} {:.6f}  clamped {:.6f} {:.6f} {:.6f}\n", name,
                       mean.rgb.x, mean.rgb.y, mean.rgb.z, clamped.rgb.x, clamped.rgb.y,
                       clamped.rgb.z);
}

std::string value_text(const measure::Value& value) {
    if (measure::is_nothing(value)) return "none";
    if (const auto* place = std::get_if<measure::PixelPosition>(&value))
        return fmt::format("({}, {})", place->x, place->y);
    const double number = std::get<double>(value);
    return number == std::trunc(number) ? fmt::format("{:.0f}", number)
                                        : fmt::format("{:.6f}", number);
}

std::string text_of(const DiffFacts& facts) {
    std::string text;
    for (const measure::Metric& quantity : measure::difference_metrics())
        text += fmt::format("{:<12}  {}{}{}\n", quantity.name,
                            value_text(measure::value_of(quantity, facts.difference)),
                            quantity.unit.empty() ? "" : " ", quantity.unit);
    return text + mean_text("A", facts.a_mean, facts.a_clamped) +
           mean_text("B", facts.b_mean, facts.b_clamped);
}

int run_diff(const DiffOptions& options) {
    const DiffFacts facts = compare_files(options);
    put(options.manners.json ? diff_json(facts) : text_of(facts));
    check(facts.over.empty(), Failure::threshold, join(facts.over));
    return 0;
}

} // namespace

void add_diff(CommandLine& program) {
    const auto options = std::make_shared<DiffOptions>();
    Verb& verb = program.add("diff", "compare two pictures");
    verb.examples(kDiffExamples);
    verb.argument("A", "picture, .exr, .hdr or .png", options->a, Verb::Need::required);
    verb.argument("B", "picture of the same size", options->b, Verb::Need::required);
    verb.option("--mask", "M", "PNG of the same size; only pixels that are not black count",
                options->mask);
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
    add_manners(verb, options->manners);
    verb.does([options] { return run_diff(*options); });
}

} // namespace catoptric::cli
