#include "render/gpu_scene.hpp"

#include "bvh/tlas.hpp"
#include "core/stopwatch.hpp"
#include "render/enclosure.hpp"
#include "render/face_needs.hpp"
#include "render/footprint.hpp"
#include "render/lamp_table.hpp"
#include "render/limits.hpp"
#include "render/texels.hpp"
#include "render/views.hpp"
#include "scene/capture_centre.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace catoptric::render {

namespace {

constexpr std::uint32_t kNoMirrorNumber = 0;

shared::Surface surface_entry(const scene::Object& object, const scene::Material& material,
                              std::uint32_t mirror, const SceneUnits& space) {
    shared::Surface surface{};
    // The diffuse light of a mirror matters only if the mirror reflects less than all light.
    const bool is_pure = material.mirror && material.reflectance == vec3(1);
    surface.albedo = is_pure ? vec3(0) : material.albedo;
    surface.emission = material.emission;
    surface.reflectance = material.reflectance;
    surface.mirror = mirror;
    if (object.sphere) {
        surface.centre = space.to_scene_point(object.sphere->centre);
        surface.radius = space.to_scene_length(object.sphere->radius);
    }
    return surface;
}

/// Returns the flat faces of a mirror, in scene units.
scene::FlatFaces scene_flat_faces(const SceneUnits& space, const scene::Scene& now,
                                  std::size_t object) {
    scene::FlatFaces flats = scene::find_flat_faces(now, now.objects[object]);
    for (scene::FlatFace& face : flats.faces) {
        face.point = space.to_scene(face.point);
        for (dvec3& corner : face.corners) corner = space.to_scene(corner);
    }
    return flats;
}

bool are_cameras_equal(const scene::Camera& a, const scene::Camera& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up &&
           a.vertical_fov_degrees == b.vertical_fov_degrees &&
           a.orthographic_height == b.orthographic_height;
}

/// Returns, by object, whether the scene gives it a motion.
std::vector<bool> find_moving_objects(const scene::Scene& scene) {
    std::vector<bool> moves;
    for (const scene::Object& object : scene.objects)
        moves.push_back(!std::holds_alternative<std::monostate>(object.motion));
    return moves;
}

/// Returns the scene after checking that it fits on the device.
const scene::Scene& check_fits(const gpu::Device& device, const scene::Scene& scene) {
    check_limits(scene.name, count_amounts(scene),
                 {device.max_texels(sizeof(vec4)), device.limits().maxStorageBufferRange,
                  device.max_allocation(), device.largest_heap_bytes()});
    return scene;
}

/// Returns the objects that are in all lists. `lists`: by object, 1 for an object in the list.
std::vector<std::uint8_t> intersect_flags(const std::vector<std::vector<std::uint8_t>>& lists) {
    if (lists.empty()) return {};
    std::vector<std::uint8_t> result = lists.front();
    for (const std::vector<std::uint8_t>& list : lists)
        for (std::size_t i = 0; i < result.size(); ++i) result[i] &= list[i];
    return result;
}

} // namespace

GpuScene::GpuScene(gpu::Device& device, const scene::Scene& scene, std::size_t slots)
    : device_(device), space_(make_scene_units(check_fits(device, scene))),
      vertices_(find_moving_objects(scene), slots),
      view_buffer_("views", gpu::BufferUsage::plain, slots),
      frame_("frame", gpu::BufferUsage::uniform, slots),
      surface_buffer_("surfaces", gpu::BufferUsage::texels, slots),
      placement_buffer_("placements", gpu::BufferUsage::plain, slots),
      light_buffer_("lights", gpu::BufferUsage::uniform, slots),
      probe_buffer_("probes", gpu::BufferUsage::texels, slots),
      mirror_tree_("mirror_tree", gpu::BufferUsage::texels, slots),
      lamp_buffer_("lamps", gpu::BufferUsage::texels, slots),
      lamp_extent_buffer_("lamp_extents", gpu::BufferUsage::uniform, slots),
      material_details_(slots), environment_(slots), tracing_(slots) {}

