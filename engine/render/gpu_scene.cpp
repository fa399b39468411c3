#include "render/gpu_scene.hpp"

#include "bvh/bvh.hpp"
#include "render/enclosure.hpp"
#include "render/footprint.hpp"
#include "render/views.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

shared::Surface surface_of(const scene::Scene& now, const scene::Object& object,
                           std::uint32_t mirror, const Space& space) {
    const scene::Material& material = now.materials[object.material];
    shared::Surface surface{};
    surface.albedo = material.mirror ? vec3(0) : material.albedo;
    surface.emission = material.emission;
    surface.reflectance = material.reflectance;
    surface.mirror = mirror;
    if (object.sphere) {
        surface.centre = space.point(object.sphere->centre);
        surface.radius = space.length(object.sphere->radius);
    }
    return surface;
}

} // namespace

GpuScene::GpuScene(gpu::Device& device, const scene::Scene& scene)
    : device_(device), space_(space_of(scene)) {}

void GpuScene::update(const scene::Scene& now, const scene::Camera& camera, uvec2 size,
                      double ambient) {
    geometry_ = make_geometry(now, space_);
    mirror_objects_ = scene::mirrors(now);
    mirror_count_ = static_cast<std::uint32_t>(mirror_objects_.size());
    surfaces_.clear();
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
        const auto found = std::ranges::find(mirror_objects_, i);
        const auto number = static_cast<std::uint32_t>(found - mirror_objects_.begin()) + 1;
        surfaces_.push_back(
            surface_of(now, now.objects[i], found == mirror_objects_.end() ? 0 : number, space_));
    }
    fill_lights(now);
    fill_views(now, camera, size);
    if (face_needs_.empty()) find_face_needs(size);
    const std::vector<shared::Frame> frame{
        {static_cast<float>(ambient), light_count_, mirror_count_,
         static_cast<std::uint32_t>(now.objects.size()), shadow_faces_}};
    std::vector<shared::Light> lights = lights_;
    lights.resize(shared::kMaxLights);
    using gpu::BufferUse;
    upload(device_, vertex_buffer_, "vertices", geometry_.vertices, BufferUse::vertex);
    upload(device_, index_buffer_, "indices", geometry_.indices, BufferUse::index);
    upload(device_, frame_, "frame", frame, BufferUse::uniform);
    upload(device_, view_buffer_, "views", views_, BufferUse::plain);
    upload(device_, surface_buffer_, "surfaces", surfaces_, BufferUse::plain);
    upload(device_, light_buffer_, "lights", lights, BufferUse::uniform);
    upload(device_, probe_buffer_, "probes", probes_, BufferUse::plain);
    fill_tracing();
}

void GpuScene::fill_lights(const scene::Scene& now) {
    lights_.clear();
    shadow_faces_ = 5;
    for (const scene::PointLight& light : scene::lights(now)) {
        const double area = light.area * space_.scale * space_.scale;
        shared::Light entry{};
        entry.position = space_.point(light.position);
        entry.normal = vec3(light.normal);
        entry.intensity = light.emission * static_cast<float>(area);
        const float gap = nearest_distance(
            geometry_, entry.position,
            [](std::size_t, const DrawRange& range) { return !range.casts_shadow; });
        const shared::View main = turned_cube_views(entry.position, entry.normal, gap)[4];
        entry.right = main.right, entry.down = main.down, entry.forward = main.forward,
        entry.near = main.near;
        lights_.push_back(entry);
        if (light.normal == dvec3(0)) shadow_faces_ = 6;
    }
    light_count_ = static_cast<std::uint32_t>(lights_.size());
    check(light_count_ <= shared::kMaxLights, Failure::exhausted, "the scene has ", light_count_,
          " lights, ", shared::kMaxLights, " are allowed");
}

bool GpuScene::has_other_mirrors() const {
    return std::ranges::any_of(geometry_.ranges, [](const DrawRange& range) {
        return range.mirror && !range.exact_sphere;
    });
}

shared::Draw GpuScene::draw_of(std::size_t object, std::uint32_t first_view) const {
    const shared::Surface& surface = surfaces_[object];
    return {first_view, surface, surface.mirror ? probes_[surface.mirror - 1].centre : vec3(0),
            static_cast<std::uint32_t>(object), 0};
}

