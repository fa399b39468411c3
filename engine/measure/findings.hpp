#pragma once

#include "measure/comparison.hpp"

#include <optional>
#include <vector>

// What the figures say of questions that the seed report raises: decided here, put into words by
// report/. Each is there only when the rows that it speaks of are.
namespace catoptric::measure {

/// One step of an 8-bit picture.
inline constexpr double kStep = 1.0 / 255;

/// What reflects without being a mirror, where rows leave its reflection out.
struct NotDrawnFinding {
    double share = 0;                ///< of the picture's pixels, 0..1
    std::vector<const Row*> tracing; ///< rows that draw the reflection: they trace every pixel
    const Row* best = nullptr;       ///< of the others, the lowest FLIP over these pixels
};
/// None where no pixel reflects without being a mirror's, or every row draws the reflection.
std::optional<NotDrawnFinding> find_not_drawn(const Comparison& comparison);

/// Whether clearing cubes explains that part one without inter-reflections, which renders and
/// clears none, is behind part two.
struct ClearFinding {
    enum class Verdict {
        slower_without, ///< part one is slower without any clear
        too_little,     ///< with a clear added it is still no slower than part two
        explains
    };
    const Row *one, *two;
    bool one_is_slower = false;
    std::optional<double> clear_ms; ///< of all mirrors' cubes; nothing: not measured, no verdict
    Verdict verdict = Verdict::explains;
    double gap = 0; ///< with a clear added, part one behind part two, as a share of that
};
std::optional<ClearFinding> find_clears(const Comparison& comparison);

/// What storing distances in 8 bits costs. Rows that there are not are null, `near` or `far` at
/// least is.
struct StoredDistanceFinding {
    const Row *plain, *full;
    const Row *near, *far;      ///< 8 bits up to 200 and up to 1000 units
    bool near_is_worse = false; ///< than no correction at all
};
std::optional<StoredDistanceFinding> find_stored_distance(const Comparison& comparison);

/// Whether more inter-reflections bring part one closer to the reference.
struct BounceFinding {
    std::vector<const Row*> steps; ///< 1, 2, ... inter-reflections
    double fall = 0;               ///< of the rmse from the first to the last
    bool helps = false;            ///< by more than kStep
    /// Part three, where correcting parallax takes away more than half of the squared error that
    /// the last step leaves; else null.
    const Row* dominated_by = nullptr;
};
std::optional<BounceFinding> find_bounces(const Comparison& comparison);

/// Part three beside part two.
struct PriceFinding {
    const Row *two, *three;
    bool tie = false;             ///< their times are not told apart
    Interval ratio_ci95;          ///< of part three's time to part two's, round by round
    double more = 0;              ///< time, as a share of part two's; negative: less
    std::uint64_t more_bytes = 0; ///< of images; 0: no more
};
std::optional<PriceFinding> find_price(const Comparison& comparison);

/// Ray tracing beside part three.
struct TracingFinding {
    const Row *three, *traced;
    bool tie = false;
    Interval ratio_ci95;
    double ratio = 1; ///< of their median times
};
std::optional<TracingFinding> find_tracing(const Comparison& comparison);

} // namespace catoptric::measure
