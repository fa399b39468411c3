// The views of a scene on the device: the camera's view, and the views of mirrors and lights.
#include "render/enclosure.hpp"
#include "render/gpu_scene.hpp"
#include "render/views.hpp"

namespace catoptric::render {

/// Fills the list of views: the camera's first, then those of mirrors and lights.
void GpuScene::fill_view_table(const scene::Camera& camera, uvec2 size) {
    eye_ = space_.world_to_scene_units(camera.eye);
    const float gap = nearest_.distance_to_nearest_triangle(
        geometry_, eye_,
        [](std::size_t, const ObjectDrawRange& range) { return !range.seen_by_camera; });
    views_ = {make_camera_view(camera, space_, size, gap, compute_geometry_bounds(geometry_))};
    const bool is_parallel = views_.front().parallel != 0;
    if (is_parallel) eye_ = dvec3(views_.front().eye) + dvec3(views_.front().eye_low);
    views_.insert(views_.end(), scene_views_.begin(), scene_views_.end());
    hides_all_.clear();
    for (const ObjectDrawRange& range : geometry_.ranges)
        hides_all_.push_back(range.mirror && !range.glass && !is_parallel &&
                             does_object_enclose_point(geometry_, range, eye_));
    camera_ = camera, size_ = size;
    view_buffer_.set_device_list_contents(views_);
}

MirroredViewEye GpuScene::eye() const {
    return {views_[kCameraViewIndex], eye_, compute_geometry_bounds(geometry_)};
}

} // namespace catoptric::render
