#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace catoptric::scene {

/// The shortest text that reads back as the same number; "0" for both zeros.
std::string number_text(double number);
std::string number_text(float number);

/// The double whose shortest text is the float's: 0.1 for 0.1f. What a person would have typed.
double as_typed(float number);

/// The finite number that `text` is as a whole, with an optional sign; nothing otherwise.
std::optional<double> parse_number(std::string_view text);

} // namespace catoptric::scene
