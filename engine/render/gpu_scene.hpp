#pragma once

#include "gpu/buffer.hpp"
#include "graph/commands.hpp"
#include "render/geometry.hpp"

namespace catoptric::render {

/// A scene on the device at one instant, and everything derived from it: views, probes, lights, the
/// hierarchy for tracing. Both worlds read the same vertices.
class GpuScene {
public:
    /// `scene` at rest fixes the units for good.
    GpuScene(gpu::Device& device, const scene::Scene& scene);

    /// Writes what stands where now. `now` is scene::at of the scene given above; not while a frame
    /// is in flight. Rebuilds everything: O(n log n) in triangles, some 20 ms for the built-in
    /// scene.
    void update(const scene::Scene& now, const scene::Camera& camera, uvec2 size, double ambient);

    std::uint32_t mirror_count() const { return mirror_count_; }
    /// Whether some mirror is no exact sphere.
    bool has_other_mirrors() const;
    std::uint32_t light_count() const { return light_count_; }
    std::uint32_t shadow_faces() const { return shadow_faces_; }
    const Space& space() const { return space_; }
    const std::vector<DrawRange>& ranges() const { return geometry_.ranges; }
    const std::vector<shared::View>& views() const { return views_; }
    /// Index of the object that is mirror n, n from 0.
    std::size_t mirror_object(std::uint32_t mirror) const { return mirror_objects_[mirror]; }
    /// Whether the object is a closed mirror with the camera inside, where no light from outside
    /// arrives.
    bool hides_all_from_camera(std::size_t object) const { return hides_all_[object]; }
    /// Texels that the edge of each mirror's cube needs (render/footprint.hpp); 0 for a mirror that
    /// is not in the picture. Found at the first update and kept: cubes that change their size lose
    /// what the frame before left.
    const std::vector<double>& face_needs() const { return face_needs_; }
    /// They are found anew at the next update.
    void forget_face_needs() { face_needs_.clear(); }
    /// One edge for all: the largest need, as far as the device allows.
    std::uint32_t common_face() const;
    /// Push constants that draw an object into the views from `first_view` on.
    shared::Draw draw_of(std::size_t object, std::uint32_t first_view) const;

    static constexpr std::uint32_t kCameraView = 0;
    std::uint32_t capture_view(std::uint32_t mirror) const { return 1 + 6 * mirror; }
    std::uint32_t shadow_view(std::uint32_t light) const {
        return 1 + 6 * mirror_count_ + shadow_faces_ * light;
    }

    /// Binds every buffer of the scene under the name it has in shaders/lib.
    void bind(graph::Commands& commands) const;

private:
    void fill_lights(const scene::Scene& now);
    void fill_views(const scene::Scene& now, const scene::Camera& camera, uvec2 size);
    void fill_tracing();
    void find_face_needs(uvec2 size);

    gpu::Device& device_;
    Space space_;
    Geometry geometry_;
    std::vector<shared::View> views_;
    std::vector<shared::Surface> surfaces_;
    std::vector<shared::Probe> probes_;
    std::vector<shared::Light> lights_;
    std::vector<std::size_t> mirror_objects_;
    std::vector<bool> hides_all_; ///< by object
    std::vector<double> face_needs_;
    std::uint32_t mirror_count_ = 0, light_count_ = 0, shadow_faces_ = 6;
    gpu::Buffer vertex_buffer_, index_buffer_, frame_, view_buffer_, surface_buffer_, light_buffer_,
        probe_buffer_;
    gpu::Buffer bvh_nodes_, bvh_triangles_, normals_;
};

} // namespace catoptric::render
