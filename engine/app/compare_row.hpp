#pragma once

#include "app/session.hpp"
#include "report/comparison.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// What a comparison says of one row.
namespace catoptric::app {

/// What the row is. What it cost, its picture and its errors are not in it.
report::Row make_row(const std::string& text, const Part& part);
/// What it cost, from the frames that were measured so far, round by round; the row's are the
/// passes whose name begins with `prefix`. `on_processor`: the device is one.
void fill_times(report::Row& row, const std::vector<std::vector<FrameTimes>>& rounds,
                const std::string& prefix, bool on_processor);
/// FLIP of the two as displayed at so many stops of exposure, not rounded to 8 bits.
std::vector<float> flip_map_of(const Part& part, const Part& truth, double exposure);

/// How far a picture is from the truth, over all masks. `flip_map`: of the two; `hits`: of the same
/// picture, see Part::hits; `exposure`: stops.
measure::Errors errors_of(const Part& part, const Part& truth, std::span<const float> flip_map,
                          const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                          double exposure);
/// The row's picture with its errors and means. `hits`: of the same instant.
void fill_errors(report::Row& row, const Part& part, const Part& truth,
                 const std::vector<std::uint32_t>& hits, std::size_t mirrors, double exposure);

} // namespace catoptric::app
