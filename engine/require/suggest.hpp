#pragma once

#include "require/model.hpp"
#include "require/paths.hpp"

#include <string>
#include <vector>

/// Which technique suits which mirror of a picture.
namespace catoptric::require {

/// A mirror that no more of the mirrors' pixels than this show, directly or in other mirrors, is
/// looked up in the cheapest way, in a capture of this edge.
inline constexpr double kHardlySeen = .002;
inline constexpr std::uint32_t kSmallFace = 64, kUsualFace = 256;
/// A mirror whose bent part is larger than this share of its area is not drawn by planes.
inline constexpr double kMostBent = .1;

/// What a picture costs, in drawn pixels: the weights of passes and pixels. Measured on llvmpipe;
/// docs/require.md has the figures.
struct CostTable {
    double pass = 2000;   ///< a pass of any size
    double triangle = 1;  ///< of the scene, in each pass
    double pixel = 1;     ///< drawn, in a capture or in a view
    double searched = 15; ///< pixel that a search looks up
    double bounds = .12;  ///< more for a pixel of a capture that `hybrid` searches
    double traced = 40;   ///< pixel that `hybrid` traces since the capture does not show it
};
/// Mean FLIP of a mirror's pixel, by what draws it; rounded, over the scenes of docs/require.md.
struct ErrorTable {
    double planar = .003, search = .03, reuse = .3;
    double unknown = .5; ///< not in the mirror's capture, where nothing is traced
    double black = .5;   ///< flat mirrors one behind the other, more than are drawn
};

/// One way to draw all mirrors.
struct Candidate {
    std::string name;                    ///< what draws it: "planar, hybrid"
    std::vector<std::string> techniques; ///< entry n-1 of mirror n
    double cost = 0;                     ///< drawn pixels a frame
    double error = 0;                    ///< mean over the mirrors' pixels
};

struct Suggestion {
    std::string plan;                  ///< "1=planar 2-3 ..." as reflect::parse_plan reads it
    std::vector<std::string> reasons;  ///< entry n-1 of mirror n: "planar: flat, ..."
    std::vector<Candidate> candidates; ///< that were weighed, the chosen one first
};

/// Chooses by what the pixels show (paths_of) and by shape (scene::flat_faces): mirrors that are
/// hardly seen get `reuse` with small faces. For the others two candidates are weighed: `planar`
/// for the flat ones and a search for the rest, and a search for all. A search is `hybrid`, or
/// `march` where tracing what captures do not show (Paths::hidden) would take less than a tenth off
/// the mirror's estimated error. The candidate with the smaller estimated error wins. Within a
/// tenth, the cheaper one does.
Suggestion suggest(const Question& question);

/// The candidates with cost and error, a line each, for the user to read.
std::string to_text(const std::vector<Candidate>& candidates);

} // namespace catoptric::require
