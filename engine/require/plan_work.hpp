#pragma once

#include "require/model.hpp"
#include "require/paths.hpp"
#include "require/unit_costs.hpp"

// Estimates the counted work of a frame (docs/costs.md) before it is drawn. The numbers of pixels,
// triangles, objects, lights and rays are those of the picture. The work of one pixel or ray is
// constant, by counts of the built-in scenes (docs/require.md).
namespace catoptric::require {

/// The numbers on which the work of a pass depends.
struct PictureCounts {
    double pixels = 0, triangles = 0, objects = 0, lights = 0;
    double shadow_faces = 0;         ///< drawn faces of all shadow maps
    double cleared_shadow_faces = 0; ///< faces of all shadow maps
    double materials =
        0; ///< evaluations of a material for each point: 1, or 0 if no material varies
    double textures = 0;        ///< look-ups in textures for each point: 1 or 0
    double pixels_per_path = 0; ///< pixels of the picture that one path stands for
};
PictureCounts count_picture(const WorkModelInput& input, const PathCounts& paths);

/// Rays of a kind, and the nodes that they visit.
struct RayWork {
    WorkKind kind = WorkKind::mirror_rays;
    double rays = 0, nodes = 0, node_lanes = 0;
    bool has_shadow_maps = false; ///< the points that they meet look up shadow maps, without rays
};

/// Sums up the estimated work of a frame.
class FrameWork {
public:
    explicit FrameWork(const PictureCounts& picture) : picture_(picture) { work_[frames] = 1; }

    /// Adds what all frames with a rasterised picture share: shadow maps and the view.
    void add_view();
    /// Adds the capture of a mirror, with six faces of `edge` texels. With `bounds`, `hybrid` finds
    /// the bounds of its distances. With `is_filtered`, its levels are filtered for rough mirrors.
    void add_capture(double edge, bool bounds, bool is_filtered);
    void add_mirrored_view(double pixels);
    /// Adds the search of a capture for pixels.
    void add_search(double pixels);
    /// Adds one look-up of a capture for pixels.
    void add_lookup(double pixels);
    /// Adds a list of the pixels that the rasteriser leaves to rays.
    void add_list();
    /// Adds rays, and what lights the surfaces that they meet.
    void add_rays(const RayWork& rays);
    void add_traced_picture();

    const WorkValues& work() const { return work_; }

private:
    using enum WorkKind;
    void add_shaded_pixels(double points);
    PictureCounts picture_;
    WorkValues work_;
};

} // namespace catoptric::require
