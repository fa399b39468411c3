#include "scene/topology.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace catoptric::scene {

namespace {

/// Grid of cubes that holds vertices, to find the first vertex at a place.
class PositionGrid {
public:
    explicit PositionGrid(std::span<const dvec3> positions) : positions_(positions) {
        for (const dvec3& p : positions)
            scale_ = std::max({scale_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        if (scale_ == 0) scale_ = 1;
        next_.resize(positions.size(), kEmptyCell);
    }
    /// Returns the first vertex at the same place, or `vertex` if there was none before.
    std::size_t first_at_place(std::size_t vertex) {
        const dvec3 p = positions_[vertex] / scale_;
        const glm::i64vec3 low = cell_of(p - kPlaceDistance), high = cell_of(p + kPlaceDistance);
        std::size_t first = vertex;
        for (std::int64_t x = low.x; x <= high.x; ++x)
            for (std::int64_t y = low.y; y <= high.y; ++y)
                for (std::int64_t z = low.z; z <= high.z; ++z)
                    first = std::min(first, first_in_cell({x, y, z}, p, vertex));
        if (first == vertex) {
            const auto [entry, is_new] = newest_.try_emplace(cell_key(cell_of(p)), vertex);
            if (!is_new) next_[vertex] = std::exchange(entry->second, vertex);
        }
        return first;
    }

private:
    static constexpr double kPlaceDistance = 0x1p-21, kCellEdge = 8 * kPlaceDistance;
    static constexpr std::size_t kEmptyCell = ~std::size_t(0);

    static glm::i64vec3 cell_of(const dvec3& p) { return glm::i64vec3(glm::floor(p / kCellEdge)); }
    static std::uint64_t cell_key(const glm::i64vec3& cube) {
        std::uint64_t key = 0;
        for (int i = 0; i < 3; ++i)
            key = (key ^ static_cast<std::uint64_t>(cube[i])) * 0x9e3779b97f4a7c15u,
            key ^= key >> 32;
        return key;
    }
    std::size_t first_in_cell(const glm::i64vec3& cube, const dvec3& p, std::size_t vertex) const {
        const auto newest = newest_.find(cell_key(cube));
        std::size_t first = vertex;
        for (std::size_t i = newest == newest_.end() ? kEmptyCell : newest->second; i != kEmptyCell;
             i = next_[i]) {
            const dvec3 way = glm::abs(positions_[i] / scale_ - p);
            if (std::max({way.x, way.y, way.z}) <= kPlaceDistance) first = std::min(first, i);
        }
        return first;
    }

    std::span<const dvec3> positions_;
    double scale_ = 0;
    std::unordered_map<std::uint64_t, std::size_t> newest_; ///< last vertex added to each grid cube
    std::vector<std::size_t> next_; ///< vertex added to the same cube before
};

} // namespace

std::vector<std::size_t> weld_vertices(std::span<const dvec3> positions) {
    PositionGrid places(positions);
    std::vector<std::size_t> first(positions.size());
    for (std::size_t i = 0; i < first.size(); ++i) first[i] = places.first_at_place(i);
    return first;
}

std::vector<TriangleEdge> triangle_edges(std::span<const TriangleCorners> triangles) {
    std::vector<TriangleEdge> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const TriangleCorners& t = triangles[i];
        if (!has_distinct_corners(t)) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            sides.push_back({low, high, i, t[(k + 2) % 3]});
        }
    }
    std::ranges::sort(sides, {}, [](const TriangleEdge& side) {
        return std::tuple(side.low, side.high, side.triangle);
    });
    return sides;
}

bool is_closed_surface(std::span<const dvec3> positions, std::span<const uvec3> triangles) {
    const std::vector<std::size_t> first = weld_vertices(positions);
    std::vector<TriangleCorners> corners;
    for (const uvec3& t : triangles) corners.push_back({first[t.x], first[t.y], first[t.z]});
    bool is_closed = true;
    const std::vector<TriangleEdge> edges = triangle_edges(corners);
    for_each_edge(edges, [&](std::span<const TriangleEdge> sides) {
        is_closed = is_closed && sides.size() == 2;
    });
    return is_closed && !edges.empty();
}

double winding_number(std::span<const dvec3> positions, std::span<const uvec3> triangles,
                      const dvec3& point) {
    double angle = 0;
    for (const uvec3& t : triangles) {
        const dvec3 a = positions[t.x] - point, b = positions[t.y] - point,
                    c = positions[t.z] - point;
        const double x = length(a), y = length(b), z = length(c);
        angle += 2 * std::atan2(dot(a, cross(b, c)),
                                x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
    }
    return angle / (4 * std::numbers::pi);
}

} // namespace catoptric::scene
