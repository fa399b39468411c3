#include "report/text.hpp"
#include "measure/lag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

/// Returns the decimals that give three significant digits, at most four.
int decimals_for(double value) {
    if (!(value > 0)) return 0;
    return std::clamp(2 - static_cast<int>(std::floor(std::log10(value))), 0, 4);
}

} // namespace

std::string fixed(double value, int decimals) {
    if (!std::isfinite(value)) return std::string(kNothing);
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find_first_of("123456789") == std::string::npos && text.front() == '-')
        text.erase(0, 1); // avoids -0.0
    return text;
}

std::string error_text(double error) {
    if (error == 0) return "0";
    const bool tiny = std::abs(error) < 5e-5; // four decimals would read 0.0000
    return tiny ? fmt::format("{:.0e}", error) : fixed(error, 4);
}

std::string ms_text(double ms) { return fixed(ms, decimals_for(ms)); }

int ms_decimals(const Comparison& comparison) {
    double fastest = INFINITY;
    for (const Row& row : comparison.rows)
        if (row.time_ms().median > 0) fastest = std::min(fastest, row.time_ms().median);
    return std::isfinite(fastest) ? decimals_for(fastest) : 1;
}

std::string fps_text(double ms) {
    return ms > 0 ? fixed(1000 / ms, std::min(decimals_for(1000 / ms), 2)) : std::string(kNothing);
}

std::string mebibytes(std::uint64_t bytes) {
    return fixed(static_cast<double>(bytes) / (1024 * 1024), 1);
}

std::string image_path(const Comparison& comparison, const std::string& file) {
    return "images/" + comparison.images + file;
}

std::string settings_text(const Row& row) {
    std::vector<std::string> parts;
    for (const Setting& setting : row.settings) parts.push_back(setting.name + "=" + setting.text);
    return joined(parts, ", ");
}

std::string incomplete_text(std::size_t rows, std::size_t asked,
                            const std::optional<Error>& stopped) {
    return fmt::format("{} of {} rows: {}", rows, asked,
                       stopped ? stopped->what() : "the run had not ended when this was written");
}

std::string incomplete_text(const Comparison& comparison) {
    if (comparison.complete) return "";
    const bool in_lag = comparison.lag && !comparison.lag->complete;
    const bool has_all = comparison.rows.size() == comparison.asked;
    std::size_t measured = 0; // number of rounds that all rows have
    for (const Row& row : comparison.rows)
        if (&row == &comparison.rows.front() || row.gpu_ms.rounds.size() < measured)
            measured = row.gpu_ms.rounds.size();
    const bool in_rounds = has_all && measured < static_cast<std::size_t>(comparison.rounds);
    const bool in_views = has_all && !in_rounds &&
                          std::ranges::any_of(comparison.rows, [&](const Row& row) {
                              return row.views.size() < comparison.views.size();
                          });
    return incomplete_text(comparison.rows.size(), comparison.asked, comparison.stopped) +
           (in_rounds ? fmt::format("; {} of {} rounds", measured, comparison.rounds) : "") +
           (in_views ? "; their errors over views were not measured to the end" : "") +
           (in_lag ? "; their lag was not measured to its end" : "");
}

std::string joined(const std::vector<std::string>& parts, std::string_view between) {
    return fmt::format("{}", fmt::join(parts, between));
}

std::string labels_of(const std::vector<const Row*>& rows, std::string_view between) {
    std::vector<std::string> labels;
    for (const Row* row : rows) labels.push_back(row->label);
    return joined(labels, between);
}

std::string view_text(const Comparison& comparison, const measure::WorstView& worst) {
    const measure::View& view = comparison.views.at(worst.view);
    return fmt::format("view {} of {}: --camera {} --time {}", worst.view + 1,
                       comparison.views.size(), view.camera.name, view.time);
}

std::string worst_image(const std::string& image) { return "worst-" + image + ".png"; }

} // namespace catoptric::report
