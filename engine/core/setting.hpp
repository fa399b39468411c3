#pragma once

#include <optional>
#include <string>

namespace catoptric {

/// One knob of a technique with its value, as text for whoever shows it; `number` when it is one,
/// nothing for a choice and for a special word ("auto").
struct Setting {
    std::string name;
    std::string text; ///< as the user types it
    std::optional<double> number;
    bool changed = false; ///< not the knob's default
    bool operator==(const Setting&) const = default;
};

} // namespace catoptric
