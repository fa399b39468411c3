#pragma once

#include "graph/commands.hpp"
#include "render/backdrop.hpp"
#include "render/device_list.hpp"
#include "render/frame_requests.hpp"
#include "render/material_parameters.hpp"
#include "render/mirror_tree.hpp"
#include "render/mirrored.hpp"
#include "render/nearest.hpp"
#include "render/scene_changes.hpp"
#include "render/shown_faces.hpp"
#include "render/sky.hpp"
#include "render/tracing.hpp"
#include "render/vertices.hpp"
#include "scene/glass_body.hpp"
#include "scene/light.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace catoptric::render {

/// A scene that stays on the device, with the data derived from it: views, probes, lights, and the
/// hierarchy for tracing. Rasterisation and tracing read the same vertices.
class GpuScene {
public:
    /// Prepares for a scene, which the first update writes. `scene` at rest fixes the scene units
    /// for all later frames. `slots`: the most frames in flight at once. Throws as
    /// check_limits (render/limits.hpp) does if the device cannot hold the scene.
    GpuScene(gpu::Device& device, const scene::Scene& scene, std::size_t slots = 1);

    /// Writes the data that differ from the last update, and nothing else. `now` is
    /// scene::scene_at of the scene given above, possibly with other transforms, materials and
    /// lights; the meshes stay. Later binds refer to slot `slot`, in which no frame may be in
    /// flight. Frames in other slots keep their own data. Costs O(n) in what has moved and O(log n)
    /// a near plane.
    void update(const scene::Scene& now, const scene::Camera& camera, uvec2 size, double ambient,
                std::size_t slot = 0);

    std::uint32_t mirror_count() const { return static_cast<std::uint32_t>(probes_.size()); }
    /// Returns whether there are so many mirrors that testing each of them costs more than a tree.
    bool uses_mirror_tree() const { return probes_.size() > kMaxMirrorsWithoutTree; }
    /// Returns whether some mirror is not an exact sphere, or emits or diffusely reflects light.
    bool has_complex_mirrors() const;
    bool has_rough_mirrors() const { return std::ranges::any_of(draw_ranges(), &DrawRange::rough); }
    /// Mirrors count from 0 here.
    bool is_rough_mirror(std::uint32_t mirror) const {
        return draw_ranges()[mirror_object(mirror)].rough;
    }
    std::uint32_t light_count() const { return static_cast<std::uint32_t>(lights_.size()); }
    /// Returns the layers of each light in shadow maps, and how many of them are drawn.
    std::uint32_t shadow_face_count() const { return shadow_faces_; }
    std::uint32_t drawn_shadow_faces(std::uint32_t light) const;
    /// Returns the result of find_backdrops() for a light: for each object, 1 if its
    /// shadow falls on nothing.
    const std::vector<std::uint8_t>& backdrops(std::uint32_t light) const {
        return backdrops_[light];
    }
    const gpu::Device& device() const { return device_; }
    const SceneUnits& scene_units() const { return space_; }
    const std::vector<DrawRange>& draw_ranges() const { return geometry_.ranges; }
    const std::vector<shared::View>& list_views() const { return views_; }
    /// Returns the index of an object. Mirrors count from 0 here.
    std::size_t mirror_object(std::uint32_t mirror) const { return mirror_objects_[mirror]; }
    /// Only mirrors that hide their own back have such a ball.
    const InnerBall& inner_ball(std::uint32_t mirror) const { return inner_balls_[mirror]; }
    /// Returns the mirror number of the object, from 1; 0: no mirror.
    std::uint32_t mirror_of(std::size_t object) const { return surfaces_[object].mirror; }
    /// Returns the flat faces of each mirror, scene units; empty for mirrors that are not flat.
    const std::vector<scene::FlatFaces>& flat_faces() const { return flats_; }
    /// Returns how far from flat a mirror may be to be drawn as a plane in this picture.
    double flat_tolerance() const { return scene::flat_tolerance(camera_, size_); }
    MirroredViewEye eye() const;
    /// Returns whether the object is a closed mirror with the camera inside, which no light from
    /// outside reaches.
    bool encloses_camera(std::size_t object) const { return hides_all_[object]; }
    /// Returns the texels that the edge of each mirror's cube needs in the picture of the last
    /// update (render/footprint.hpp); 0 for a mirror outside the picture. Costs O(n) in the
    /// mirrors' triangles.
    std::vector<double> needed_face_edges() const;
    /// Sets the edges for face=auto. An earlier frame may have found them.
    void use_face_edges(const std::vector<double>& needs) { face_needs_ = needs; }
    const std::vector<double>& used_face_edges() const { return face_needs_; }
    /// Returns one edge for all cubes: the largest need, limited by the device.
    std::uint32_t common_face_edge() const;
    /// Returns the most cubes in one array on this device.
    std::uint32_t max_cubes() const { return device_.limits().maxImageArrayLayers / 6; }
    /// Returns whether some object has an object space (DrawRange::own).
    bool has_object_spaces() const { return has_object_spaces_; }
    /// Returns the constants for building shaders that show this view. Features that the scene
    /// lacks cost nothing.
    gpu::ShaderConstants feature_constants(std::uint32_t view = kCameraViewIndex) const;
    /// Returns `feature_constants` for the tracer, plus the device's choices that are not
    /// the default (gpu/variants.hpp). Call it after `bind_tracing` with the same
    /// spheres.
    gpu::ShaderConstants tracing_constants(SphereMode spheres) const;
    /// Returns whether some surface is drawn over what is behind it. On devices that cannot blend
    /// one attachment alone, such surfaces are cut out where their alpha is small.
    bool has_blended_surfaces() const {
        return material_details_.has_blended() && device_.blends_floats();
    }
    bool has_glass() const { return material_details_.has_glass(); }
    /// Returns whether glass attenuates the light for surfaces behind the glass (option
    /// --glass-shadow tint).
    bool has_tinted_shadows() const { return material_details_.has_tinted_shadows(); }
    bool has_varying_colours() const { return material_details_.has_varying_colours(); }
    /// Returns whether rays may leave some surface in directions drawn from a lobe, or in its coat
    /// or base as drawn.
    bool has_lobes_or_coats() const {
        return material_details_.has_lobes() || material_details_.has_clear_coats();
    }
    /// Returns whether rays can aim at points drawn on lamps. Valid when passes are recorded, in
    /// frames that asked for lamp points.
    bool has_sampled_lamps() const { return has_sampled_lamps_; }
    /// Returns whether rays that leave the scene can see an environment.
    bool has_sky() const { return environment_.kind() != 0; }
    /// Returns whether an environment or ambient light lights diffuse surfaces.
    bool has_environment_light() const { return has_sky() || ambient_ > 0; }

