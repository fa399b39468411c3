#include "report/plot.hpp"

#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/rows.hpp"
#include "report/html.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace catoptric::report {

namespace {

/// Approximate letter width and line height of an 11 px label, pixels.
constexpr double kLabelLetterWidth = 6.6, kTextLineHeight = 13;

/// Maps the logarithm of a value to pixels.
struct LogScale {
    double low, high; ///< logarithms to base 10
    double from, to;  ///< pixels
    double operator()(double value) const {
        return from + (std::log10(value) - low) / (high - low) * (to - from);
    }
};

struct AxisTick {
    double value, at; ///< `at`: place in pixels
};

/// Edges of a chart with room for its axes, in pixels. Values of 0 lie in a lane from `lane` to
/// `bottom`, below the other values.
struct ChartFrame {
    double width, height, left, right, top, lane, bottom;
    double tick_gap;  ///< between a number of the y axis and the axis
    double y_name_at; ///< x of the y axis's name
    double zero_lane_y() const { return (lane + bottom) / 2; }
    /// Returns the lane and the axes with grid, numbers and names.
    std::string axes(const std::vector<AxisTick>& x_ticks, const std::vector<AxisTick>& y_ticks,
                     const std::string& x_name, const std::string& y_name) const;
};

/// Returns a scale that covers all values, which are positive, with a margin. A single value gets
/// one decade.
LogScale make_log_scale(const std::vector<double>& values, double from, double to) {
    if (values.empty()) return {-3, 0, from, to};
    const auto [least, most] = std::ranges::minmax(values);
    const double low = std::log10(least), high = std::log10(most);
    const double air = high - low < 0.5 ? 0.5 - (high - low) / 2 : 0.08 * (high - low);
    return {low - air, high + air, from, to};
}

/// Returns 1, 2 and 5 times the powers of ten inside the scale.
std::vector<double> tick_values(const LogScale& scale) {
    std::vector<double> values;
    for (int decade = static_cast<int>(std::floor(scale.low)); decade <= scale.high; ++decade)
        for (const double step : {1.0, 2.0, 5.0}) {
            const double value = step * std::pow(10.0, decade);
            const double place = std::log10(value);
            if (place >= scale.low && place <= scale.high) values.push_back(value);
        }
    return values;
}

std::vector<AxisTick> make_ticks(const LogScale& scale, const std::vector<double>& values) {
    std::vector<AxisTick> list;
    for (const double value : values) list.push_back({value, scale(value)});
    return list;
}

std::string svg_grid_line(double x0, double y0, double x1, double y1) {
    return fmt::format(R"(<line class="grid" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                       x0, y0, x1, y1);
}

/// `anchor`: start, middle or end. `content` is not escaped.
std::string svg_text(double x, double y, const char* anchor, std::string_view content) {
    return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)", x, y, anchor,
                       content);
}

std::string ChartFrame::axes(const std::vector<AxisTick>& x_ticks,
                             const std::vector<AxisTick>& y_ticks, const std::string& x_name,
                             const std::string& y_name) const {
    std::string svg = fmt::format(R"(<rect class="lane" x="{}" y="{}" width="{}" height="{}"/>)",
                                  left, lane, right - left, bottom - lane);
    for (const auto& [value, x] : x_ticks)
        svg += svg_grid_line(x, top, x, bottom) +
               svg_text(x, bottom + 16, "middle", fmt::format("{:g}", value));
    for (const auto& [value, y] : y_ticks)
        svg += svg_grid_line(left, y, right, y) +
               svg_text(left - tick_gap, y + 4, "end", fmt::format("{:g}", value));
    return svg + svg_text(left - tick_gap, zero_lane_y() + 4, "end", "0") +
           svg_text((left + right) / 2, bottom + 38, "middle", escape_html(x_name)) +
           fmt::format("<g transform=\"translate({} {}) rotate(-90)\">", y_name_at,
                       (top + lane) / 2) +
           svg_text(0, 0, "middle", escape_html(y_name)) + "</g>";
}

// width, height, left, right, top, lane, bottom, tick_gap, y_name_at
constexpr ChartFrame kPlotFrame{860, 470, 64, 836, 16, 380, 424, 8, 14};

struct PlotPoint {
    double x, y;
    double low, high; ///< ends of the time's interval, clamped to the axes
    const Row* row;
    bool front;
};

