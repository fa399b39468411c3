#pragma once

#include "measure/pareto.hpp"
#include "report/comparison.hpp"

#include <span>
#include <string_view>

// Finding rows and what they say of themselves.
namespace catoptric::report {

/// A knob and the value it must have, as the user types it.
struct Wanted {
    std::string_view knob;
    std::string_view text;
};

/// The first row of `technique` with the wanted values and every other knob at its default, or
/// null.
const Row* find_row(const Comparison& comparison, std::string_view technique,
                    std::span<const Wanted> wanted = {});
/// Part one with so many inter-reflections, part three, ray tracing: each with its default knobs.
const Row* find_naive(const Comparison& comparison, int bounces);
const Row* find_parallax(const Comparison& comparison);
const Row* find_ray_traced(const Comparison& comparison);

/// It holds pixels that are no numbers: its figures leave them out and judge nothing.
bool failed(const Row& row);
/// Its error over the mirrors is known.
bool judged(const Row* row);
bool is_ray_traced(const Row& row);
bool on_front(const Comparison& comparison, const Row& row);
/// What the row is judged by: its median time with the band from the 5th to the 95th percentile,
/// and its FLIP over the mirrors. All NaN where it failed.
measure::Candidate candidate_of(const Row& row);
/// See measure::beats: no row beats another where their bands of time overlap and it is not closer.
bool beats(const Row& a, const Row& b);
/// Whether the bands of two rows' times do not overlap.
bool is_faster(const Row& a, const Row& b);

} // namespace catoptric::report
