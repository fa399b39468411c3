#pragma once

#include <string>
#include <vector>

namespace catoptric::report {

/// A kind of part that bars are made of, such as "captures".
struct BarPartKind {
    std::string name;
    std::string colour; ///< of CSS, such as "#0072b2"
};

/// A horizontal bar with a length for each of StackedBars::kinds, at least 0. NaN counts as 0.
struct StackedBar {
    std::string label;
    std::vector<double> lengths;
};

struct StackedBars {
    std::string x_name;
    std::string says; ///< text for readers who cannot see the drawing
    std::vector<BarPartKind> kinds;
    std::vector<StackedBar> bars;
};

/// Returns an SVG to embed in a page, with a legend above the bars. Empty if no bar has a length.
std::string draw_bars(const StackedBars& chart);

/// Returns colours that colour-blind readers can tell apart (Okabe, Ito). Further kinds repeat
/// them.
std::string bar_colour(std::size_t kind);

} // namespace catoptric::report
