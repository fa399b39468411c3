#pragma once

#include "require/model.hpp"

#include <map>
#include <vector>

/// Finds by rays which mirrors the pixels of a picture show.
namespace catoptric::require {

/// Largest number of camera rays that are followed in a picture. A larger picture is sampled on a
/// coarser grid.
inline constexpr std::size_t kMaxMirrorPaths = 65536;
/// Largest number of mirrors through which a camera ray is followed.
inline constexpr std::size_t kMaxMirrorsPerPath = 8;
/// Of rays that leave rough surfaces, one row in this many is followed.
inline constexpr std::uint32_t kRowsPerRoughRow = 4;

/// Pixels whose rays a subgroup of the ray tracer follows together.
inline constexpr std::uint32_t kLanesOfRays = 8;

/// Rays, and the nodes of the BVH that they visit: sums over the rays of a picture.
struct WalkedRays {
    double rays = 0, nodes = 0;
    /// Visits of groups of kLanesOfRays neighbouring pixels. A group walks until its last ray ends.
    /// Of groups with fewer paths, the visits count in proportion.
    double node_lanes = 0;
};

/// Statistics of rays from the eye through the centre of each pixel (or each cell of a grid),
/// followed from mirror to mirror. Entry n-1 of a list belongs to mirror n.
struct PathCounts {
    std::size_t count = 0; ///< number of rays
    /// Number of camera rays for each sequence of mirrors that rays meet, before they meet another
    /// surface. Mirrors are numbered from 0.
    std::map<std::vector<std::uint32_t>, std::size_t> through;
    std::vector<std::size_t> first;   ///< rays whose first hit is mirror n
    std::vector<std::size_t> reached; ///< rays that meet mirror n anywhere
    /// Rays whose first hit is mirror n and that reach a point which a capture on the way does not
    /// show. The capture is that of a mirror on the path, drawn from the centre of its bounds.
    std::vector<std::size_t> hidden;
    /// Number of camera rays for each sequence of mirrors, counting only rays whose next point is
    /// hidden from the capture of the last mirror.
    std::map<std::vector<std::uint32_t>, std::size_t> hidden_after;
    /// What the ray tracer walks: rays from the eye, rays that leave mirrors and smooth dielectrics
    /// sharply, and further rays that leave rough surfaces. Of the last, one row in
    /// kRowsPerRoughRow is followed and counted as all.
    WalkedRays camera, sharp, rough;

    std::size_t on_mirrors() const; ///< Returns the number of rays whose first hit is a mirror.
};

/// Builds a BVH over all triangles (bvh::build) and follows at most kMaxMirrorPaths rays, in
/// floats relative to the eye. Each reflection costs one more ray, from a capture's centre.
PathCounts trace_paths(const WorkModelInput& input);

} // namespace catoptric::require
