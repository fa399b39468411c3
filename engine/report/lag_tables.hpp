#pragma once

#include "report/tables.hpp"

#include <optional>
#include <string>

// What the lag of moving pictures reads like. Without a measured lag there is nothing of it.
namespace catoptric::report {

/// Every row at every speed.
Table lag_table(const Comparison& comparison);
/// Frames after a cut until the picture is the still one.
Table settling_table(const Comparison& comparison);
/// What the run says of the seed report's "no difference" between its parts one and two, and which
/// rows have no lag.
std::optional<std::string> lag_in_words(const Comparison& comparison);
/// The curves as a section of a page; empty when there are none.
std::string lag_plots(const Comparison& comparison);

} // namespace catoptric::report