void GpuScene::update(const scene::Scene& now, const scene::Camera& camera, uvec2 size,
                      double ambient, std::size_t slot) {
    update_ms_ = 0, hierarchy_ms_before_ = tracing_.bvh_update_ms();
    const Stopwatch watch(update_ms_);
    slot_ = slot;
    const SceneChanges changes = seen_.update(now, !complete_);
    complete_ = false; // stays false if the update throws; then the next update writes all data
    if (changes.layout)
        rebuild_layout(now);
    else
        move_objects(now, changes.moved);
    const bool moves_vertices = vertices_.layout_count() != known_layouts_;
    if (changes.layout || changes.materials || moves_vertices)
        material_details_.fill(now, space_, geometry_, vertices_,
                               device_.max_texels(sizeof(std::uint32_t)));
    if (changes.has_shape_changes() || changes.materials || moves_vertices) {
        fill_surfaces(now);
        has_lamp_table_ = false;
    }
    if (changes.has_shape_changes()) fill_placements();
    known_layouts_ = vertices_.layout_count();
    if (changes.has_shape_changes() || changes.lights) fill_lights(now, changes.lights);
    const auto environment_rays = now.environment
                                      ? static_cast<std::uint32_t>(now.environment_shadows)
                                      : 0;
    if (changes.has_shape_changes() || changes.lights ||
        (environment_rays > 0) != (environment_shadow_rays_ > 0)) {
        backdrops_.clear();
        for (const shared::Light& light : lights_)
            backdrops_.push_back(find_backdrops(geometry_, light));
        // Objects behind which no light lies still hide the environment.
        tracing_.set_backdrops(environment_rays > 0 ? std::vector<std::uint8_t>()
                                                    : intersect_flags(backdrops_));
    }
    environment_.set(now.environment, material_details_.has_lobes(), now.environment_shadows > 0);
    environment_shadow_rays_ = environment_rays;
    if (changes.has_shape_changes() || changes.lights || changes.materials)
        fill_probes(now, changes);
    if (changes.has_shape_changes() || changes.lights || !are_cameras_equal(camera_, camera) ||
        size_ != size)
        fill_views(camera, size);
    fill_uniforms(ambient);
    write_buffers(slot);
    complete_ = true;
    if (first_update_ms_ == 0) first_update_ms_ = watch.elapsed_ms();
}

void GpuScene::rebuild_layout(const scene::Scene& now) {
    geometry_ = make_geometry(now, space_, VertexSpaces::object_space);
    has_object_spaces_ = std::ranges::any_of(
        geometry_.ranges, [](const DrawRange& range) { return range.own.has_value(); });
    mirror_objects_ = scene::mirrors(now);
    closed_volumes_.clear();
    find_closed_shells(now);
    nearest_.set_geometry(geometry_);
    tracing_.record_layout_change();
    vertices_.set_geometry(geometry_);
}

/// Finds the exact spheres among the mirrors whose mesh hides its own back faces.
void GpuScene::find_closed_shells(const scene::Scene& now) {
    std::map<std::size_t, bool> known; // by mesh
    for (const std::size_t object : mirror_objects_) {
        DrawRange& range = geometry_.ranges[object];
        if (!range.exact_sphere || range.masked) continue;
        const std::size_t mesh = now.objects[object].mesh;
        if (!known.contains(mesh)) known[mesh] = is_closed_shell(now.meshes[mesh]);
        range.shell = known[mesh];
    }
}

void GpuScene::move_objects(const scene::Scene& now, const std::vector<std::size_t>& objects) {
    if (std::ranges::any_of(objects, [&](std::size_t object) {
            return needs_other_space(geometry_, now, space_, object);
        }))
        return rebuild_layout(now);
    bool rebuild = false;
    for (const std::size_t object : objects) {
        const bool changed = move_object(geometry_, now, space_, object);
        nearest_.record_move(object);
        tracing_.record_move(object, changed);
        const bool unexpected = changed && vertices_.record_move(object);
        rebuild = rebuild || unexpected || geometry_.ranges[object].one_sided; // indices may change
    }
    if (rebuild)
        vertices_.set_geometry(geometry_);
    else if (!objects.empty())
        vertices_.copy_moved(geometry_);
}

