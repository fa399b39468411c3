#include "report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report::svg {

double Scale::operator()(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
}

Scale log_scale(const std::vector<double>& values, double from, double to) {
    if (values.empty()) return {-3, 0, from, to};
    const auto [least, most] = std::ranges::minmax(values);
    const double low = std::log10(least), high = std::log10(most);
    const double air = high - low < 0.5 ? 0.5 - (high - low) / 2 : 0.08 * (high - low);
    return {low - air, high + air, from, to};
}

std::vector<double> ticks(const Scale& scale) {
    std::vector<double> values;
    for (int decade = static_cast<int>(std::floor(scale.low)); decade <= scale.high; ++decade)
        for (const double step : {1.0, 2.0, 5.0}) {
            const double value = step * std::pow(10.0, decade);
            const double place = std::log10(value);
            if (place >= scale.low && place <= scale.high) values.push_back(value);
        }
    return values;
}

std::string grid_line(double x0, double y0, double x1, double y1) {
    return fmt::format(R"(<line class="grid" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                       x0, y0, x1, y1);
}

std::string text(double x, double y, const char* anchor, std::string_view content) {
    return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)", x, y, anchor,
                       content);
}

} // namespace catoptric::report::svg
