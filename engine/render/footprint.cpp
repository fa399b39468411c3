#include "render/footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace catoptric::render {

namespace {

constexpr double kRightAngle = std::numbers::pi / 2;
constexpr std::uint32_t kMultiple = 16;

/// One triangle of a mirror.
struct Facet {
    std::array<dvec3, 3> position, normal;

    dvec3 middle() const { return (position[0] + position[1] + position[2]) / 3.0; }
    dvec3 middle_normal() const { return glm::normalize(normal[0] + normal[1] + normal[2]); }
};

/// The least and the largest normal curvature of the surface whose normals the facet interpolates:
/// the eigenvalues of the symmetric part of the matrix that takes two edges to the change of normal
/// along them.
std::array<double, 2> principal_curvatures(const Facet& facet) {
    const dvec3 edge1 = facet.position[1] - facet.position[0],
                edge2 = facet.position[2] - facet.position[0];
    const dvec3 turn1 = facet.normal[1] - facet.normal[0],
                turn2 = facet.normal[2] - facet.normal[0];
    const dvec3 u = glm::normalize(edge1),
                v = glm::normalize(glm::cross(glm::cross(edge1, edge2), edge1));
    const auto in_plane = [&](const dvec3& a, const dvec3& b) {
        return glm::dmat2(dot(a, u), dot(a, v), dot(b, u), dot(b, v));
    };
    const glm::dmat2 shape = in_plane(turn1, turn2) * glm::inverse(in_plane(edge1, edge2));
    const double a = shape[0][0], c = shape[1][1], b = (shape[0][1] + shape[1][0]) / 2;
    const double mean = (a + c) / 2, half = std::hypot((a - c) / 2, b);
    return {mean - half, mean + half};
}

double facet_need(double pixel_angle, const dvec3& eye, const Facet& facet) {
    const dvec3 to_eye = eye - facet.middle();
    const double distance = glm::length(to_eye);
    const double cosine = distance > 0 ? dot(to_eye, facet.middle_normal()) / distance : 1;
    double need = 0;
    for (const double curvature : principal_curvatures(facet)) {
        const double seen = cosine < 0 ? -curvature : curvature; // from behind a hollow is a bulge
        need = std::max(
            need, face_need(reflected_footprint(pixel_angle, distance, seen, std::abs(cosine))));
    }
    return need;
}

} // namespace

double pixel_angle(double vertical_fov_degrees, std::uint32_t height) {
    return glm::radians(vertical_fov_degrees) / height;
}

double reflected_footprint(double pixel_angle, double distance, double curvature, double cosine) {
    if (curvature == 0) return pixel_angle; // whatever the cosine
    return pixel_angle * std::max(1.0, std::abs(1 + 2 * distance * curvature / cosine));
}

double face_need(double footprint) { return kRightAngle / footprint; }

double sphere_need(double pixel_angle, double distance, double radius) {
    return face_need(
        reflected_footprint(pixel_angle, std::max(distance - radius, 0.0), 1 / radius, 1));
}

double mesh_need(double pixel_angle, const vec3& eye, std::span<const shared::Vertex> vertices,
                 std::span<const std::uint32_t> indices) {
    double need = 0;
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3) {
        Facet facet;
        for (std::size_t j = 0; j < 3; ++j) {
            const shared::Vertex& vertex = vertices[indices[k + j]];
            facet.position[j] = dvec3(vertex.position), facet.normal[j] = dvec3(vertex.normal);
        }
        const dvec3 area = glm::cross(facet.position[1] - facet.position[0],
                                      facet.position[2] - facet.position[0]);
        if (glm::length(area) > 0)
            need = std::max(need, facet_need(pixel_angle, dvec3(eye), facet));
    }
    return need;
}

std::uint32_t common_edge(std::span<const double> needs, std::uint32_t most) {
    const double need = needs.empty() ? 0 : *std::ranges::max_element(needs);
    if (!(need < most)) return most;
    const auto multiples = static_cast<std::uint32_t>(std::ceil(need / kMultiple));
    return std::min(std::max(multiples, 1u) * kMultiple, most);
}

} // namespace catoptric::render
