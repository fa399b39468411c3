#pragma once

#include "measure/picture.hpp"
#include "report/comparison.hpp"

#include <span>
#include <string_view>

namespace catoptric::report {

/// Colour in which pictures show a cause.
struct CauseColour {
    std::string_view cause, name;
    vec3 colour; ///< display space
};

/// Returns the colours of all causes, in the order of Causes::list. Colour-blind readers can tell
/// them apart, too (Okabe, Ito).
std::span<const CauseColour> cause_colours();

/// Returns the row's picture, dark and grey. Each mirror pixel that is off has the colour of the
/// cause with the largest part of its squared error. The row must have `causes`.
measure::Picture cause_picture(const Row& row);

} // namespace catoptric::report
