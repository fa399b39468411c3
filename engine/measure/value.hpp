#pragma once

#include "../core/math.hpp"
#include "statistics.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace catoptric::measure {

/// Position of a pixel, counted from the upper left. A negative x means none.
struct PixelPosition {
    int x = -1, y = -1;
};

struct Parts;

/// Value of a metric. A double that is not finite, a time that was never measured and an invalid
/// place count as no value (see is_nothing).
using Value = std::variant<std::monostate, bool, double, dvec3, PixelPosition, Summary,
                           std::vector<double>, std::vector<Parts>>;

/// An entry of a list of values, such as the times of passes or the shares of causes.
struct Parts {
    std::string_view kind; ///< the field that holds the entry's name, such as "name"
    std::string name;
    std::vector<std::pair<std::string_view, Value>> values;
};

} // namespace catoptric::measure
