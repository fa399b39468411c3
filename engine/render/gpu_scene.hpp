#pragma once

#include "graph/commands.hpp"
#include "render/backdrop.hpp"
#include "render/changes.hpp"
#include "render/material_parameters.hpp"
#include "render/mirror_tree.hpp"
#include "render/mirrored.hpp"
#include "render/nearest.hpp"
#include "render/resident.hpp"
#include "render/sky.hpp"
#include "render/tracing.hpp"
#include "render/vertices.hpp"

#include <memory>

namespace catoptric::render {

/// A scene that stays on the device, and everything derived from it: views, probes, lights, the
/// hierarchy for tracing. Both worlds read the same vertices.
class GpuScene {
public:
    /// `scene` at rest fixes the units for good. `slots`: frames that may be in flight at once.
    /// Throws as check_limits does (render/limits.hpp) for what the device cannot hold.
    GpuScene(gpu::Device& device, const scene::Scene& scene, std::size_t slots = 1);

    /// Writes what differs from the update before, and nothing where nothing does. `now` is
    /// scene::at of the scene given above, or that with other transforms, materials and lights; the
    /// meshes stay. What is bound from here on belongs to slot `slot`, of which no frame may be in
    /// flight; frames of the others keep what they were recorded with.
    /// Costs O(n) in what has moved, O(log n) a near plane.
    void update(const scene::Scene& now, const scene::Camera& camera, uvec2 size, double ambient,
                std::size_t slot = 0);

    std::uint32_t mirror_count() const { return static_cast<std::uint32_t>(probes_.size()); }
    /// So many that looking through all of them one by one costs more than what sorts them.
    bool uses_mirror_bvh() const { return probes_.size() > kFewMirrors; }
    /// Whether some mirror is no exact sphere.
    bool has_other_mirrors() const;
    std::uint32_t light_count() const { return static_cast<std::uint32_t>(lights_.size()); }
    /// Layers of each light in shadow maps, and how many of them are drawn.
    std::uint32_t shadow_faces() const { return shadow_faces_; }
    std::uint32_t drawn_shadow_faces(std::uint32_t light) const;
    /// By object: see find_backdrops.
    const std::vector<std::uint8_t>& backdrops(std::uint32_t light) const {
        return backdrops_[light];
    }
    const gpu::Device& device() const { return device_; }
    const Space& space() const { return space_; }
    const std::vector<DrawRange>& ranges() const { return geometry_.ranges; }
    const std::vector<shared::View>& views() const { return views_; }
    /// Index of the object that is mirror n, n from 0.
    std::size_t mirror_object(std::uint32_t mirror) const { return mirror_objects_[mirror]; }
    /// The number of the mirror that the object is, from 1; 0: it is none.
    std::uint32_t mirror_of(std::size_t object) const { return surfaces_[object].mirror; }
    /// Of each mirror, scene units; nothing for those that are not flat.
    const std::vector<scene::FlatFaces>& flat_mirrors() const { return flats_; }
    /// How far from flat a mirror may be that is drawn as a plane in this picture.
    double flat_tolerance() const { return scene::flat_tolerance(camera_, size_); }
    /// What views in mirrors start from.
    Eye eye() const;
    /// Whether the object is a closed mirror with the camera inside, where no light from outside
    /// arrives.
    bool hides_all_from_camera(std::size_t object) const { return hides_all_[object]; }
    /// Texels that the edge of each mirror's cube needs (render/footprint.hpp); 0 for a mirror that
    /// is not in the picture. Found at the first update and kept: cubes that change their size lose
    /// what the frame before left.
    const std::vector<double>& face_needs() const { return face_needs_; }
    /// They are found anew at the next update.
    void forget_face_needs() { face_needs_.clear(); }
    bool knows_face_needs() const { return face_needs_.size() == mirror_objects_.size(); }
    /// Those of another sequence of frames, in place of the ones found so far.
    void put_face_needs(std::vector<double> needs) { face_needs_ = std::move(needs); }
    /// One edge for all: the largest need, as far as the device allows.
    std::uint32_t common_face() const;
    /// Cubes that the device keeps in one array.
    std::uint32_t most_cubes() const { return device_.limits().maxImageArrayLayers / 6; }
    /// Whether some object has (DrawRange::own).
    bool has_object_spaces() const { return has_object_spaces_; }
    /// What shaders that show this view are to be built for; what the scene has not got costs
    /// nothing.
    gpu::Constants features(std::uint32_t view = kCameraView) const;
    /// The same for the tracer, with what the device has otherwise than by default
    /// (gpu/variants.hpp). After `bind_tracing` of these spheres.
    gpu::Constants tracing_features(Spheres spheres) const;
    /// Whether some surface is more than one colour.
    bool has_details() const { return details_.any(); }
    /// Whether something is seen where the scene ends.
    bool has_sky() const { return sky_.kind() != 0; }

