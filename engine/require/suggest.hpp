#pragma once

#include "require/model.hpp"
#include "require/paths.hpp"
#include "require/unit_costs.hpp"

#include <string>
#include <vector>

namespace catoptric::require {

/// A mirror is hardly seen if at most this share of all mirror pixels show it, directly or in other
/// mirrors. Such a mirror gets `reuse` with a capture of edge kSmallFaceEdge, the cheapest
/// lookup.
inline constexpr double kHardlySeenShare = .002;
inline constexpr std::uint32_t kSmallFaceEdge = 64, kUsualFaceEdge = 256;
/// A mirror with a larger share of bent surface than this is not drawn by `planar`.
inline constexpr double kMaxCurvedShare = .1;

/// A plan with this mean FLIP counts as much as an exact plan that takes twice the time.
inline constexpr double kErrorOfDoubleTime = .005;

/// Mean FLIP of a mirror pixel by technique. Rounded averages over the scenes of docs/require.md.
struct TechniqueErrors {
    double planar = .003, search = .03, reuse = .3;
    /// Rough mirrors, searched and by one ray or four rays of the lobe (docs/rough.md). The FLIP of
    /// one ray is half as large, but its rmse is larger than that of a search, so it counts more.
    double rough_search = .12, one_rough_ray = .15, four_rough_rays = .045;
    /// `first=raster`, whose shadows come from maps. Its mean is .0001, and .0016 in the worst of
    /// 30 views. It counts as more, so that rays are taken unless the rasteriser is predicted to
    /// take 1.15 times less time.
    double raster = .00075;
    double unknown = .5; ///< surface outside the mirror's capture, if nothing is traced
    double black = .5;   ///< flat mirrors seen through more mirrors than are drawn
};

/// The ways to draw a mirror: by mirrored views, by searches in its capture with or without rays
/// for what the capture does not show, by a small capture, or by rays alone.
enum class DrawMethod { planes, hybrid, march, small, traced };

/// One assignment of techniques to all mirrors.
struct PlanCandidate {
    std::string name;                         ///< the techniques in use: "planar, hybrid"
    std::vector<DrawMethod> ways = {};        ///< entry n-1 belongs to mirror n
    std::vector<std::string> techniques = {}; ///< the same
    double ms = 0;                            ///< predicted time of a frame that draws everything
    double error = 0;                         ///< estimated FLIP, mean over all mirror pixels
    std::string plan = {};                    ///< text for reflect::parse_plan

    /// Returns the number by which plans are compared: the time that an exact plan may take.
    double score() const { return ms * (1 + error / kErrorOfDoubleTime); }
};

struct PlanSuggestion {
    std::string plan;                 ///< plan text for reflect::parse_plan: "1=planar 2-3 ..."
    std::vector<std::string> reasons; ///< reason for mirror n in entry n-1: "planar: flat, ..."
    std::vector<PlanCandidate> candidates; ///< all that were compared, the chosen one first
};

/// Suggests a plan from what the pixels show (PathCounts) and from shapes
/// (scene::find_flat_faces). Mirrors that are hardly seen get `reuse` with small faces.
///
/// Four candidates are compared: `planar` for flat mirrors with a search for the others, a search
/// for all mirrors, and if a mirror is seen also `raytrace` and `raytrace:first=raster`. The search
/// of a mirror is `hybrid`. It is `march` if tracing what captures do not show
/// (PathCounts::hidden) would reduce the mirror's estimated error by less than a tenth. If a
/// seen mirror is rough, one ray or four rays of each pixel are drawn from lobes.
///
/// The candidate with the least PlanCandidate::score wins. Its time is the sum of estimated counts
/// (FrameWork) times the unit costs. The same picture and costs always give the same plan.
PlanSuggestion suggest_plan(const WorkModelInput& input,
                            const UnitCosts& costs = default_unit_costs());

/// Returns the candidates with time, error and the rule of the choice, for the user. `costs`:
/// DeviceUnitCosts::note.
std::string format_candidates(const std::vector<PlanCandidate>& candidates,
                              const std::string& costs);

} // namespace catoptric::require
