#include "report/text.hpp"
#include "core/text.hpp"
#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/lag.hpp"
#include "measure/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

/// Returns the decimals that give three significant digits, at most four.
int choose_decimals(double value) {
    if (!(value > 0)) return 0;
    return std::clamp(2 - static_cast<int>(std::floor(std::log10(value))), 0, 4);
}

/// Spreadsheet programs execute a cell that begins with one of these characters. Numbers may begin
/// with them.
bool is_spreadsheet_formula(const std::string& text) {
    constexpr std::string_view kCsvNumberCharacters = "0123456789.eE+- ";
    return text.find_first_of("=+-@") == 0 &&
           text.find_first_not_of(kCsvNumberCharacters) != text.npos;
}

} // namespace

std::string escape_csv(const std::string& field) {
    std::string shown = escape(field, "\n");
    if (is_spreadsheet_formula(shown)) shown.insert(0, "'");
    if (shown.find_first_of("\",\n") == std::string::npos) return shown;
    std::string result = "\"";
    for (const char c : shown) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

std::string format_csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string format_fixed(double value, int decimals) {
    if (!std::isfinite(value)) return std::string(kEmptyCell);
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find_first_of("123456789") == std::string::npos && text.front() == '-')
        text.erase(0, 1); // avoids -0.0
    return text;
}

std::string format_error(double error) {
    if (error == 0) return "0";
    if (error < 0) return std::string(kBelowNoise);
    const bool tiny = std::abs(error) < 5e-5; // four decimals would read 0.0000
    return tiny ? fmt::format("{:.0e}", error) : format_fixed(error, 4);
}

std::string format_flip(const measure::Difference& error) {
    const std::string text = format_error(error.flip);
    return measure::is_below_noise(error) ? text + ", " + std::string(kBelowNoise) : text;
}

std::string format_ms(double ms) { return format_fixed(ms, choose_decimals(ms)); }

int ms_decimals(const Comparison& comparison) {
    double fastest = INFINITY;
    for (const Row& row : comparison.rows)
        if (row.time_ms().median > 0) fastest = std::min(fastest, row.time_ms().median);
    return std::isfinite(fastest) ? choose_decimals(fastest) : 1;
}

std::string describe_judged_time(const Comparison& comparison) {
    return measure::judged_time(comparison) == "cpu_ms" ? ", by processor time" : "";
}

std::string format_fps(double ms) {
    return ms > 0 ? format_fixed(1000 / ms, std::min(choose_decimals(1000 / ms), 2))
                  : std::string(kEmptyCell);
}

std::string format_mebibytes(std::uint64_t bytes) {
    return format_fixed(static_cast<double>(bytes) / (1024 * 1024), 1);
}

std::string image_path(const Comparison& comparison, const std::string& file) {
    return "images/" + comparison.images + file;
}

std::string format_settings(const Row& row) {
    std::vector<std::string> parts;
    for (const Setting& setting : row.settings) parts.push_back(setting.name + "=" + setting.text);
    return join_texts(parts, ", ");
}

std::string describe_incomplete_run(std::size_t rows, std::size_t asked,
                                    const std::optional<Error>& stopped) {
    return fmt::format("{} of {} rows: {}", rows, asked,
                       stopped ? stopped->what() : "the run had not ended when this was written");
}

std::string describe_unfinished_phase(const Comparison& comparison) {
    if (comparison.complete) return "";
    const bool in_lag = comparison.lag && !comparison.lag->complete;
    const bool has_all = comparison.rows.size() == comparison.asked;
    auto measured = static_cast<std::size_t>(comparison.rounds); // rounds that all rows have
    for (const Row& row : comparison.rows)
        if (measure::has_known_time(row) &&
            row.technique != "picture") // rows of files have no rounds
            measured = std::min(measured, row.gpu_ms.rounds.size());
    const bool in_rounds = has_all && measured < static_cast<std::size_t>(comparison.rounds);
    const bool in_views = has_all && !in_rounds &&
                          std::ranges::any_of(comparison.rows, [&](const Row& row) {
                              return (measure::has_known_time(row) || !row.views.empty()) &&
                                     row.views.size() < comparison.views.size();
                          });
    return (in_rounds ? fmt::format("; {} of {} rounds", measured, comparison.rounds) : "") +
           (in_views ? "; their errors over views were not measured to the end" : "") +
           (in_lag ? "; their lag was not measured to its end" : "");
}

std::string describe_incomplete_run(const Comparison& comparison) {
    if (comparison.complete) return "";
    return describe_incomplete_run(comparison.rows.size(), comparison.asked, comparison.stopped) +
           describe_unfinished_phase(comparison);
}

std::string join_texts(const std::vector<std::string>& parts, std::string_view between) {
    return fmt::format("{}", fmt::join(parts, between));
}

std::string join_labels(const std::vector<const Row*>& rows, std::string_view between) {
    std::vector<std::string> labels;
    for (const Row* row : rows) labels.push_back(row->label);
    return join_texts(labels, between);
}

std::string describe_worst_view(const Comparison& comparison, const measure::WorstView& worst) {
    const measure::View& view = comparison.views.at(worst.view);
    return fmt::format("view {} of {}: --camera {} --time {}", worst.view + 1,
                       comparison.views.size(), view.camera.name, view.time);
}

std::string lag_image_name(const std::string& image) { return "lag-" + image; }

std::string find_lag_image(const Comparison& comparison, const measure::LagRow& row) {
    const auto found = std::ranges::find(comparison.rows, row.label, &Row::label);
    return found == comparison.rows.end() ? "" : lag_image_name(found->image);
}

std::string worst_view_image(const std::string& image) { return "worst-" + image + ".png"; }

} // namespace catoptric::report
