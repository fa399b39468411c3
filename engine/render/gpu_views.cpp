// The views of a scene on the device: the camera's view, and the views of mirrors and lights.
#include "render/enclosure.hpp"
#include "render/gpu_scene.hpp"
#include "render/views.hpp"

namespace catoptric::render {

/// Fills the list of views: the camera's first, then those of mirrors and lights.
void GpuScene::fill_views(const scene::Camera& camera, uvec2 size) {
    eye_ = space_.to_scene(camera.eye);
    const float gap = nearest_.distance(
        geometry_, eye_, [](std::size_t, const DrawRange& range) { return !range.seen_by_camera; });
    views_ = {make_camera_view(camera, space_, size, gap, geometry_bounds(geometry_))};
    const bool is_parallel = views_.front().parallel != 0;
    if (is_parallel) eye_ = dvec3(views_.front().eye) + dvec3(views_.front().eye_low);
    views_.insert(views_.end(), scene_views_.begin(), scene_views_.end());
    hides_all_.clear();
    for (const DrawRange& range : geometry_.ranges)
        hides_all_.push_back(range.mirror && !range.glass && !is_parallel &&
                             encloses(geometry_, range, eye_));
    camera_ = camera, size_ = size;
    view_buffer_.set(views_);
}

MirroredViewEye GpuScene::eye() const {
    return {views_[kCameraViewIndex], eye_, geometry_bounds(geometry_)};
}

} // namespace catoptric::render
