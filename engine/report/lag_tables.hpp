#pragma once

#include "report/tables.hpp"

#include <optional>
#include <string>

// Tables, sentences and plots of the lag. Each is empty if no lag was measured.
namespace catoptric::report {

/// Returns the table of each row at each speed.
Table lag_table(const Comparison& comparison);
/// Returns the table of how many frames after a cut pass until the picture equals the still
/// picture.
Table settling_table(const Comparison& comparison);
/// Returns what the run says about the seed report's "no difference" between its parts one and two,
/// and which rows have no lag.
std::optional<std::string> lag_in_words(const Comparison& comparison);
/// Returns the curves as a section of a page, or an empty string without curves.
std::string lag_plots(const Comparison& comparison);

} // namespace catoptric::report
