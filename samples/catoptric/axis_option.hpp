#pragma once

#include "measure/comparison.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

/// A knob of `compare --axis`, with the values with which each technique that has the knob is
/// compared.
struct KnobAxis {
    std::string knob;
    std::vector<std::string> values;
};

/// Reads the text "KNOB=VALUE,VALUE[,...]". Throws `usage` unless the text gives a name and at
/// least two different values.
KnobAxis parse_axis(const std::string& text);

/// Returns the rows to compare: each technique that has the knob of an axis, once for each value.
/// Plans, techniques without the knob and those that set it themselves stay as they are. Several
/// axes multiply. Throws `usage` if no technique has the knob of an axis.
std::vector<std::string> expand_axes(std::vector<std::string> techniques,
                                     const std::vector<KnobAxis>& axes);

/// Returns a sentence for each technique whose pictures are equal with all values of an axis.
std::vector<std::string> axes_without_effect(const measure::Comparison& comparison,
                                             const std::vector<KnobAxis>& axes);

} // namespace catoptric::cli
