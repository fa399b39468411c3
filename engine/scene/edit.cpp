#include "scene/build.hpp"

#include "core/error.hpp"
#include "scene/check.hpp"
#include "scene/moved_sphere.hpp"

#include <cmath>

namespace catoptric::scene {

namespace {

void check_edit_index(const char* what, std::size_t index, std::size_t count) {
    check(index < count, Failure::usage, what, " ", index, ": wanted one of the scene's ", count,
          ", from 0");
}

bool is_valid_transform(const dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1 &&
           glm::determinant(dmat3(matrix)) != 0;
}

void apply_edit(Scene& scene, const PlacementEdit& edit) {
    check_edit_index("object", edit.object, scene.objects.size());
    Object& object = scene.objects[edit.object];
    check(is_valid_transform(edit.world_from_object), Failure::usage, "object '", object.name,
          "': wanted a finite affine transform with an inverse, found another matrix");
    object.sphere = move_sphere(object, edit.world_from_object);
    object.world_from_object = edit.world_from_object;
}

void apply_edit(Scene& scene, const ObjectMaterialEdit& edit) {
    check_edit_index("object", edit.object, scene.objects.size());
    check_edit_index("material", edit.material, scene.materials.size());
    scene.objects[edit.object].material = edit.material;
}

void apply_edit(Scene& scene, const MaterialEdit& edit) {
    check_edit_index("material", edit.material, scene.materials.size());
    check_material(scene, edit.material, edit.value);
    scene.materials[edit.material] = edit.value;
}

void apply_edit(Scene& scene, const RemovalEdit& edit) {
    check_edit_index("object", edit.object, scene.objects.size());
    scene.objects.erase(scene.objects.begin() + static_cast<std::ptrdiff_t>(edit.object));
}

} // namespace

void apply_edit(Scene& scene, const Edit& edit) {
    std::visit([&](const auto& one) { apply_edit(scene, one); }, edit);
}

} // namespace catoptric::scene
