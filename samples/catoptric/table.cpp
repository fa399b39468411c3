#include "table.hpp"

#include "core/text.hpp"
#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/row_notes.hpp"
#include "report/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::cli {

namespace {

std::string format_milliseconds(double ms) {
    return std::isfinite(ms) ? fmt::format("{:.3f}", ms) : "-";
}

/// Returns a dash if the number is not finite.
std::string format_five_decimals(double value) {
    return std::isfinite(value) ? fmt::format("{:.5f}", value) : "-";
}

/// Returns an rmse, or words if its estimate is negative.
std::string format_rmse(double rmse) {
    return rmse < 0 ? "below the noise" : format_five_decimals(rmse);
}

std::string format_flip(const measure::Difference& error) {
    return format_five_decimals(error.flip) +
           (measure::is_below_noise(error) ? " below the noise" : "");
}

/// Returns a line of text about the noise of the reference; empty if the reference has no noise.
std::string describe_noise(const report::Comparison& comparison) {
    if (!comparison.noise) return "";
    return fmt::format("noise: two halves of {} frames, FLIP {} between them; smaller differences "
                       "tie\n",
                       comparison.noise->frames,
                       format_five_decimals(comparison.noise->flip_floor));
}

std::string format_percent(double share) {
    return std::isfinite(share) ? fmt::format("{:.2f}", 100 * share) : "-";
}

std::string format_time_spread(const measure::SampleSummary& ms) {
    if (!ms.ci95.is_known()) return "-";
    return fmt::format("[{} - {}]", format_milliseconds(ms.ci95.low),
                       format_milliseconds(ms.ci95.high));
}

} // namespace

std::string align_columns(const std::vector<std::vector<std::string>>& rows,
                          std::size_t text_from) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += i == 0           ? fmt::format("{:<{}}", row[i], widths[i])
                    : i >= text_from ? fmt::format("  {:<{}}", row[i], widths[i])
                                     : fmt::format("  {:>{}}", row[i], widths[i]);
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string compare_table(const report::Comparison& comparison) {
    std::vector<std::vector<std::string>> rows{
        {"technique", "R", measure::judged_time(comparison) == "cpu_ms" ? "cpu ms" : "ms", "[95 %]",
         "place", "flip", "off %", "mae", "rmse", "mean"}};
    const bool has_notes = std::ranges::any_of(comparison.rows, [&](const report::Row& row) {
        return !measure::row_notes(comparison, row).empty();
    });
    if (has_notes) rows.front().emplace_back("not as asked");
    const std::size_t notes_at = rows.front().size() - (has_notes ? 1 : 0);
    for (const report::Row& row : comparison.rows) {
        const measure::RankRange places = measure::find_rank_range(comparison, row);
        rows.push_back(
            {row.label, std::to_string(row.scene_passes), format_milliseconds(row.time_ms().median),
             format_time_spread(row.time_ms()),
             places.first == 0             ? "-"
             : places.first == places.last ? std::to_string(places.first)
                                           : fmt::format("{}-{}", places.first, places.last),
             format_flip(row.error), format_percent(row.error.off),
             format_five_decimals(row.error.mae), format_rmse(row.error.rmse),
             format_five_decimals(row.mean_clamped.all)});
        if (has_notes)
            rows.back().push_back(
                fmt::format("{}", fmt::join(measure::row_notes(comparison, row), "; ")));
    }
    const std::size_t noisy = measure::find_noisy_rows(comparison).size();
    const std::string caution =
        noisy == 0 ? ""
                   : fmt::format("noisy: {} of {} rows had to wait for a processor, others were at "
                                 "work beside; their {}times are not to be trusted\n",
                                 noisy, comparison.rows.size(),
                                 measure::judged_time(comparison) == "cpu_ms" ? "device " : "");
    return caution +
           fmt::format("{} {}x{}, {} frames in {} rounds after {}, {}; errors on mirrors, against "
                       "{}\n",
                       escape(comparison.scene.name), comparison.width, comparison.height,
                       comparison.frames, comparison.rounds, comparison.warmup,
                       comparison.device.name, comparison.reference_label) +
           describe_noise(comparison) + align_columns(rows, notes_at);
}

} // namespace catoptric::cli