void GpuScene::fill_surfaces(const scene::Scene& now) {
    surfaces_.clear();
    std::uint32_t mirrors = 0;
    for (const scene::Object& object : now.objects) {
        const scene::Material& material = now.materials[object.material];
        surfaces_.push_back(surface_entry(
            object, material, scene::is_mirror(now, object) ? ++mirrors : kNoMirrorNumber, space_));
        surfaces_.back().detail = material_details_.indices()[surfaces_.size() - 1];
    }
    // The ray traversal intersects exact spheres that are stored in object space, so the shaders'
    // list of spheres leaves them out.
    std::vector<shared::Surface> listed = surfaces_;
    for (std::size_t i = 0; i < listed.size(); ++i)
        if (geometry_.ranges[i].own && geometry_.ranges[i].own->radius > 0) listed[i].radius = 0;
    surface_buffer_.set(to_texels(listed));
}

/// Lists the triangles of lamps, for rays that aim at points on lamps.
void GpuScene::fill_lamps() {
    const std::vector<vec4> table = make_lamp_table(geometry_, surfaces_);
    has_sampled_lamps_ = !table.empty();
    if (has_sampled_lamps_) lamp_buffer_.set(table);
    has_lamp_table_ = true;
}

/// Writes the placements of object spaces: an entry for each object, or a single entry if no object
/// has an object space.
void GpuScene::fill_placements() {
    std::vector<shared::Placement> placements(has_object_spaces_ ? geometry_.ranges.size() : 1);
    for (std::size_t i = 0; has_object_spaces_ && i < placements.size(); ++i) {
        const std::optional<ObjectSpace>& own = geometry_.ranges[i].own;
        if (!own) continue;
        const dmat3& axes = own->scene_from_own;
        placements[i] = {vec3(axes[0]), vec3(axes[1]), vec3(axes[2]), vec3(own->centre),
                         bvh::float_rounding_error(own->centre)};
    }
    placement_buffer_.set(placements);
}

bool GpuScene::has_complex_mirrors() const {
    return std::ranges::any_of(geometry_.ranges, [](const DrawRange& range) {
        return range.mirror && (!range.exact_sphere || range.lit);
    });
}

/// Returns the largest ball around `centre`, scene units, that lies inside the object. Its radius
/// is 0 if the object does not hide its own back.
InnerBall GpuScene::make_inner_ball(std::size_t object, const dvec3& centre) {
    InnerBall ball{vec3(centre), 0, object};
    if (geometry_.ranges[object].shell)
        ball.radius = nearest_.distance(
            geometry_, centre, [&](std::size_t i, const DrawRange&) { return i != object; });
    return ball;
}

/// Returns whether the bounds of an object within the mirror contain the middle of its bounds. Only
/// then may something enclose the middle, which takes long to find out.
bool GpuScene::is_middle_covered(std::size_t mirror) const {
    const vec3 middle = geometry_.ranges[mirror_objects_[mirror]].bounds.centre();
    return std::ranges::any_of(within_[mirror], [&](std::size_t i) {
        const Bounds<float>& box = geometry_.ranges[i].bounds;
        return all(lessThanEqual(box.lo, middle)) && all(lessThanEqual(middle, box.hi));
    });
}

/// Sets what depends on a mirror's place, and on the places of objects within it.
void GpuScene::place_probe(const scene::Scene& now, std::size_t mirror) {
    const std::size_t object = mirror_objects_[mirror];
    const auto within = middle_covered_[mirror] ? std::span<const std::size_t>(within_[mirror])
                                                : std::span<const std::size_t>();
    probe_places_[mirror] = space_.to_scene(scene::capture_centre(now, object, within));
    flats_[mirror] = scene_flat_faces(space_, now, object);
    inner_balls_[mirror] = make_inner_ball(object, probe_places_[mirror]);
}

std::optional<scene::GlassBody> GpuScene::find_glass_body(const scene::Scene& now,
                                                          const scene::Object& object) {
    if (!scene::is_glass(now.materials[object.material])) return std::nullopt;
    const auto [volume, is_new] = closed_volumes_.try_emplace(object.mesh);
    if (is_new) volume->second = scene::closed_volume(now.meshes[object.mesh]);
    return scene::choose_glass_body(now, object, volume->second);
}

