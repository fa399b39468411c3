#pragma once

#include "measure/comparison.hpp"
#include "measure/interval.hpp"

#include <optional>
#include <vector>

// Answers to questions of the seed report, computed from the rows of a comparison. report/ writes
// them as sentences. A function returns nothing if the comparison lacks the rows that it needs.
namespace catoptric::measure {

/// Difference between neighbouring values of an 8-bit picture, on a scale from 0 to 1.
inline constexpr double kEightBitStep = 1.0 / 255;

/// Result for smooth dielectrics, whose reflection some rows do not draw.
struct UndrawnDielectrics {
    double share = 0; ///< share of the picture's pixels that show smooth dielectrics, 0..1
    /// Rows that draw the reflection, because they trace each pixel.
    std::vector<const Row*> tracing;
    const Row* best = nullptr; ///< the other row with the lowest FLIP over these pixels
};
/// Returns nothing if no pixel shows a smooth dielectric or if each row draws the reflection.
std::optional<UndrawnDielectrics> find_undrawn_dielectrics(const Comparison& comparison);

/// Answer, by device times, to whether clearing cubes explains why part one without
/// inter-reflections, which renders and clears no cube, is slower than part two.
struct ClearCost {
    enum class Verdict {
        slower_without, ///< part one is slower even without a clear
        too_little, ///< part one is not slower than part two even with the time of the clear added
        explains
    };
    const Row *one, *two;
    bool one_is_slower = false;
    /// Time to clear all mirrors' cubes; empty if not measured, and then `verdict` says nothing.
    std::optional<double> clear_ms;
    Verdict verdict = Verdict::explains;
    /// Excess of part one with a clear over part two, as a share of part two's time.
    double gap = 0;
};
std::optional<ClearCost> find_clear_cost(const Comparison& comparison);

/// Cost of storing distances in 8 bits. Missing rows are null, but at least one of `near` and `far`
/// is there.
struct DistanceFormatResult {
    const Row *plain, *full;
    const Row *near, *far;      ///< rows with 8-bit distances up to 200 and up to 1000 units
    bool near_is_worse = false; ///< whether `near` has a larger error than no correction at all
};
std::optional<DistanceFormatResult> find_distance_format(const Comparison& comparison);

/// Answer to the question whether more bounces bring the technique `naive` closer to the reference.
struct BouncesResult {
    std::vector<const Row*> steps; ///< rows with 1, 2, ... inter-reflections
    double fall = 0;               ///< fall of the rmse from the first to the last step
    /// Whether more inter-reflections help: whether `fall` is larger than kEightBitStep.
    bool helps = false;
    /// Row of part three if its squared error is less than half of the squared error of the last
    /// step. Null otherwise.
    const Row* dominated_by = nullptr;
};
std::optional<BouncesResult> find_bounces_result(const Comparison& comparison);

/// Additional cost of the seed report's part three (parallax correction) over its part two (last
/// frame's captures).
struct ParallaxPrice {
    const Row *two, *three;
    Order order;         ///< of part three's time and part two's
    Interval ratio_ci95; ///< ratio of part three's time to part two's, round by round
    /// Time of part three minus time of part two, divided by the time of part two. Negative if part
    /// three is faster.
    double more = 0;
    std::uint64_t more_bytes = 0; ///< additional bytes of images; 0 if part three needs no more

    bool is_tie() const { return order == Order::equal || order == Order::unknown; }
};
std::optional<ParallaxPrice> find_parallax_price(const Comparison& comparison);

/// Time of ray tracing, compared with the seed report's part three (parallax correction).
struct RayTracingTime {
    const Row *three, *traced;
    Order order; ///< of ray tracing's time and part three's
    Interval ratio_ci95;
    double ratio = 1; ///< median time of ray tracing divided by that of part three

    bool is_tie() const { return order == Order::equal || order == Order::unknown; }
};
std::optional<RayTracingTime> find_ray_tracing_time(const Comparison& comparison);

} // namespace catoptric::measure
