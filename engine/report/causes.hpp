#pragma once

#include "measure/picture.hpp"
#include "report/comparison.hpp"

#include <span>
#include <string_view>

namespace catoptric::report {

/// What a cause is painted with.
struct CauseColour {
    std::string_view cause, name;
    vec3 colour; ///< display space
};

/// Of every cause, in the order of Causes::list. Told apart by the colour-blind, too (Okabe, Ito).
std::span<const CauseColour> cause_colours();

/// The row's picture, dark and grey, with every mirror pixel that is off in the colour of the cause
/// that has the largest part of its squared error. For rows with `causes`.
measure::Picture cause_picture(const Row& row);

} // namespace catoptric::report
