#pragma once

#include "core/math.hpp"
#include "scene/scene.hpp"
#include "shared.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

/// The environment as rough surfaces reflect it.
namespace catoptric::render {

/// Equirectangular maps in the layout of scene::Environment, without its scale and rotation. Level
/// k, from 1, holds the environment filtered by the GGX lobe of a surface of roughness k /
/// SKY_LEVEL_COUNT that is seen along its normal (Karis, "Real Shading in Unreal Engine 4", 2013).
struct SkyLevels {
    /// Texels of all levels, row by row.
    std::vector<vec3> texels;
    /// Of each level: first texel, and texels of a row.
    std::array<std::uint32_t, SKY_LEVEL_COUNT> first{}, width{};
};

/// Computes the levels by filtered importance sampling (Krivanek and Colbert, "Real-time Shading
/// with Filtered Importance Sampling", 2008): each sample reads a box-filtered copy of the
/// environment whose texels are as large as the part of the lobe for which the sample stands. Takes
/// about 0.15 s. The results for the last four environments are kept, found again by the hash of
/// their texels. `environment` is not null. May be called from several threads.
std::shared_ptr<const SkyLevels>
find_sky_levels(const std::shared_ptr<const scene::Environment>& environment);

} // namespace catoptric::render
