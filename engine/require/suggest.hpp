#pragma once

#include "require/model.hpp"
#include "require/paths.hpp"

#include <string>
#include <vector>

/// Suggests a technique for each mirror of a picture.
namespace catoptric::require {

/// A mirror is hardly seen if at most this share of all mirror pixels show it, directly or in other
/// mirrors. Such a mirror gets `reuse` with a capture of edge kSmallCaptureFaceEdge, the cheapest
/// lookup.
inline constexpr double kHardlySeenPixelShare = .002;
inline constexpr std::uint32_t kSmallCaptureFaceEdge = 64, kUsualFaceEdge = 256;
/// A mirror with a larger share of bent surface than this is not drawn by `planar`.
inline constexpr double kMaxCurvedAreaShare = .1;

/// Cost model of a picture, in drawn pixels: weights of passes and pixels. Measured on llvmpipe;
/// docs/require.md has the figures.
struct PictureCostTable {
    double pass = 2000;   ///< cost of a pass, whatever its size
    double triangle = 1;  ///< cost of a triangle of the scene, in each pass
    double pixel = 1;     ///< cost of a pixel drawn in a capture or view
    double searched = 15; ///< cost of a pixel that a search looks up
    double bounds = .12;  ///< additional cost per capture pixel that `hybrid` searches
    /// Per pixel that `hybrid` traces, because the capture does not show the surface.
    double traced = 40;
    double whole = 15; ///< cost of a pixel of a picture that is traced as a whole
};
/// Mean FLIP of a mirror pixel by technique. Rounded averages over the scenes of docs/require.md.
struct TechniqueErrorTable {
    double planar = .003, search = .03, reuse = .3;
    double unknown = .5; ///< surface outside the mirror's capture, if nothing is traced
    double black = .5;   ///< flat mirrors seen through more mirrors than are drawn
};

/// One assignment of techniques to all mirrors.
struct PlanCandidate {
    std::string name;                    ///< the techniques in use: "planar, hybrid"
    std::vector<std::string> techniques; ///< entry n-1 belongs to mirror n
    double cost = 0;                     ///< drawn pixels per frame
    double error = 0;                    ///< estimated FLIP, mean over all mirror pixels
};

struct PlanSuggestion {
    std::string plan;                 ///< plan text for reflect::parse_plan: "1=planar 2-3 ..."
    std::vector<std::string> reasons; ///< reason for mirror n in entry n-1: "planar: flat, ..."
    std::vector<PlanCandidate> candidates; ///< all that were compared, the chosen one first
};

/// Suggests a plan from what the pixels show (MirrorPathCounts) and from shapes
/// (scene::find_flat_faces). Mirrors that are hardly seen get `reuse` with small faces.
///
/// Two candidates are compared for the other mirrors: `planar` for flat mirrors with a search for
/// curved mirrors, and a search for all mirrors. The search of a mirror is `hybrid`. It is `march`
/// if tracing what captures do not show (MirrorPathCounts::hidden) would reduce the mirror's
/// estimated error by less than a tenth.
///
/// Glass is traced: by `hybrid`, or by `raytrace` without captures if no other mirror is seen and
/// the estimated cost is less.
///
/// The candidate with the smaller estimated error wins. If the errors differ by less than a tenth,
/// the cheaper candidate wins.
PlanSuggestion suggest_technique_plan(const RequiredWorkModelInput& question);

/// Returns the candidates with cost and error, one line each, for the user.
std::string format_plan_candidates(const std::vector<PlanCandidate>& candidates);

} // namespace catoptric::require
