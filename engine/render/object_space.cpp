#include "render/object_space.hpp"

#include "bvh/tlas.hpp"
#include "scene/material_facts.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::render {

namespace {

/// The largest stretch of a matrix that may transform rays in float.
constexpr double kMaxMatrixStretch = 64;

/// Returns the power of two that scales `size` to about 1.
double normalising_scale(double size) { return std::exp2(-std::ceil(std::log2(size))); }

Bounds<double> mesh_bounds(const scene::Mesh& mesh) {
    Bounds<double> box;
    for (const dvec3& position : mesh.positions) box.add(position);
    return box;
}

/// Returns, by mesh, whether its copies share vertices. Meshes early in the list are copied while
/// the limit allows it.
std::vector<bool> find_shared_meshes(const scene::Scene& scene) {
    std::vector<std::uint64_t> uses(scene.meshes.size());
    for (const scene::Object& object : scene.objects) ++uses[object.mesh];
    std::uint64_t copied = 0;
    std::vector<bool> shared(scene.meshes.size());
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const scene::Mesh& mesh = scene.meshes[i];
        if (uses[i] < 2 || mesh.triangles.empty()) continue;
        const std::uint64_t wanted = copied + (uses[i] - 1) * mesh.triangles.size();
        if (wanted <= kMaxCopiedTriangles)
            copied = wanted;
        else
            shared[i] = largest_component(mesh_bounds(mesh).extent()) > 0;
    }
    return shared;
}

} // namespace

bool may_share_mesh(const scene::Scene& now, const scene::Object& object) {
    const scene::Material& material = now.materials[object.material];
    const bool is_lamp = scene::is_one_sided(material) &&
                         scene::emitted_radiance(material) != vec3(0);
    return !is_lamp &&
           bvh::rounding_amplification(dmat3(object.world_from_object)) <= kMaxMatrixStretch;
}

std::vector<bool> find_sharing_objects(const scene::Scene& scene) {
    const std::vector<bool> meshes = find_shared_meshes(scene);
    std::vector<bool> objects;
    for (const scene::Object& object : scene.objects)
        objects.push_back(meshes[object.mesh] && may_share_mesh(scene, object));
    return objects;
}

bool is_small_for_distance(const scene::Scene& now, const scene::Object& object,
                           const SceneUnits& space) {
    return is_small_for_distance(scene::bounds(now, object), space.origin);
}

MeshSpace make_mesh_space(const scene::Mesh& mesh) {
    const Bounds<double> box = mesh_bounds(mesh);
    return {box.centre(), normalising_scale(largest_component(box.extent())), {}};
}

ObjectSpace make_object_space(const MeshSpace& mesh, const dmat4& world_from_object,
                              const SceneUnits& space) {
    ObjectSpace own;
    own.scene_from_own = dmat3(world_from_object) * (space.scale / mesh.unit);
    own.centre = space.to_scene(scene::transform_point(world_from_object, mesh.middle));
    const dmat3 inverse = glm::inverse(own.scene_from_own);
    own.least = 1 / std::sqrt(dot(inverse[0], inverse[0]) + dot(inverse[1], inverse[1]) +
                              dot(inverse[2], inverse[2]));
    return own;
}

ObjectSpace make_object_space(const scene::Scene& now, const scene::Object& object,
                              const SceneUnits& space) {
    const Bounds<double> box = scene::bounds(now, object);
    // Object space units in one world unit.
    const double unit = normalising_scale(largest_component(box.extent()));
    ObjectSpace own;
    own.scene_from_own = dmat3(space.scale / unit);
    own.centre = space.to_scene(object.sphere ? object.sphere->centre : box.centre());
    own.least = space.scale / unit;
    if (object.sphere) own.radius = static_cast<float>(object.sphere->radius * unit);
    return own;
}

Bounds<float> scene_bounds(const ObjectSpace& own, const Bounds<double>& box) {
    constexpr double kFloatRoundingError = 0x1p-22;
    Bounds<double> result;
    for (int corner = 0; corner < 8; ++corner)
        result.add(own.centre + own.scene_from_own * dvec3((corner & 1 ? box.lo : box.hi).x,
                                                           (corner & 2 ? box.lo : box.hi).y,
                                                           (corner & 4 ? box.lo : box.hi).z));
    const dvec3 pad = kFloatRoundingError * glm::max(glm::abs(result.lo), glm::abs(result.hi));
    return {vec3(result.lo - pad), vec3(result.hi + pad)};
}

} // namespace catoptric::render
