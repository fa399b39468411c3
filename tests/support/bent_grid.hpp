#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test {

constexpr std::uint32_t kGridEdge = 8; // points along an edge of the grid

/// Positions, normals, texture coordinates and indices of a bent grid.
struct BentGrid {
    std::vector<float> positions, normals, uv;
    std::vector<std::uint32_t> corners;

    BentGrid() {
        for (std::size_t y = 0; y < kGridEdge; ++y)
            for (std::size_t x = 0; x < kGridEdge; ++x) {
                const float u = float(x) / (kGridEdge - 1), v = float(y) / (kGridEdge - 1);
                positions.insert(positions.end(), {u, v, .3f * u * v});
                const float length = std::sqrt(1 + .09f * (u * u + v * v));
                normals.insert(normals.end(), {-.3f * v / length, -.3f * u / length, 1 / length});
                uv.insert(uv.end(), {u, 1 - v});
            }
        for (std::uint32_t y = 0; y + 1 < kGridEdge; ++y)
            for (std::uint32_t x = 0; x + 1 < kGridEdge; ++x) {
                const std::uint32_t a = y * kGridEdge + x, b = a + kGridEdge;
                corners.insert(corners.end(), {a, a + 1, b, b, a + 1, b + 1});
            }
    }
};

} // namespace test
