#include "render/lamp_table.hpp"

#include "bvh/words.hpp"
#include "render/alias_table.hpp"

#include <cstdint>
#include <numeric>

namespace catoptric::render {

namespace {

struct LampTriangle {
    dvec3 corner, second, third; ///< a corner, and the vectors from it to the two other corners
    double power;                ///< sum of the emission's channels times area
    std::uint32_t object;
};

/// Appends the object's triangles that have an area.
void add_lamp_triangles(const FrameGeometry& geometry, std::size_t object, double strength,
                        std::vector<LampTriangle>& triangles) {
    const DrawRange& range = geometry.ranges[object];
    for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; k += 3) {
        const auto corner = [&](std::uint32_t j) {
            const dvec3 own(geometry.vertices[geometry.indices[k + j]].position);
            return range.own ? range.own->centre + range.own->scene_from_own * own : own;
        };
        const dvec3 a = corner(0), b = corner(1) - a, c = corner(2) - a;
        const double power = strength * glm::length(glm::cross(b, c)) / 2;
        if (power > 0) triangles.push_back({a, b, c, power, static_cast<std::uint32_t>(object)});
    }
}

} // namespace

std::vector<vec4> make_lamp_table(const FrameGeometry& geometry,
                                  std::span<const shared::Surface> surfaces) {
    std::vector<LampTriangle> triangles;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const double strength = double(surfaces[i].emission.x) + double(surfaces[i].emission.y) +
                                double(surfaces[i].emission.z);
        if (!(strength > 0)) continue;
        count += geometry.ranges[i].index_count / 3;
        if (count > kMaxLampTriangles) return {};
        add_lamp_triangles(geometry, i, strength, triangles);
    }
    if (triangles.empty()) return {};
    const double power = std::accumulate(
        triangles.begin(), triangles.end(), 0.0,
        [](double sum, const LampTriangle& triangle) { return sum + triangle.power; });
    std::vector<double> weights;
    for (const LampTriangle& triangle : triangles)
        weights.push_back(triangle.power / power * static_cast<double>(triangles.size()));
    const std::vector<AliasCell> cells = make_alias_table(std::move(weights));
    std::vector<vec4> texels{{static_cast<float>(1 / power),
                              bvh::pack_number(static_cast<std::uint32_t>(triangles.size())), 0,
                              0}};
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        texels.emplace_back(vec3(triangles[i].corner), static_cast<float>(cells[i].share));
        texels.emplace_back(vec3(triangles[i].second), bvh::pack_number(cells[i].rest));
        texels.emplace_back(vec3(triangles[i].third), bvh::pack_number(triangles[i].object));
    }
    return texels;
}

} // namespace catoptric::render
