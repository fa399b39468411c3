#pragma once

#include "report/comparison.hpp"
#include "session/session.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Fills one row of a comparison.
namespace catoptric::app {

/// Returns a row that describes the technique or plan, without its cost, picture and errors.
report::Row make_row(const std::string& text, const Part& part);
/// Fills the row's cost from the frames measured so far, round by round. The row's passes are those
/// whose name begins with `prefix`. `on_processor`: the device is a processor.
void fill_times(report::Row& row, const std::vector<std::vector<FrameTimes>>& rounds,
                const std::string& prefix, bool on_processor);
/// Returns FLIP of both pictures for each pixel, as displayed at `exposure` stops, not rounded to 8
/// bits.
std::vector<float> flip_map_of(const Part& part, const Part& truth, double exposure);

/// Returns how far a picture is from the truth, over all masks. `flip_map`: of both pictures.
/// `hits`: of the same picture, see Part::hits. `exposure`: stops.
measure::Errors errors_of(const Part& part, const Part& truth, std::span<const float> flip_map,
                          const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                          double exposure);
/// Fills the row's picture, errors and means. `hits`: of the same instant. `exposure`: stops.
void fill_errors(report::Row& row, const Part& part, const Part& truth,
                 const std::vector<std::uint32_t>& hits, std::size_t mirrors, double exposure);

} // namespace catoptric::app
