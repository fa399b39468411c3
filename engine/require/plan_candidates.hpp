#pragma once

#include "require/plan_work.hpp"
#include "require/suggest.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

// The candidates that `auto` compares, with their estimated times and errors.
namespace catoptric::require {

/// Facts about a picture's mirrors that the choice depends on.
struct CostInputs {
    PathCounts paths;
    PictureCounts picture;
    std::vector<bool> is_flat, is_seen, is_glass, is_rough; ///< one entry per mirror
    double on_mirrors = 0; ///< paths whose first hit is a mirror; at least 1
    int bounces = 2;       ///< knob `bounces` of `planar`

    std::size_t mirror_count() const { return is_flat.size(); }
    /// Returns how many pixels of the picture this number of paths stands for.
    double pixels(std::size_t paths_through) const {
        return picture.pixels_per_path * static_cast<double>(paths_through);
    }
};

CostInputs gather_cost_inputs(const WorkModelInput& input);

/// Returns a candidate with rasterised mirrors. Flat mirrors get `planar` if `planes` is set.
/// Hardly seen mirrors get small captures, and all others get searches.
PlanCandidate make_captured_candidate(const CostInputs& known, const UnitCosts& costs, bool planes);
/// Returns candidates that trace all mirrors, with and without a rasterised first hit. If a seen
/// mirror is rough, each has one ray or four rays of the lobe.
std::vector<PlanCandidate> make_traced_candidates(const CostInputs& known, const UnitCosts& costs);

} // namespace catoptric::require
