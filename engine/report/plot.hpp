#pragma once

#include "report/comparison.hpp"

#include <cstddef>
#include <string>
#include <vector>

// Functions that draw plots as SVG, for figures and for readers without script.
namespace catoptric::report {

/// Returns whether a plot of time has a place for the row: its time is known and above 0.
bool has_time(const Row& row);
/// Returns the name of the axis of time, with its unit.
std::string time_axis_name(const Comparison& comparison);
/// Returns lists of indices of rows that differ only in the value of one knob, in the order of the
/// values. There is no list of fewer than three rows. `rows`: indices of the rows to consider.
std::vector<std::vector<std::size_t>> knob_curves(const Comparison& comparison,
                                                  const std::vector<std::size_t>& rows);

/// Returns the rows as an SVG: median ms against FLIP, both logarithmic. Error 0 has a separate
/// lane and the Pareto front is drawn. Empty if no row can be placed.
std::string comparison_plot(const Comparison& comparison);

/// Returns plots of the lag as a section of a page; empty if no row has a measured lag.
std::string lag_plots(const Comparison& comparison);

} // namespace catoptric::report
