#pragma once

#include "core/error.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace catoptric::measure {

/// `percentile` of measure/statistics.hpp, for floats too.
template <typename Value>
double percentile_of(std::vector<Value> values, double fraction) {
    check(!values.empty(), Failure::internal, "a percentile wants at least one value, found none");
    check(fraction >= 0 && fraction <= 1, Failure::internal,
          "a percentile wants a fraction in [0,1], found ", fraction);
    const double position = fraction * static_cast<double>(values.size() - 1);
    const auto rank = static_cast<std::ptrdiff_t>(position);
    const auto low = values.begin() + rank;
    std::nth_element(values.begin(), low, values.end());
    const double rest = position - static_cast<double>(rank), low_value{*low};
    if (rest == 0) return low_value;
    const double high{*std::min_element(low + 1, values.end())};
    return low_value + rest * (high - low_value);
}

} // namespace catoptric::measure
