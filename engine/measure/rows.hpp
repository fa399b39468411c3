#pragma once

#include "core/technique_traits.hpp"
#include "measure/comparison.hpp"

#include <span>
#include <string_view>

// Functions that find rows in a comparison.
namespace catoptric::measure {

/// Knob and the value it must have, as the user types it.
struct KnobText {
    std::string_view knob;
    std::string_view text;
};

/// Returns the first row whose technique repeats this part of the seed report, with the wanted
/// values and all other knobs at their defaults, or null.
const Row* find_seed_row(const Comparison& comparison, TechniqueTraits::SeedPart part,
                         std::span<const KnobText> wanted = {});
/// Three functions that return the row of part one with `bounces` bounces, of parallax correction,
/// and of ray tracing, each with default knobs. Null if the comparison has no such row.
const Row* find_naive_row(const Comparison& comparison, int bounces);
const Row* find_parallax_row(const Comparison& comparison);
const Row* find_ray_traced_row(const Comparison& comparison);
bool is_ray_traced(const Row& row);

} // namespace catoptric::measure
