#pragma once

#include "app/session.hpp"
#include "report/comparison.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// What a comparison says of one row.
namespace catoptric::app {

/// What the row is, what it cost and its pictures. `frames`: the measured ones, of which the row's
/// are the passes that bear its part's prefix. Errors are not in it.
report::Row make_row(const std::string& text, const Part& part,
                     const std::vector<FrameTimes>& frames);
/// How far a picture is from the truth, over all masks. `flip_map`: of the two; `hits`: of the same
/// picture, see Part::hits.
measure::Errors errors_of(const Part& part, const Part& truth, std::span<const float> flip_map,
                          const std::vector<std::uint32_t>& hits, std::size_t mirrors);
/// The row's errors and means.
void fill_errors(report::Row& row, const Part& part, const Part& truth,
                 const std::vector<std::uint32_t>& hits, std::size_t mirrors);

} // namespace catoptric::app
