#include "scene/scene.hpp"

#include "scene/pose.hpp"
#include "scene/transform.hpp"

#include <algorithm>

namespace catoptric::scene {

bool is_animated(const Scene& scene) {
    const auto moves = [](const auto& thing) {
        return !std::holds_alternative<std::monostate>(thing.motion);
    };
    const auto rides = [](const Camera& camera) { return camera.follows.rig != nullptr; };
    return std::ranges::any_of(scene.objects, moves) ||
           std::ranges::any_of(scene.punctual, moves) || std::ranges::any_of(scene.cameras, rides);
}

bool is_mirror(const Scene& scene, const Object& object) {
    return object.mirror || scene.materials[object.material].mirror;
}

std::vector<std::size_t> mirrors(const Scene& scene) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        if (is_mirror(scene, scene.objects[i])) indices.push_back(i);
    return indices;
}

Bounds<double> bounds(const Scene& scene, const Object& object) {
    const Mesh& mesh = scene.meshes[object.mesh];
    // Each vertex is transformed once, however many triangles share it.
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const uvec3& triangle : mesh.triangles)
        is_used[triangle.x] = is_used[triangle.y] = is_used[triangle.z] = true;
    Bounds<double> box;
    for (std::size_t i = 0; i < is_used.size(); ++i)
        if (is_used[i]) box.add(transform_point(object.world_from_object, mesh.positions[i]));
    return box;
}

Bounds<double> bounds(const Scene& scene) {
    Bounds<double> box;
    for (const Object& object : scene.objects) box.add(bounds(scene, object));
    return box;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Object& object : scene.objects) count += scene.meshes[object.mesh].triangles.size();
    return count;
}

} // namespace catoptric::scene
