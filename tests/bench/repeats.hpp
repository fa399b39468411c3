#pragma once

#include <string>
#include <vector>

/// Compares the rows `times` times at 128x128. Prints how often each pair of rows was called
/// different in time, and how many comparisons had a noisy row.
void repeat_comparison_of_rows(int times, const std::vector<std::string>& rows);