/// Fills the probes, and the views: six for each mirror, then the shadow faces of each light.
void GpuScene::fill_probes(const scene::Scene& now, const SceneChanges& changes) {
    const std::size_t known = changes.layout ? 0 : probes_.size();
    probes_.resize(mirror_objects_.size()), probe_places_.resize(mirror_objects_.size());
    flats_.resize(mirror_objects_.size()), inner_balls_.resize(mirror_objects_.size());
    glass_bodies_.resize(mirror_objects_.size()), within_.resize(mirror_objects_.size());
    middle_covered_.resize(mirror_objects_.size());
    scene_views_.clear();
    std::vector<Bounds<double>> of_objects;
    for (const DrawRange& range : geometry_.ranges)
        of_objects.push_back({dvec3(range.bounds.lo), dvec3(range.bounds.hi)});
    const auto has_moved = [&](std::size_t object) {
        return std::ranges::binary_search(changes.moved, object);
    };
    for (std::size_t mirror = 0; mirror < mirror_objects_.size(); ++mirror) {
        const std::size_t object = mirror_objects_[mirror];
        shared::Probe& probe = probes_[mirror];
        if (mirror >= known || !changes.moved.empty()) {
            const bool was_covered = middle_covered_[mirror] != 0;
            const auto before = std::exchange(within_[mirror],
                                              scene::objects_within(of_objects, object));
            middle_covered_[mirror] = is_middle_covered(mirror) ? 1 : 0;
            const bool changes_within = before != within_[mirror] ||
                                        std::ranges::any_of(before, has_moved);
            if (mirror >= known || has_moved(object) ||
                (changes_within && (was_covered || middle_covered_[mirror] != 0)))
                place_probe(now, mirror);
        }
        if (mirror >= known || changes.materials || has_moved(object))
            glass_bodies_[mirror] = find_glass_body(now, now.objects[object]);
        probe.centre = vec3(probe_places_[mirror]);
        const shared::Surface& surface = surfaces_[object];
        probe.sphere = surface.centre, probe.radius = surface.radius;
        const scene::Material& material = now.materials[now.objects[object].material];
        probe.reflectance = material.mirror ? material.reflectance : material.albedo;
        const bool is_lit = geometry_.ranges[object].lit;
        probe.kind = is_lit ? shared::kMirrorLit
                            : (material.mirror ? shared::kMirrorConstantReflectance
                                               : shared::kMirrorMetal);
        if (glass_bodies_[mirror]) probe.kind = static_cast<std::uint32_t>(*glass_bodies_[mirror]);
        if (is_lit) probe.radius = 0; // no ray is followed through the mirror
        const Bounds<float>& box = geometry_.ranges[object].bounds;
        probe.lowest = box.lo, probe.highest = box.hi;
        probe.holds = within_[mirror].empty() ? 0 : 1;
        const float gap = nearest_.distance(
            geometry_, probe_places_[mirror],
            [&](std::size_t i, const DrawRange&) { return i == object; });
        for (shared::View& view : make_cube_views(probe.centre, gap)) {
            view.eye_low = bvh::float_rounding_error(probe_places_[mirror]);
            scene_views_.push_back(view);
        }
    }
    for (std::size_t light = 0; light < lights_.size(); ++light)
        for (shared::View& view : shadow_views(lights_[light])) {
            view.eye_low = bvh::float_rounding_error(light_places_[light]);
            scene_views_.push_back(view);
        }
    probe_buffer_.set(to_texels(probes_));
    if (uses_mirror_tree()) mirror_tree_.set(build_mirror_tree(probes_));
}

void GpuScene::fill_uniforms(double ambient) {
    ambient_ = ambient;
    frame_.set(
        std::vector<shared::Frame>{{static_cast<float>(ambient), light_count(), mirror_count(),
                                    static_cast<std::uint32_t>(surfaces_.size()), shadow_faces_}});
}

std::vector<double> GpuScene::needed_face_edges() const {
    return find_needed_edges(geometry_, mirror_objects_, probes_, views_[kCameraViewIndex], eye_,
                             size_.y);
}

std::uint32_t GpuScene::common_face_edge() const {
    return choose_common_edge(face_needs_, device_.limits().maxImageDimensionCube);
}