    /// Returns the number of rays from each traced surface to the environment (option
    /// --environment-shadows); 0: objects do not hide it.
    std::uint32_t environment_shadow_rays() const { return environment_shadow_rays_; }

    static constexpr std::uint32_t kCameraViewIndex = 0;
    /// Returns the number of the first view that a frame adds to those of camera, mirrors and
    /// lights.
    std::uint32_t next_view() const { return 1 + static_cast<std::uint32_t>(scene_views_.size()); }
    /// Brings to the device what the passes of a frame have asked for: views, hierarchies, lists of
    /// lamps. Call it once, after they are declared and before they are recorded. `wait_for_slot`
    /// is called before views are overwritten that frames in flight in this slot may read.
    void fulfil(const FrameRequests& requests, const std::function<void()>& wait_for_slot);
    std::uint32_t capture_view(std::uint32_t mirror) const { return 1 + 6 * mirror; }
    std::uint32_t shadow_view(std::uint32_t light) const {
        return 1 + 6 * mirror_count() + shadow_faces_ * light;
    }

    /// Binds every buffer of the scene except the hierarchy, under its name in shaders/lib.
    void bind(graph::PassCommands& commands) const;
    void bind_sky_vertices(graph::PassCommands& commands) const;
    /// Binds the object's vertices. Call it after `bind`, before each draw.
    void bind_vertices(graph::PassCommands& commands, std::size_t object) const;

    bool has_lamp_extents() const {
        return std::ranges::any_of(world_lights_, [](const scene::PointLight& light) {
            return light.half_axes != dmat3(0);
        });
    }
    /// Binds a hierarchy that passes of this frame have asked for.
    void bind_tracing(graph::PassCommands& commands, SphereMode spheres = SphereMode::mesh) const {
        tracing_.bind(commands, spheres, slot_);
    }

