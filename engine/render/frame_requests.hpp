#pragma once

#include "render/tracing.hpp"
#include "shared.h"

#include <array>
#include <cstdint>
#include <vector>

namespace catoptric::render {

/// What the passes of a frame ask of the scene while they are declared. GpuScene::fulfil does it
/// once, after all passes are declared.
class FrameRequests {
public:
    /// Of a frame without scene.
    FrameRequests() = default;
    /// `first_view`: GpuScene::next_view of the scene, after its update for the frame.
    explicit FrameRequests(std::uint32_t first_view) : first_view_(first_view) {}

    /// Adds a view for passes of this frame. Returns its number in GpuScene::list_views, which
    /// holds it when passes are recorded.
    std::uint32_t add_view(const shared::View& view) {
        views_.push_back(view);
        return first_view_ + static_cast<std::uint32_t>(views_.size()) - 1;
    }
    /// A pass traces rays. `first_hits`: they start at triangles that the rasteriser has drawn
    /// (shaders/lib/first_hit.glsl).
    void trace_rays(SphereMode spheres, bool first_hits) {
        traces_[static_cast<std::size_t>(spheres)] = true;
        first_hits_ = first_hits_ || first_hits;
    }
    /// Rays of a pass aim at points drawn on lamps.
    void sample_lamps() { lamp_points_ = true; }
    /// A pass draws soft shadows of lamps.
    void draw_soft_shadows() { lamp_extents_ = true; }

    const std::vector<shared::View>& views() const { return views_; }
    bool traces_rays(SphereMode spheres) const {
        return traces_[static_cast<std::size_t>(spheres)];
    }
    bool starts_at_first_hits() const { return first_hits_; }
    bool samples_lamps() const { return lamp_points_; }
    bool draws_soft_shadows() const { return lamp_extents_; }

private:
    std::uint32_t first_view_ = 0;
    std::vector<shared::View> views_;
    std::array<bool, 2> traces_{}; ///< by SphereMode
    bool first_hits_ = false, lamp_points_ = false, lamp_extents_ = false;
};

} // namespace catoptric::render
