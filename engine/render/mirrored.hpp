#pragma once

#include "graph/graph.hpp"
#include "scene/flat_mirror.hpp"
#include "shared.h"

#include <optional>
#include <vector>

/// Views in flat mirrors: a mirror shows what the eye would see that stands as far behind it.
namespace catoptric::render {

/// A view and where in the picture it is looked at.
struct MirroredView {
    std::uint32_t mirror = 0;          ///< the plane that it is seen in, from 0
    std::optional<std::size_t> within; ///< the view that shows the plane; nothing: the camera's
    shared::View view;                 ///< as shared.h has it, with the mirror's plane in `clip`
    dvec3 eye{0};                      ///< scene units
    graph::Area area;                  ///< of the picture, around the mirror's pixels
};

/// What the views start from; scene units.
struct Eye {
    shared::View view;
    dvec3 place{0};
    Bounds<float> everything; ///< of the scene: how far a parallel view has to look
};

/// A mirror, or a face of one, that may have views.
struct MirrorPlane {
    scene::Flat flat; ///< scene units
    int bounces = 0;  ///< mirrors one behind the other that its picture shows; 0: it is black
};

inline constexpr std::size_t kMostMirroredViews = 1000;

/// A view for each of the mirrors of which the picture shows at least a part, and for those that
/// these views show, and so on; after each view those that it shows. A pixel of a view is that of
/// the picture which the mirror covers: the eye's basis is mirrored, and projection is what it was
/// (Diefenbach and Badler 1997). Where that makes more than kMostMirroredViews, no mirror's picture
/// goes deeper than `most`, which else stays as it is. What hides what is not asked. O(views *
/// mirrors).
std::vector<MirroredView> mirrored_views(const Eye& camera,
                                         const std::vector<std::optional<MirrorPlane>>& mirrors,
                                         uvec2 size, int& most);

/// False when the box certainly lies outside the part of the view in the area, or behind its plane.
bool may_meet(const MirroredView& view, uvec2 size, const Bounds<float>& box);

} // namespace catoptric::render
