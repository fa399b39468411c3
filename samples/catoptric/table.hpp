#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

/// Columns as wide as their widest cell, two spaces apart; the first and those from `text_from` on
/// to the left, the rest to the right. All rows have as many cells as the first.
std::string aligned(const std::vector<std::vector<std::string>>& rows,
                    std::size_t text_from = std::string::npos);

/// What compare prints: one line a row, after a line about where it was measured.
std::string compare_table(const report::Comparison& comparison);

} // namespace catoptric::cli
