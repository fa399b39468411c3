#include "render/environment_cells.hpp"

#include "bvh/words.hpp"
#include "core/shader_math.hpp"
#include "render/alias_table.hpp"

#include <algorithm>
#include <numbers>

namespace catoptric::render {

namespace {

/// Factor of the mean brightness from which a cell is bright. It is above 1, so that rounding makes
/// no bright cells in a uniform environment.
constexpr double kBrightnessAboveMean = 1.001;

double sum_channels(const vec3& texel) {
    return double(texel.x) + double(texel.y) + double(texel.z);
}

/// Brightness of a map's cells, row by row, and their weights by solid angle.
struct CellBrightness {
    std::vector<double> values, row_weights;
    double mean = 0;
};

CellBrightness cell_brightness(const scene::Environment& map) {
    const std::uint32_t width = map.size.x, height = map.size.y;
    CellBrightness cells;
    double sum = 0, weights = 0;
    const auto value = [&](std::uint32_t column, std::uint32_t row) {
        return sum_channels(map.texels[std::size_t{row} * width + column]);
    };
    for (std::uint32_t row = 0; row <= height; ++row) {
        const bool is_at_pole = row == 0 || row == height;
        cells.row_weights.push_back((is_at_pole ? .5 : 1) *
                                    f64::environment_cell_middle_sine(row, height));
        const std::uint32_t above = row == 0 ? 0 : row - 1, below = std::min(row, height - 1);
        for (std::uint32_t left = 0; left < width; ++left) {
            const std::uint32_t right = (left + 1) % width;
            cells.values.push_back((value(left, above) + value(right, above) + value(left, below) +
                                    value(right, below)) /
                                   4);
            sum += cells.row_weights.back() * cells.values.back();
            weights += cells.row_weights.back();
        }
    }
    cells.mean = sum / weights;
    return cells;
}

} // namespace

EnvironmentCells find_bright_cells(const scene::Environment& environment) {
    const CellBrightness cells = cell_brightness(environment);
    const std::uint32_t width = environment.size.x, height = environment.size.y;
    EnvironmentCells found{.threshold = static_cast<float>(cells.mean * kBrightnessAboveMean)};
    std::vector<std::size_t> bright;
    std::vector<double> weights;
    double sum = 0;
    for (std::size_t i = 0; i < cells.values.size(); ++i) {
        const double weight = (cells.values[i] - double(found.threshold)) *
                              cells.row_weights[i / width];
        if (!(weight > 0)) continue;
        bright.push_back(i);
        weights.push_back(weight);
        sum += weight;
    }
    if (bright.empty()) return found;
    for (double& weight : weights) weight *= static_cast<double>(weights.size()) / sum;
    // A cell of weight w covers 1 / (width height) of the map, or half of this at a pole, and the
    // map covers 2 pi^2 sin(angle) steradians for each unit of its area.
    found.density = static_cast<float>(double(width) * height /
                                       (2 * std::numbers::pi * std::numbers::pi * sum));
    const std::vector<AliasCell> table = make_alias_table(std::move(weights));
    for (std::size_t i = 0; i < bright.size(); ++i)
        found.texels.emplace_back(static_cast<float>(table[i].share),
                                  bvh::pack_number(table[i].rest), bvh::pack_number(bright[i]), 0);
    return found;
}

} // namespace catoptric::render
