#pragma once

#include <string>
#include <vector>

/// Compares the rows again and again at 128x128 and prints how often which of them were said to be
/// apart in time, and how many comparisons held a noisy row.
void repeat_compare(int times, const std::vector<std::string>& rows);
