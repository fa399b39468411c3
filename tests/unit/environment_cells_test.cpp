// Tests of the list from which shaders draw directions to the bright part of an environment. The
// test decodes the texels as shaders/lib/environment.glsl does.
#include "render/environment_cells.hpp"

#include "bvh/words.hpp"
#include "core/shader_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace {

using namespace catoptric;

scene::Environment make_map_with_bright_texels(uvec2 size) {
    scene::Environment map{.size = size};
    map.texels.assign(std::size_t{size.x} * size.y, vec3(.1f, .2f, .3f));
    map.texels.front() = vec3(9); // beside the pole and the seam
    map.texels[map.texels.size() / 2 + 1] = vec3(40, 30, 20);
    return map;
}

/// Returns the density per steradian with which the shader draws the direction.
double density_of_direction(const scene::Environment& map, const render::EnvironmentCells& cells,
                            const dvec3& direction) {
    const f64::EnvironmentCell cell = f64::direction_to_environment_cell(direction, map.size.x,
                                                                         map.size.y);
    double mean = 0;
    for (const std::uint32_t row : {cell.above, cell.below})
        for (const std::uint32_t column : {cell.left, cell.right}) {
            const vec3& texel = map.texels[std::size_t{row} * map.size.x + column];
            mean += double(texel.x + texel.y + texel.z) / 4;
        }
    return std::max(mean - double(cells.threshold), 0.) * cell.sine_ratio * double(cells.density);
}

TEST(EnvironmentCells, DensityIntegratesToOneOverAllDirections) {
    for (const uvec2 size : {uvec2(16, 8), uvec2(5, 3), uvec2(4, 1)}) {
        const scene::Environment map = make_map_with_bright_texels(size);
        const render::EnvironmentCells cells = render::find_bright_cells(map);
        const int rows = 240, columns = 960; // divisible by the numbers of half cells
        double sum = 0;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                const double polar = std::numbers::pi * (row + .5) / rows,
                             azimuth = 2 * std::numbers::pi * ((column + .5) / columns - .5);
                const dvec3 direction(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                      -std::sin(polar) * std::cos(azimuth));
                sum += density_of_direction(map, cells, direction) * std::sin(polar);
            }
        sum *= 2 * std::numbers::pi / columns * std::numbers::pi / rows;
        EXPECT_NEAR(sum, 1, 1e-3) << size.x;
    }
}

/// The probability of each cell times the number of cells, over its area in the map, must be the
/// density of the directions in the cell.
TEST(EnvironmentCells, AliasTableDrawsCellsByTheirDensity) {
    const scene::Environment map = make_map_with_bright_texels({16, 8});
    const render::EnvironmentCells cells = render::find_bright_cells(map);
    const auto count = static_cast<double>(cells.texels.size());
    std::map<std::uint32_t, double> probability;
    for (const vec4& texel : cells.texels) {
        const vec4& rest = cells.texels[bvh::unpack_number(texel.y)];
        probability[bvh::unpack_number(texel.z)] += double(texel.x) / count;
        probability[bvh::unpack_number(rest.z)] += (1 - double(texel.x)) / count;
    }
    double sum = 0;
    for (const auto& [cell, share] : probability) {
        sum += share;
        const dvec3 middle = f64::environment_cell_direction(cell, .5, .5, 16, 8);
        const std::uint32_t row = cell / 16;
        const double height = (row == 0 || row == 8 ? .5 : 1) / 8,
                     sine = std::hypot(middle.x, middle.z),
                     solid_angle = height * std::numbers::pi * sine * 2 * std::numbers::pi / 16;
        EXPECT_NEAR(density_of_direction(map, cells, middle) * solid_angle, share, 1e-6) << cell;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(EnvironmentCells, UniformEnvironmentsHaveNone) {
    scene::Environment map{.size = {7, 5}};
    map.texels.assign(35, vec3(.1f, .7f, 3.3f));
    EXPECT_TRUE(render::find_bright_cells(map).texels.empty());
}

} // namespace
