#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

/// Returns the rows with columns as wide as their widest cell, two spaces apart. The first column
/// and those from `text_from` on are left-aligned, the others right-aligned. All rows need as many
/// cells as the first.
std::string align_columns(const std::vector<std::vector<std::string>>& rows,
                          std::size_t text_from = std::string::npos);

/// Returns the output of `compare`: a line about the device, then one line per row.
std::string compare_table(const report::Comparison& comparison);

} // namespace catoptric::cli
