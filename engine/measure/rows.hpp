#pragma once

#include "measure/comparison.hpp"

#include <span>
#include <string_view>

// Finding rows.
namespace catoptric::measure {

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
bool is_ray_traced(const Row& row);

} // namespace catoptric::measure
