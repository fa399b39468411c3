#pragma once

#include "core/technique_traits.hpp"

#include <string_view>

// Table 1 of the seed report (section 4.2): frames per second in a browser on a GeForce GTX 770.
namespace catoptric::measure {

struct SeedReportRow {
    std::string_view implementation;
    TechniqueTraits::SeedPart part; ///< trait of the technique that corresponds to the row
    int inter_reflections;          ///< number of inter-reflections; -1 if the table gives none
    /// The report's R for four reflectors: 4 i + 2 for part one, otherwise one capture each. 0
    /// means none.
    int scene_passes;
    double fps;
    double ms;
};

inline constexpr int kSeedReportMirrorCount = 4;

inline constexpr SeedReportRow kSeedReportNaiveRow{
    "Part one", TechniqueTraits::SeedPart::bounces, 0, 2, 93, 10.8};
inline constexpr SeedReportRow kSeedReportReuseRow{
    "Part two", TechniqueTraits::SeedPart::last_captures, -1, 6, 136, 7.4};
inline constexpr SeedReportRow kSeedReportParallaxRow{
    "Part three", TechniqueTraits::SeedPart::parallax, -1, 6, 134, 7.5};
inline constexpr SeedReportRow kSeedReportRayTracingRow{
    "ray trace", TechniqueTraits::SeedPart::rays, -1, 0, 10.7, 93.0};

inline constexpr SeedReportRow kSeedReportTable[] = {
    kSeedReportNaiveRow,
    {"Part one", TechniqueTraits::SeedPart::bounces, 1, 6, 88, 11.4},
    {"Part one", TechniqueTraits::SeedPart::bounces, 2, 10, 68, 14.7},
    {"Part one", TechniqueTraits::SeedPart::bounces, 3, 14, 48, 20.8},
    {"Part one", TechniqueTraits::SeedPart::bounces, 4, 18, 37, 27.0},
    kSeedReportReuseRow,
    kSeedReportParallaxRow,
    kSeedReportRayTracingRow,
};

/// Time that the seed report attributes to clearing, milliseconds.
inline constexpr double kSeedReportClearMs = kSeedReportNaiveRow.ms - kSeedReportReuseRow.ms;
/// Excess of its part one without inter-reflections over part two, as a share of part two's time.
inline constexpr double kSeedReportClearCostShare = kSeedReportClearMs / kSeedReportReuseRow.ms;
inline constexpr double kSeedReportRayTracingRatio = kSeedReportRayTracingRow.ms /
                                                     kSeedReportParallaxRow.ms;

} // namespace catoptric::measure