struct LabelBox {
    double x0, y0, x1, y1;
    bool intersects_box(const LabelBox& other) const {
        return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
};

bool has_point(const Row& row) { return has_time(row) && std::isfinite(row.error.flip); }

/// Returns the least error of all marks for each time, as a staircase. It includes the marks of
/// rows that are beaten by a row with equal error, so no mark lies left of it and below.
std::string svg_front(std::vector<PlotPoint> points) {
    std::ranges::stable_sort(points, {}, &PlotPoint::x);
    if (points.empty()) return "";
    double lowest = kPlotFrame.top;
    std::string path = fmt::format("M{:.1f} {:.1f}", points[0].x, lowest);
    for (const PlotPoint& point : points) {
        if (point.y <= lowest) continue;
        lowest = point.y;
        path += fmt::format("H{:.1f}V{:.1f}", point.x, point.y);
    }
    return R"(<path class="step" d=")" + path + fmt::format("H{:.1f}", kPlotFrame.right) + "\"/>";
}

/// Returns a line through all rows that differ only in the value of one knob.
std::string svg_knob_curves(const Comparison& comparison, const std::vector<PlotPoint>& points) {
    std::map<std::size_t, const PlotPoint*> places;
    std::vector<std::size_t> rows;
    for (const PlotPoint& point : points) {
        rows.push_back(static_cast<std::size_t>(point.row - comparison.rows.data()));
        places[rows.back()] = &point;
    }
    std::string svg;
    for (const std::vector<std::size_t>& curve : knob_curves(comparison, rows)) {
        std::string path;
        for (const std::size_t row : curve)
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", places[row]->x,
                                places[row]->y);
        svg += R"(<path class="curve" d=")" + path + "\"/>";
    }
    return svg;
}

/// Returns the interval of a row's time as a line.
std::string svg_interval(const PlotPoint& point) {
    if (!point.row->time_ms().ci95.is_known()) return "";
    return fmt::format(R"(<path class="interval" d="M{:.1f} {:.1f}H{:.1f}"/>)", point.low, point.y,
                       point.high);
}

/// Returns a row's mark: a square for ray tracing, otherwise a disc. Hovering shows the row's
/// values.
std::string svg_mark(const PlotPoint& point) {
    std::string kind = point.front ? "mark front" : "mark";
    if (measure::is_below_noise(point.row->error)) kind += " hidden";
    const std::string title = fmt::format(
        "<title>{}: {} ms, FLIP {}</title>", escape_html(point.row->label),
        format_ms(point.row->time_ms().median), format_flip(point.row->error));
    if (measure::is_ray_traced(*point.row))
        return fmt::format(
            R"(<rect class="{}" x="{:.1f}" y="{:.1f}" width="9" height="9">{}</rect>)", kind,
            point.x - 4.5, point.y - 4.5, title);
    return fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="5">{}</circle>)", kind,
                       point.x, point.y, title);
}

/// Returns the first of several places around the point where the label overlaps no earlier label,
/// or the last place. Points on the front try the left side first, because no stairs lie there.
LabelBox choose_label_place(const PlotPoint& point, const std::vector<LabelBox>& taken) {
    const double width = kLabelLetterWidth * static_cast<double>(point.row->label.size());
    LabelBox box{};
    for (const double rise : {0.0, -1.0, 1.0, -2.0, 2.0, -3.0, 3.0, -4.0, 4.0})
        for (const bool first : {true, false}) {
            const double x = first != point.front ? point.x + 9 : point.x - 9 - width;
            const double y = point.y + rise * kTextLineHeight;
            box = {x, y - kTextLineHeight / 2, x + width, y + kTextLineHeight / 2};
            const bool inside = box.x0 >= kPlotFrame.left && box.x1 <= kPlotFrame.right &&
                                box.y0 >= kPlotFrame.top && box.y1 <= kPlotFrame.bottom;
            if (inside && std::ranges::none_of(taken, [&](const LabelBox& other) {
                    return box.intersects_box(other);
                }))
                return box;
        }
    return box;
}

