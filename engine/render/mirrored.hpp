#pragma once

#include "graph/graph.hpp"
#include "scene/flat_mirror.hpp"
#include "shared.h"

#include <optional>
#include <vector>

/// Mirrored views for flat mirrors. The reflection in a flat mirror equals the view from an eye
/// that is mirrored in the mirror's plane.
namespace catoptric::render {

/// A mirrored view and the part of the picture that shows it.
struct MirroredView {
    std::uint32_t plane_index = 0; ///< index of the plane in the list of find_mirrored_views
    /// Index of the view that shows the plane; empty: the camera's view.
    std::optional<std::size_t> within;
    shared::View view;          ///< the view as in shared.h, with the mirror's plane in `clip`
    dvec3 eye{0};               ///< scene units
    graph::PixelRectangle area; ///< pixels of the picture, around the mirror
};

/// The eye from which mirrored views start; scene units.
struct MirroredViewEye {
    shared::View view;
    dvec3 place{0};
    Bounds<float> everything; ///< bounds of the scene: the range of a parallel view
};

/// A flat mirror, or one flat face of a mirror.
struct MirrorPlane {
    scene::FlatFace flat; ///< scene units
    /// Number of mirror reflections, one behind the other, that the mirrored view draws; 0: the
    /// view is black.
    int bounces = 0;
    /// Angle, radians, up to which a blurred look-up leaves the pixel of the mirror that shows it;
    /// 0: the mirror shows the same pixel of the view.
    double blur_angle = 0;
};

inline constexpr std::size_t kMaxMirroredViews = 1000;

/// Returns a view for each mirror that the picture shows in part, then for each mirror that these
/// views show, and so on. A view precedes the views that it shows.
///
/// Each view has the pixels that its mirror covers in the picture, and those up to `blur_angle`
/// beside them: the basis of the eye is mirrored, and the projection stays (Diefenbach and Badler
/// 1997). If this gives more than
/// kMaxMirroredViews, reduces `most`, the greatest depth, until the views fit; else `most` stays.
/// Ignores occlusion. Costs O(views * mirrors).
std::vector<MirroredView>
find_mirrored_views(const MirroredViewEye& camera,
                    const std::vector<std::optional<MirrorPlane>>& mirrors, uvec2 size, int& most);

/// Returns false only if the box certainly lies outside the view's area or behind its plane.
bool may_show(const MirroredView& view, uvec2 size, const Bounds<float>& box);

} // namespace catoptric::render