    /// Returns the host milliseconds of the last update, and of hierarchies since it began.
    double update_ms() const { return update_ms_; }
    double bvh_update_ms() const { return tracing_.bvh_update_ms() - hierarchy_ms_before_; }
    /// Returns the host milliseconds of the first update and of the first write of a hierarchy.
    /// Building that hierarchy is counted apart: `first_bvh_build_ms`, 0 if nothing traces.
    double first_upload_ms() const { return first_update_ms_ + tracing_.first_bvh_write_ms(); }
    double first_bvh_build_ms() const { return tracing_.first_bvh_build_ms(); }
    /// Returns counts since construction: writes to device memory, hierarchies built, hierarchies
    /// refitted.
    std::size_t write_count() const { return uploads_ + tracing_.write_count(); }
    std::size_t built_bvhs() const { return tracing_.built_count(); }
    std::size_t refitted_bvhs() const { return tracing_.refitted_count(); }

private:
    void rebuild_layout(const scene::Scene& now);
    void find_closed_shells(const scene::Scene& now);
    void move_objects(const scene::Scene& now, const std::vector<std::size_t>& objects);
    void fill_surfaces(const scene::Scene& now);
    void fill_placements();
    void fill_lights(const scene::Scene& now, bool others);
    void fill_lamps();
    void fill_lamp_extents();
    void fill_probes(const scene::Scene& now, const SceneChanges& changes);
    /// Returns the simple body that replaces the mesh of a glass object in captures; nothing for
    /// other objects.
    std::optional<scene::GlassBody> find_glass_body(const scene::Scene& now,
                                                    const scene::Object& object);
    InnerBall make_inner_ball(std::size_t object, const dvec3& centre);
    bool is_middle_covered(std::size_t mirror) const;
    void place_probe(const scene::Scene& now, std::size_t mirror);
    std::vector<shared::View> shadow_views(const shared::Light& light) const;
    void fill_views(const scene::Camera& camera, uvec2 size);
    void fill_uniforms(double ambient);
    void write_buffers(std::size_t slot);

    gpu::Device& device_;
    SceneUnits space_;
    FrameGeometry geometry_;
    NearestTriangle nearest_;
    SceneChangeTracker seen_;
    DeviceVertices vertices_;
    /// The camera's view, those of mirrors and lights, and those that the last frame added.
    std::vector<shared::View> views_;
    std::vector<shared::View> scene_views_;          ///< views of mirrors and lights
    std::vector<scene::FlatFaces> flats_;            ///< flat faces of each mirror
    std::vector<dvec3> probe_places_, light_places_; ///< scene units
    dvec3 eye_{0};
    std::vector<shared::Surface> surfaces_;
    std::vector<shared::Probe> probes_;
    std::vector<scene::PointLight> world_lights_;
    std::vector<shared::Light> lights_;
    /// Result of find_backdrops for each light.
    std::vector<std::vector<std::uint8_t>> backdrops_;
    std::vector<std::size_t> mirror_objects_;
    std::vector<InnerBall> inner_balls_;                        ///< ball inside each mirror
    std::vector<std::optional<scene::GlassBody>> glass_bodies_; ///< body of each glass mirror
    std::vector<std::uint8_t> middle_covered_;     ///< is_middle_covered of each mirror
    std::vector<std::vector<std::size_t>> within_; ///< objects within each mirror's bounds
    std::map<std::size_t, double> closed_volumes_; ///< volumes of meshes of glass, by
                                                   ///< mesh
    std::vector<bool> hides_all_;                  ///< result of encloses_camera for each object
    std::vector<double> face_needs_;               ///< see use_face_edges
    scene::Camera camera_;                         ///< camera of the last update
    uvec2 size_{0};
    double ambient_ = 0;    ///< ambient light of the last update
    bool complete_ = false; ///< the last update finished without an exception
    bool has_object_spaces_ = false;
    bool has_lamp_table_ = false;     ///< the lamp table is that of the current scene
    bool has_sampled_lamps_ = false;  ///< the lamp table is not empty
    bool binds_lamp_extents_ = false; ///< passes of this frame draw soft shadows
    bool has_light_kinds_ = false;    ///< some light has no surface, or shines to two sides
    std::uint32_t shadow_faces_ = 6;
    std::uint32_t environment_shadow_rays_ = 0;
    std::size_t uploads_ = 0;
    std::size_t slot_ = 0, known_layouts_ = 0;
    double update_ms_ = 0, hierarchy_ms_before_ = 0, first_update_ms_ = 0;
    DeviceList view_buffer_, frame_, surface_buffer_, placement_buffer_, light_buffer_,
        probe_buffer_, mirror_tree_, lamp_buffer_, lamp_extent_buffer_;
    MaterialLists material_details_;
    DeviceEnvironment environment_;
    RayTracingTrees tracing_;
};

} // namespace catoptric::render