    static constexpr std::uint32_t kCameraView = 0;
    /// Before a frame's passes are declared: no views but the scene's own.
    void begin_frame() const;
    /// One more view for passes of this frame; its number. Costs a write of all views where it is
    /// another than that of the frame before.
    std::uint32_t add_view(const shared::View& view) const;
    /// After they are declared: whether `prepare` writes views, so that no frame may be in flight
    /// in this slot.
    bool has_new_views() const;
    std::uint32_t capture_view(std::uint32_t mirror) const { return 1 + 6 * mirror; }
    std::uint32_t shadow_view(std::uint32_t light) const {
        return 1 + 6 * mirror_count() + shadow_faces_ * light;
    }

    /// Binds every buffer of the scene but the hierarchy under the name it has in shaders/lib.
    void bind(graph::Commands& commands) const;
    /// Binds the triangle that the sky is drawn with.
    void bind_sky_vertices(graph::Commands& commands) const;
    /// Binds the object's vertices. After `bind`, before each draw.
    void bind_vertices(graph::Commands& commands, std::size_t object) const;

    /// Said by a pass that traces, when it is declared.
    void want_tracing(Spheres spheres = Spheres::mesh) const {
        wants_tracing_[static_cast<std::size_t>(spheres)] = true;
    }
    /// After the frame's passes are declared: writes the views that were added; makes the hierarchy
    /// if one of them wants it and it is not up to date.
    void prepare() const;
    /// Binds the hierarchy; makes it first where nobody has prepared it.
    void bind_tracing(graph::Commands& commands, Spheres spheres = Spheres::mesh) const;

    /// Milliseconds of the host since this update began.
    double update_ms() const { return update_ms_; }
    double hierarchy_ms() const { return tracing_->ms() - hierarchy_ms_before_; }
    /// The first update, and the first way of a hierarchy to the device; building that apart, 0
    /// where nobody traces.
    double first_upload_ms() const { return first_update_ms_ + tracing_->first_write_ms(); }
    double first_build_ms() const { return tracing_->first_build_ms(); }
    /// Since the scene was made: writes of device memory, and what became of hierarchies.
    std::size_t uploads() const { return uploads_ + tracing_->writes(); }
    std::size_t hierarchies_built() const { return tracing_->built(); }
    std::size_t hierarchies_refitted() const { return tracing_->refitted(); }

private:
    void lay_out(const scene::Scene& now);
    void find_shells(const scene::Scene& now);
    void move(const scene::Scene& now, const std::vector<std::size_t>& objects);
    void fill_surfaces(const scene::Scene& now);
    void fill_placements();
    void fill_lights(const scene::Scene& now, bool others);
    void fill_probes(const scene::Scene& now, const Changes& changes);
    std::vector<shared::View> shadow_views(const shared::Light& light) const;
    void fill_views(const scene::Camera& camera, uvec2 size);
    void fill_frame(double ambient);
    void write(std::size_t slot);

    gpu::Device& device_;
    Space space_;
    Geometry geometry_;
    Nearest nearest_;
    Seen seen_;
    Vertices vertices_;
    mutable std::vector<shared::View> views_;        ///< all
    std::vector<shared::View> scene_views_;          ///< of mirrors and lights
    mutable std::size_t added_views_ = 0;            ///< the last of `views_`, of this frame alone
    std::vector<scene::FlatFaces> flats_;            ///< of mirrors
    std::vector<dvec3> probe_places_, light_places_; ///< scene units
    dvec3 eye_{0};
    std::vector<shared::Surface> surfaces_;
    std::vector<shared::Probe> probes_;
    std::vector<scene::PointLight> world_lights_;
    std::vector<shared::Light> lights_;
    std::vector<std::vector<std::uint8_t>> backdrops_; ///< by light
    std::vector<std::size_t> mirror_objects_;
    std::vector<bool> hides_all_; ///< by object
    std::vector<double> face_needs_;
    scene::Camera camera_; ///< of the last update
    uvec2 size_{0};
    bool complete_ = false; ///< the last update came to its end
    bool has_object_spaces_ = false;
    bool has_light_kinds_ = false; ///< some light has no surface, or two sides
    std::uint32_t shadow_faces_ = 6;
    mutable std::size_t uploads_ = 0;
    std::size_t slot_ = 0, known_layouts_ = 0;
    double update_ms_ = 0, hierarchy_ms_before_ = 0, first_update_ms_ = 0;
    mutable Resident view_buffer_;
    Resident frame_, surface_buffer_, placement_buffer_, light_buffer_, probe_buffer_, mirror_tree_;
    MaterialParameterLists details_;
    Sky sky_;
    std::unique_ptr<Tracing> tracing_;
    mutable std::array<bool, 2> wants_tracing_{}; ///< by Spheres
};

} // namespace catoptric::render