void GpuScene::write_buffers(std::size_t slot) {
    uploads_ += vertices_.write(device_, slot) + environment_.write(device_, slot);
    for (DeviceList* buffer : {&frame_, &view_buffer_, &surface_buffer_, &placement_buffer_,
                               &light_buffer_, &probe_buffer_, &mirror_tree_, &lamp_buffer_})
        uploads_ += buffer->write(device_, slot);
    uploads_ += material_details_.write(device_, slot);
}

void GpuScene::bind(graph::PassCommands& commands) const {
    commands.bind("frame", frame_.buffer(slot_));
    commands.bind("Views", view_buffer_.buffer(slot_));
    commands.bind("surface_texels", surface_buffer_.buffer(slot_));
    commands.bind("Placements", placement_buffer_.buffer(slot_));
    commands.bind("Lights", light_buffer_.buffer(slot_));
    commands.bind("probe_texels", probe_buffer_.buffer(slot_));
    commands.bind("mirror_nodes", mirror_tree_.buffer(slot_));
    commands.bind("lamp_texels", lamp_buffer_.buffer(slot_));
    if (binds_lamp_extents_) commands.bind("LampExtents", lamp_extent_buffer_.buffer(slot_));
    material_details_.bind(commands, slot_);
    environment_.bind(commands, slot_);
    vertices_.bind(commands, slot_);
}

gpu::ShaderConstants GpuScene::feature_constants(std::uint32_t view) const {
    return {{"object_spaces", has_object_spaces() ? 1u : 0u},
            {"details", material_details_.has_varying_colours() ? 1u : 0u},
            {"masks", material_details_.has_masks() ? 1u : 0u},
            {"has_lobes", material_details_.has_lobes() ? 1u : 0u},
            {"has_clear_coats", material_details_.has_clear_coats() ? 1u : 0u},
            {"has_glass", material_details_.has_glass() ? 1u : 0u},
            {"has_nested_glass", material_details_.has_ranked_glass() ? 1u : 0u},
            {"has_blending", has_blended_surfaces() ? 1u : 0u},
            {"tints_shadows", has_tinted_shadows() ? 1u : 0u},
            {"has_normal_textures", material_details_.has_normal_textures() ? 1u : 0u},
            {"light_kinds", has_light_kinds_ ? 1u : 0u},
            {"one_light", light_count() == 1 ? 1u : 0u},
            {"environment_kind", environment_.kind()},
            {"orthographic", views_[view].parallel},
            {"mirror_tree", uses_mirror_tree() ? 1u : 0u}};
}

gpu::ShaderConstants GpuScene::tracing_constants(SphereMode spheres) const {
    gpu::ShaderConstants constants = feature_constants();
    for (const auto& constant : make_tracer_constants(device_.variant_choices(),
                                                      tracing_.largest_buffer_bytes(spheres, slot_),
                                                      device_.limits().maxStorageBufferRange))
        constants.push_back(constant);
    return constants;
}

void GpuScene::bind_sky_vertices(graph::PassCommands& commands) const {
    environment_.bind_vertices(commands, slot_);
}

void GpuScene::bind_vertices(graph::PassCommands& commands, std::size_t object) const {
    vertices_.bind(commands, slot_, object);
}

void GpuScene::fulfil(const FrameRequests& requests, const std::function<void()>& wait_for_slot) {
    views_.resize(next_view());
    views_.insert(views_.end(), requests.views().begin(), requests.views().end());
    if (!requests.views().empty()) {
        if (view_buffer_.set(views_)) wait_for_slot();
        uploads_ += view_buffer_.write(device_, slot_);
    }
    if (requests.samples_lamps()) {
        if (!has_lamp_table_) fill_lamps();
        uploads_ += lamp_buffer_.write(device_, slot_);
    }
    binds_lamp_extents_ = requests.draws_soft_shadows();
    if (binds_lamp_extents_) {
        fill_lamp_extents();
        uploads_ += lamp_extent_buffer_.write(device_, slot_);
    }
    for (const SphereMode spheres : {SphereMode::mesh, SphereMode::exact})
        if (requests.traces_rays(spheres))
            tracing_.prepare(device_, geometry_, surfaces_, spheres,
                             requests.starts_at_first_hits(), slot_);
}

} // namespace catoptric::render