/// Camera, then six for each mirror, then the shadow faces of each light.
void GpuScene::fill_views(const scene::Scene& now, const scene::Camera& camera, uvec2 size) {
    const vec3 eye = space_.point(camera.eye);
    views_ = {camera_view(camera, space_, size,
                          nearest_distance(geometry_, eye, [](std::size_t, const DrawRange& range) {
                              return !range.seen_by_camera;
                          }))};
    hides_all_.clear();
    for (const DrawRange& range : geometry_.ranges)
        hides_all_.push_back(range.mirror && encloses(geometry_, range, eye));
    probes_.clear();
    for (const std::size_t object : mirror_objects_) {
        const Bounds<double> bounds = scene::bounds(now, now.objects[object]);
        const vec3 centre = space_.point(bounds.centre());
        const shared::Surface& surface = surfaces_[object];
        const Bounds<float>& box = geometry_.ranges[object].bounds;
        probes_.push_back(
            {centre, surface.centre, surface.radius, surface.reflectance, box.lo, box.hi});
        const float gap = nearest_distance(
            geometry_, centre, [&](std::size_t i, const DrawRange&) { return i == object; });
        std::ranges::copy(cube_views(centre, gap), std::back_inserter(views_));
    }
    for (const shared::Light& light : lights_) {
        std::vector<shared::View> faces = turned_cube_views(light.position, light.normal, 0);
        for (shared::View& face : faces) face.near = light.near;
        faces.resize(shadow_faces_); // the last one looks back, where a one-sided light is dark
        std::ranges::copy(faces, std::back_inserter(views_));
    }
}

void GpuScene::find_face_needs(uvec2 size) {
    const Pixels pixels{views_[kCameraView], size.y};
    for (std::uint32_t mirror = 0; mirror < mirror_count_; ++mirror) {
        const DrawRange& range = geometry_.ranges[mirror_objects_[mirror]];
        const shared::Probe& probe = probes_[mirror];
        if (!range.seen_by_camera || !may_meet(pixels.view, range.bounds))
            face_needs_.push_back(0);
        else if (probe.radius > 0)
            face_needs_.push_back(sphere_need(pixels, probe.sphere, double{probe.radius}));
        else
            face_needs_.push_back(mesh_need(
                pixels, geometry_.vertices,
                std::span(geometry_.indices).subspan(range.first_index, range.index_count)));
    }
}

std::uint32_t GpuScene::common_face() const {
    return common_edge(face_needs_, device_.limits().maxImageDimensionCube);
}

void GpuScene::fill_tracing() {
    std::vector<bvh::Triangle> triangles;
    std::vector<vec4> normals;
    for (std::size_t object = 0; object < geometry_.ranges.size(); ++object) {
        const DrawRange& range = geometry_.ranges[object];
        const std::uint32_t flags = (range.seen_by_camera ? 0 : bvh::kHidden) |
                                    (range.casts_shadow ? 0 : bvh::kShadowless) |
                                    (range.exact_sphere ? bvh::kSphere : 0) |
                                    (range.one_sided ? bvh::kOneSided : 0);
        for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count;
             k += 3) {
            const auto vertex = [&](std::uint32_t j) -> const shared::Vertex& {
                return geometry_.vertices[geometry_.indices[k + j]];
            };
            triangles.push_back({vertex(0).position, vertex(1).position, vertex(2).position,
                                 static_cast<std::uint32_t>(object), flags});
            for (std::uint32_t j = 0; j < 3; ++j) normals.emplace_back(vertex(j).normal, 0.0f);
        }
    }
    const bvh::Bvh tree = bvh::build(triangles, geometry_.core);
    upload(device_, bvh_nodes_, "bvh_nodes", tree.nodes, gpu::BufferUse::texels);
    upload(device_, bvh_triangles_, "bvh_triangles", tree.triangles, gpu::BufferUse::texels);
    upload(device_, normals_, "normals", normals, gpu::BufferUse::texels);
}

void GpuScene::bind(graph::Commands& commands) const {
    commands.bind("frame", frame_);
    commands.bind("Views", view_buffer_);
    commands.bind("Surfaces", surface_buffer_);
    commands.bind("Lights", light_buffer_);
    commands.bind("Probes", probe_buffer_);
    commands.bind("bvh_nodes", bvh_nodes_);
    commands.bind("BvhNodes", bvh_nodes_);
    commands.bind("bvh_triangles", bvh_triangles_);
    commands.bind("BvhTriangles", bvh_triangles_);
    commands.bind("normals", normals_);
    commands.bind("Normals", normals_);
    commands.geometry(vertex_buffer_, index_buffer_);
}

} // namespace catoptric::render