/// Returns a line at the FLIP between the halves of a reference with noise, with its name. Errors
/// up to this line are below the noise.
std::string svg_noise_floor(const Comparison& comparison, const LogScale& y) {
    if (!comparison.noise || !(comparison.noise->flip_floor > 0)) return "";
    const double at = y(comparison.noise->flip_floor);
    return fmt::format(R"(<path class="noise" d="M{:.1f} {:.1f}H{:.1f}"/>)", kPlotFrame.left, at,
                       kPlotFrame.right) +
           svg_text(kPlotFrame.right - 4, at - 4, "end", kBelowNoise);
}

std::string svg_labels(const std::vector<PlotPoint>& points) {
    std::vector<LabelBox> taken;
    for (const PlotPoint& point : points)
        taken.push_back({point.x - 6, point.y - 6, point.x + 6, point.y + 6});
    std::string svg;
    for (const PlotPoint& point : points) {
        const LabelBox box = choose_label_place(point, taken);
        taken.push_back(box);
        svg += fmt::format(R"(<text class="label" x="{:.1f}" y="{:.1f}">{}</text>)", box.x0,
                           box.y1 - 3, escape_html(point.row->label));
    }
    return svg;
}

} // namespace

bool has_time(const Row& row) { return measure::is_rankable(row) && row.time_ms().median > 0; }

std::string time_axis_name(const Comparison& comparison) {
    const std::string_view time = measure::judged_time(comparison);
    return time == "cpu_ms"     ? "Processor time of a frame, median, ms"
           : time == "frame_ms" ? "Time of a frame, host and GPU, median, ms"
                                : "GPU time of a frame, median, ms";
}

std::vector<std::vector<std::size_t>> knob_curves(const Comparison& comparison,
                                                  const std::vector<std::size_t>& rows) {
    std::map<std::string, std::map<double, std::size_t>> curves; // by all but the knob
    for (const std::size_t index : rows) {
        const Row& row = comparison.rows[index];
        for (const Setting& varied : row.settings) {
            if (!varied.number) continue;
            std::string others = row.technique + ' ' + row.model + ' ' + varied.name;
            for (const Setting& setting : row.settings)
                if (setting.name != varied.name) others += ' ' + setting.name + '=' + setting.text;
            curves[others].emplace(*varied.number, index);
        }
    }
    std::vector<std::vector<std::size_t>> list;
    for (const auto& [others, curve] : curves) {
        if (curve.size() < 3) continue;
        std::vector<std::size_t>& indices = list.emplace_back();
        for (const auto& [value, index] : curve) indices.push_back(index);
    }
    return list;
}

std::string comparison_plot(const Comparison& comparison) {
    std::vector<double> times, errors;
    for (const Row& row : comparison.rows) {
        if (!has_point(row)) continue;
        times.push_back(row.time_ms().median);
        if (row.error.flip > 0) errors.push_back(row.error.flip);
    }
    if (times.empty()) return "";
    if (comparison.noise && comparison.noise->flip_floor > 0)
        errors.push_back(comparison.noise->flip_floor);
    const LogScale x = make_log_scale(times, kPlotFrame.left, kPlotFrame.right);
    const LogScale y = make_log_scale(errors, kPlotFrame.lane - 8, kPlotFrame.top);
    std::vector<PlotPoint> points;
    for (const Row& row : comparison.rows) {
        if (!has_point(row)) continue;
        const measure::Interval& ci95 = row.time_ms().ci95;
        points.push_back({x(row.time_ms().median),
                          row.error.flip > 0 ? y(row.error.flip) : kPlotFrame.zero_lane_y(),
                          std::max(x(ci95.low), kPlotFrame.left),
                          std::min(x(ci95.high), kPlotFrame.right), &row,
                          measure::is_on_front(comparison, row)});
    }
    std::string svg = fmt::format(
        R"(<svg viewBox="0 0 {} {}" role="img" aria-label="Scatter plot of time )"
        R"(against FLIP; the figures are in the table of every row">)",
        kPlotFrame.width, kPlotFrame.height);
    svg += kPlotFrame.axes(make_ticks(x, tick_values(x)),
                           make_ticks(y, errors.empty() ? std::vector<double>() : tick_values(y)),
                           time_axis_name(comparison), "FLIP over the mirrors") +
           svg_noise_floor(comparison, y) + svg_front(points) + svg_knob_curves(comparison, points);
    for (const PlotPoint& point : points) svg += svg_interval(point);
    for (const PlotPoint& point : points) svg += svg_mark(point);
    return svg + svg_labels(points) + "</svg>";
}

} // namespace catoptric::report
