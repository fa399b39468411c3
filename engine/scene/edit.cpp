#include "scene/edit.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene {

namespace {

constexpr double kSimilar = 1e-9; // rounding error of a similarity, share of a squared length

void check_index(const char* what, std::size_t index, std::size_t count) {
    check(index < count, Failure::usage, what, " ", index, ": wanted one of the scene's ", count,
          ", from 0");
}

bool is_place(const dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1 &&
           glm::determinant(dmat3(matrix)) != 0;
}

/// Returns the factor by which the matrix lengthens every vector; nothing if it depends on the
/// vector.
std::optional<double> scale_of(const dmat3& matrix) {
    const dmat3 square = glm::transpose(matrix) * matrix;
    const double scale = (square[0][0] + square[1][1] + square[2][2]) / 3;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(square[column][row] - (column == row ? scale : 0)) > kSimilar * scale)
                return std::nullopt;
    return std::sqrt(scale);
}

std::optional<Sphere> moved(const Object& object, const dmat4& world_from_object) {
    if (!object.sphere) return std::nullopt;
    const dmat4 change = world_from_object * glm::inverse(object.world_from_object);
    const std::optional<double> scale = scale_of(dmat3(change));
    if (!scale) return std::nullopt;
    return Sphere{dvec3(change * dvec4(object.sphere->centre, 1)), object.sphere->radius * *scale};
}

void apply(Scene& scene, const Placing& edit) {
    check_index("object", edit.object, scene.objects.size());
    Object& object = scene.objects[edit.object];
    check(is_place(edit.world_from_object), Failure::usage, "object '", object.name,
          "': wanted a finite affine transform with an inverse, found another matrix");
    object.sphere = moved(object, edit.world_from_object);
    object.world_from_object = edit.world_from_object;
}

void apply(Scene& scene, const Painting& edit) {
    check_index("object", edit.object, scene.objects.size());
    check_index("material", edit.material, scene.materials.size());
    scene.objects[edit.object].material = edit.material;
}

void apply(Scene& scene, const Mixing& edit) {
    check_index("material", edit.material, scene.materials.size());
    scene.materials[edit.material] = edit.value;
}

} // namespace

void apply(Scene& scene, const Edit& edit) {
    std::visit([&](const auto& one) { apply(scene, one); }, edit);
}

} // namespace catoptric::scene
