#include "report/plot.hpp"

#include "measure/judge.hpp"
#include "measure/rows.hpp"
#include "report/html_text.hpp"
#include "report/svg.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

using svg::grid_line, svg::kLetter, svg::kLine, svg::Scale, svg::text, svg::ticks;

namespace {

constexpr double kWidth = 860, kHeight = 470;
// The lane holds error 0.
constexpr double kLeft = 64, kRight = 836, kTop = 16, kLane = 380, kBottom = 424;

struct Point {
    double x, y;
    double low, high; ///< ends of the time's interval, clamped to the axes
    const Row* row;
    bool front;
};

struct Box {
    double x0, y0, x1, y1;
    bool meets(const Box& other) const {
        return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
};

bool can_be_placed(const Row& row) {
    return row.time_ms().median > 0 && std::isfinite(row.error.flip);
}

/// Returns the axes. If `moves` is true, times include host work.
std::string axes(const Scale& x, const Scale& y, bool has_errors, bool moves) {
    constexpr double kMiddle = (kLane + kBottom) / 2;
    std::string svg = fmt::format(R"(<rect class="lane" x="{}" y="{}" width="{}" height="{}"/>)",
                                  kLeft, kLane, kRight - kLeft, kBottom - kLane);
    for (const double value : ticks(x))
        svg += grid_line(x(value), kTop, x(value), kBottom) +
               text(x(value), kBottom + 16, "middle", fmt::format("{:g}", value));
    for (const double value : has_errors ? ticks(y) : std::vector<double>())
        svg += grid_line(kLeft, y(value), kRight, y(value)) +
               text(kLeft - 8, y(value) + 4, "end", fmt::format("{:g}", value));
    svg += text(kLeft - 8, kMiddle + 4, "end", "0");
    svg += text((kLeft + kRight) / 2, kBottom + 38, "middle",
                moves ? "Time of a frame, host and GPU, median, ms"
                      : "GPU time of a frame, median, ms");
    svg += fmt::format("<g transform=\"translate(14 {}) rotate(-90)\">", (kTop + kLane) / 2);
    return svg + text(0, 0, "middle", "FLIP over the mirrors") + "</g>";
}

/// Returns the front as a staircase: the least error for each time.
std::string stairs(std::vector<Point> points) {
    std::erase_if(points, [](const Point& point) { return !point.front; });
    std::ranges::sort(
        points, [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y > b.y; });
    if (points.empty()) return "";
    std::string path = fmt::format("M{:.1f} {:.1f}", points[0].x, kTop);
    for (const Point& point : points) path += fmt::format("H{:.1f}V{:.1f}", point.x, point.y);
    return R"(<path class="step" d=")" + path + fmt::format("H{:.1f}", kRight) + "\"/>";
}

/// Returns the interval of a row's time as a line.
std::string interval(const Point& point) {
    if (!point.row->time_ms().ci95.is_known()) return "";
    return fmt::format(R"(<path class="interval" d="M{:.1f} {:.1f}H{:.1f}"/>)", point.low, point.y,
                       point.high);
}

/// Returns a row's mark: a square for ray tracing, otherwise a disc. Hovering shows the row's
/// values.
std::string mark(const Point& point) {
    const char* kind = point.front ? "mark front" : "mark";
    const std::string title = fmt::format(
        "<title>{}: {} ms, FLIP {}</title>", html_escaped(point.row->label),
        ms_text(point.row->time_ms().median), error_text(point.row->error.flip));
    if (measure::is_ray_traced(*point.row))
        return fmt::format(
            R"(<rect class="{}" x="{:.1f}" y="{:.1f}" width="9" height="9">{}</rect>)", kind,
            point.x - 4.5, point.y - 4.5, title);
    return fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="5">{}</circle>)", kind,
                       point.x, point.y, title);
}

/// Returns the first of several places around the point where the label overlaps no earlier label,
/// or the last place. Points on the front try the left side first, because no stairs lie there.
Box place_label(const Point& point, const std::vector<Box>& taken) {
    const double width = kLetter * static_cast<double>(point.row->label.size());
    Box box{};
    for (const double rise : {0.0, -1.0, 1.0, -2.0, 2.0, -3.0, 3.0, -4.0, 4.0})
        for (const bool first : {true, false}) {
            const double x = first != point.front ? point.x + 9 : point.x - 9 - width;
            const double y = point.y + rise * kLine;
            box = {x, y - kLine / 2, x + width, y + kLine / 2};
            const bool inside = box.x0 >= kLeft && box.x1 <= kRight && box.y0 >= kTop &&
                                box.y1 <= kBottom;
            if (inside &&
                std::ranges::none_of(taken, [&](const Box& other) { return box.meets(other); }))
                return box;
        }
    return box;
}

std::string labels(const std::vector<Point>& points) {
    std::vector<Box> taken;
    for (const Point& point : points)
        taken.push_back({point.x - 6, point.y - 6, point.x + 6, point.y + 6});
    std::string svg;
    for (const Point& point : points) {
        const Box box = place_label(point, taken);
        taken.push_back(box);
        svg += fmt::format(R"(<text class="label" x="{:.1f}" y="{:.1f}">{}</text>)", box.x0,
                           box.y1 - 3, html_escaped(point.row->label));
    }
    return svg;
}

} // namespace

std::string plot(const Comparison& comparison) {
    std::vector<double> times, errors;
    for (const Row& row : comparison.rows) {
        if (!can_be_placed(row)) continue;
        times.push_back(row.time_ms().median);
        if (row.error.flip > 0) errors.push_back(row.error.flip);
    }
    if (times.empty()) return "";
    const Scale x = svg::log_scale(times, kLeft, kRight);
    const Scale y = svg::log_scale(errors, kLane - 8, kTop);
    std::vector<Point> points;
    for (const Row& row : comparison.rows) {
        if (!can_be_placed(row)) continue;
        const measure::Interval& ci95 = row.time_ms().ci95;
        points.push_back({x(row.time_ms().median),
                          row.error.flip > 0 ? y(row.error.flip) : (kLane + kBottom) / 2,
                          std::max(x(ci95.low), kLeft), std::min(x(ci95.high), kRight), &row,
                          measure::on_front(comparison, row)});
    }
    std::string svg = fmt::format(
        R"(<svg viewBox="0 0 {} {}" role="img" aria-label="Scatter plot of time )"
        R"(against FLIP; the figures are in the table of every row">)",
        kWidth, kHeight);
    svg += axes(x, y, !errors.empty(), points.front().row->moves) + stairs(points);
    for (const Point& point : points) svg += interval(point);
    for (const Point& point : points) svg += mark(point);
    return svg + labels(points) + "</svg>";
}

} // namespace catoptric::report
