#include "scene/moved_sphere.hpp"

#include "scene/motion.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene {

namespace {

constexpr double kSimilarityTolerance =
    1e-9; // rounding error of a similarity, share of a squared length

bool is_positive_and_uniform(const dvec3& scale) {
    return scale.x > 0 && scale.x == scale.y && scale.x == scale.z;
}

bool is_similarity(const dmat4& matrix) {
    const std::optional<double> scale = uniform_scale(dmat3(matrix));
    return scale && *scale > 0;
}

} // namespace

std::optional<double> uniform_scale(const dmat3& matrix) {
    const dmat3 square = glm::transpose(matrix) * matrix;
    const double scale = (square[0][0] + square[1][1] + square[2][2]) / 3;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(square[column][row] - (column == row ? scale : 0)) <=
                  kSimilarityTolerance * scale))
                return std::nullopt;
    return std::sqrt(scale);
}

std::optional<Sphere> move_sphere(const Object& object, const dmat4& world_from_object) {
    if (!object.sphere) return std::nullopt;
    const dmat4 change = world_from_object * glm::inverse(object.world_from_object);
    const std::optional<double> scale = uniform_scale(dmat3(change));
    if (!scale) return std::nullopt;
    return Sphere{dvec3(change * dvec4(object.sphere->centre, 1)), object.sphere->radius * *scale};
}

bool preserves_spheres(const RigAttachment& follows) {
    if (!is_similarity(follows.node_from_object)) return false;
    for (std::optional<std::size_t> at = follows.node; at; at = follows.rig->nodes[*at].parent) {
        const NodeRig::RigNode& node = follows.rig->nodes[*at];
        if (!is_similarity(node.parent_from_space)) return false;
        if (!node.scales || node.scales->times.empty()) {
            if (!is_positive_and_uniform(node.scale)) return false;
        } else if (node.scales->interpolation == Interpolation::cubic ||
                   !std::ranges::all_of(node.scales->values, is_positive_and_uniform))
            return false;
    }
    return true;
}

} // namespace catoptric::scene
