#include "peer_scene.hpp"

#include "render/geometry.hpp"
#include "render/views.hpp"
#include "spheres.hpp"

#include <algorithm>

namespace peers {

using namespace catoptric;

namespace {

Vector plain(const vec3& v) { return {v.x, v.y, v.z}; }

Surface surface_of(const scene::Scene& scene, const scene::Object& object) {
    const scene::Material& material = scene.materials[object.material];
    return {plain(material.albedo), plain(material.emission), plain(material.reflectance),
            scene::is_mirror(scene, object)};
}

/// Triangle k of the geometry, of one object.
bvh::Triangle triangle_at(const render::Geometry& geometry, std::size_t k) {
    const auto corner = [&](std::size_t i) {
        return geometry.vertices[geometry.indices[3 * k + i]].position;
    };
    return {corner(0), corner(1), corner(2)};
}

} // namespace

PeerScene::PeerScene(const EmbreeDevice& device, const app::Request& request, int depth, bool exact)
    : tree_(device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_HIGH) {
    add_objects(device, request, exact);
    add_view(request);
    tree_.commit();
    whitted_.tree = tree_.get();
    whitted_.depth = depth;
    whitted_.shadow_end = f32::kShadowRayEnd;
    whitted_.lift = 0x1p-20F; // scene units, of which a scene is about one across
}

void PeerScene::add_objects(const EmbreeDevice& device, const app::Request& request, bool exact) {
    const scene::Scene& scene = request.scene;
    const render::Space space = render::space_of(scene);
    const render::Geometry geometry = render::make_geometry(scene::at(scene, request.time), space);
    std::vector<bvh::Triangle> triangles;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        whitted_.surfaces.push_back(surface_of(scene, object));
        if (exact && object.sphere) {
            whitted_.spheres.push_back(
                {plain(space.point(object.sphere->centre)), space.length(object.sphere->radius)});
            whitted_.sphere_objects.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        const render::DrawRange& range = geometry.ranges[i];
        for (std::size_t k = range.first_index / 3; k < (range.first_index + range.index_count) / 3;
             ++k) {
            const auto normal = [&](std::size_t j) {
                return plain(geometry.vertices[geometry.indices[3 * k + j]].normal);
            };
            triangles.push_back(triangle_at(geometry, k));
            whitted_.normals.push_back({normal(0), normal(1), normal(2)});
            whitted_.triangle_objects.push_back(static_cast<std::uint32_t>(i));
        }
    }
    tree_.add_and_release(triangle_geometry(device, triangles));
    if (exact) tree_.add_and_release(user_spheres(device.get(), whitted_.spheres));
}

void PeerScene::add_view(const app::Request& request) {
    const render::Space space = render::space_of(request.scene);
    const scene::PointLight light = scene::lights(request.scene).at(0);
    whitted_.light_position = plain(space.point(light.position));
    whitted_.light_normal = plain(vec3(light.normal));
    whitted_.light_intensity = plain(light.emission *
                                     static_cast<float>(light.area * space.scale * space.scale));
    whitted_.ambient = static_cast<float>(request.ambient);
    const shared::View view = render::camera_view(request.camera, space, request.size, 1);
    whitted_.eye = plain(view.eye), whitted_.forward = plain(view.forward);
    whitted_.right = plain(view.right / dot(view.right, view.right));
    whitted_.down = plain(view.down / dot(view.down, view.down));
    whitted_.width = static_cast<int>(request.size.x);
    whitted_.height = static_cast<int>(request.size.y);
}

std::vector<bvh::Triangle> triangles_of(const scene::Scene& scene) {
    const render::Geometry geometry = render::make_geometry(scene::at(scene, 0),
                                                            render::space_of(scene));
    std::vector<bvh::Triangle> triangles;
    for (std::size_t k = 0; k < geometry.indices.size() / 3; ++k)
        triangles.push_back(triangle_at(geometry, k));
    return triangles;
}

} // namespace peers
