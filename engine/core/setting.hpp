#pragma once

#include <optional>
#include <string>

namespace catoptric {

/// One knob of a technique with its value as text. `number` is set if the value is a number.
/// `number` is empty for a choice and for a special word ("auto").
struct Setting {
    std::string name;
    std::string text; ///< value of the knob as the user types it
    std::optional<double> number;
    bool changed = false; ///< whether it differs from the knob's default
    bool operator==(const Setting&) const = default;
};

} // namespace catoptric
