#include "render/footprint.hpp"

#include "core/shader_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace catoptric::render {

namespace {

constexpr double kRightAngle = std::numbers::pi / 2;
constexpr std::uint32_t kEdgeMultiple = 16;

struct MirrorFacet {
    std::array<dvec3, 3> position, normal;

    dvec3 centre() const { return (position[0] + position[1] + position[2]) / 3.0; }
    dvec3 mean_normal() const { return glm::normalize(normal[0] + normal[1] + normal[2]); }
};

/// Returns the least and the largest normal curvature of the surface with the facet's interpolated
/// normals. They are the eigenvalues of the symmetric part of the matrix that maps two edges to the
/// change of normal along them.
std::array<double, 2> principal_curvatures(const MirrorFacet& facet) {
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

/// Returns the inward normals of the planes through the eye that bound the picture.
std::array<dvec3, 5> picture_planes(const shared::View& view) {
    const dvec3 forward(view.forward), right(view.right), down(view.down);
    return {forward, forward + right, forward - right, forward + down, forward - down};
}

bool is_in_picture(const PixelGrid& pixels, const MirrorFacet& facet) {
    return std::ranges::none_of(picture_planes(pixels.view), [&](const dvec3& inward) {
        return std::ranges::all_of(facet.position, [&](const dvec3& corner) {
            return dot(inward, corner - dvec3(pixels.view.eye)) <= 0;
        });
    });
}

/// Returns the cosine of the angle between the axis and a point; 0 at the eye.
double cosine_to_view(const shared::View& view, const dvec3& place) {
    const dvec3 seen = place - dvec3(view.eye);
    const double distance = glm::length(seen);
    return distance > 0 ? dot(seen, dvec3(view.forward)) / distance : 0;
}

double edge_for_facet(const PixelGrid& pixels, const MirrorFacet& facet) {
    double to_axis = 1;
    for (const dvec3& corner : facet.position)
        to_axis = std::min(to_axis, cosine_to_view(pixels.view, corner));
    const double pixel_angle = pixels.pixel_angle(to_axis);
    const dvec3 to_eye = dvec3(pixels.view.eye) - facet.centre();
    const double distance = glm::length(to_eye);
    const double cosine = distance > 0 ? dot(to_eye, facet.mean_normal()) / distance : 1;
    double need = 0;
    for (const double curvature : principal_curvatures(facet)) {
        // The back of a concave mirror is convex.
        const double seen = cosine < 0 ? -curvature : curvature;
        need = std::max(need, edge_for_footprint(
                                  pixel_footprint(pixel_angle, distance, seen, std::abs(cosine))));
    }
    return need;
}

} // namespace

double PixelGrid::corner_cosine() const {
    const double across = 1 / glm::length(dvec3(view.right)),
                 up = 1 / glm::length(dvec3(view.down));
    return 1 / std::sqrt(1 + across * across + up * up);
}

double PixelGrid::pixel_angle(double cosine) const {
    const double at_most = std::max(cosine, corner_cosine());
    return 2 / (glm::length(dvec3(view.down)) * height) * at_most * at_most;
}

double pixel_footprint(double pixel_angle, double distance, double curvature, double cosine) {
    if (curvature == 0) return pixel_angle; // holds for any cosine
    return pixel_angle * std::max(1.0, std::abs(1 + 2 * distance * curvature / cosine));
}

double edge_for_footprint(double footprint) { return kRightAngle / footprint; }

double edge_for_sphere(const PixelGrid& pixels, const vec3& centre, double radius) {
    const dvec3 seen = dvec3(centre) - dvec3(pixels.view.eye);
    for (const dvec3& inward : picture_planes(pixels.view))
        if (dot(inward, seen) <= -radius * glm::length(inward)) return 0;
    const double distance = glm::length(seen);
    if (distance <= radius) return edge_for_footprint(pixels.pixel_angle(0));
    // Samples the sphere in the plane of the axis and its centre, outwards from the centre, because
    // pixels shrink in that direction.
    const double axis = std::acos(glm::clamp(cosine_to_view(pixels.view, dvec3(centre)), -1., 1.));
    constexpr int kCurvatureRadiusSamples = 64;
    double need = 0;
    for (int k = 0; k < kCurvatureRadiusSamples; ++k) {
        const double across = k * radius /
                              kCurvatureRadiusSamples; // distance of the ray from the centre
        const double cosine = std::sqrt(1 - across * across / (radius * radius));
        const double along = std::sqrt(distance * distance - across * across) - radius * cosine;
        const double pixel = pixels.pixel_angle(std::cos(axis + std::asin(across / distance)));
        need = std::max(need,
                        edge_for_footprint(pixel_footprint(pixel, along, 1 / radius, cosine)));
    }
    return need;
}

double edge_for_mesh(const PixelGrid& pixels, std::span<const shared::Vertex> vertices,
                     std::span<const std::uint32_t> indices) {
    double need = 0;
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3) {
        MirrorFacet facet;
        for (std::size_t j = 0; j < 3; ++j) {
            const shared::Vertex& vertex = vertices[indices[k + j]];
            facet.position[j] = dvec3(vertex.position), facet.normal[j] = dvec3(vertex.normal);
        }
        const dvec3 area = glm::cross(facet.position[1] - facet.position[0],
                                      facet.position[2] - facet.position[0]);
        if (glm::length(area) > 0 && is_in_picture(pixels, facet))
            need = std::max(need, edge_for_facet(pixels, facet));
    }
    return need;
}

double edge_for_lobe(double alpha) { return f64::alpha_of_capture_level(1., 1.) / alpha; }

std::uint32_t choose_common_edge(std::span<const double> needs, std::uint32_t most) {
    const double need = needs.empty() ? 0 : *std::ranges::max_element(needs);
    if (!(need < most)) return most;
    const auto multiples = static_cast<std::uint32_t>(std::ceil(need / kEdgeMultiple));
    return std::min(std::max(multiples, 1u) * kEdgeMultiple, most);
}

} // namespace catoptric::render
