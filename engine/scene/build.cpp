#include "scene/build.hpp"

#include <utility>

namespace catoptric::scene {

std::size_t add_material(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return scene.materials.size() - 1;
}

void add_mesh(Scene& scene, Mesh mesh, std::size_t material) {
    scene.objects.push_back({.name = mesh.name, .mesh = scene.meshes.size(), .material = material});
    scene.meshes.push_back(std::move(mesh));
}

void add_quad(Scene& scene, const std::string& name, std::size_t material, dvec3 a, dvec3 b,
              dvec3 c, dvec3 d) {
    add_mesh(scene, quad(name, a, b, c, d), material);
}

void add_ball(Scene& scene, const std::string& name, std::size_t material, dvec3 centre,
              double radius, int levels) {
    dmat4 world_from_object(radius);
    world_from_object[3] = dvec4(centre, 1);
    add_mesh(scene, ball(name, levels), material);
    scene.objects.back().world_from_object = world_from_object;
    scene.objects.back().sphere = Sphere{centre, radius};
}

} // namespace catoptric::scene
