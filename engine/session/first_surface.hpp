#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

// What each pixel of a picture shows first, and how its reflection was made.
namespace catoptric::session {

/// What the camera ray through each pixel's centre meets first, row by row from the top. Does not
/// depend on techniques: all spheres are the triangles that the rasteriser draws.
struct FirstSurfaces {
    /// Way along the ray from the camera, or from the camera's plane if it is orthographic, in
    /// world units; infinity: no surface.
    std::vector<float> distance;
    /// Unit shading normal in world space: interpolated between vertices, bent by a texture of
    /// normals, and turned to the camera if the material is two-sided. (0, 0, 0): no surface.
    std::vector<vec3> normal;
    std::vector<std::uint32_t> object; ///< index into Scene::objects plus 1; 0: no surface
    std::vector<std::uint32_t> mirror; ///< number of the mirror, from 1; 0: no mirror
    /// Roughness of the material with its texture, 0 to 1; 0 for a mirror that reflects all light
    /// alike (Material::mirror) and for no surface.
    std::vector<float> roughness;
};

/// How the reflection in a pixel was made. The numbers are those of pictures with --aov tier.
enum class ReflectionTier : std::uint8_t {
    none,        ///< the pixel shows no mirror, or a mirror without a reflection
    capture,     ///< looked up in a capture, which shows a surface there
    environment, ///< looked up in a capture, where the ray leaves the scene
    unknown,     ///< the search in a capture found no answer, so the pixel shows its best guess
    traced,      ///< ray traced
    mirrored     ///< a mirrored view of the scene, drawn for a flat mirror
};

struct TierInfo {
    std::string_view name, help;
};
/// Returns the tiers in the order of their numbers.
const std::vector<TierInfo>& reflection_tiers();

/// The tiers of a frame's pixels.
struct ReflectionTiers {
    /// Tier of all pixels of each mirror, entry n-1 of mirror n; none: see `of_pixel`.
    std::vector<ReflectionTier> of_mirror;
    /// Tier by pixel of mirrors that look into captures or leave pixels to rays. Empty: there are
    /// no such mirrors.
    std::vector<ReflectionTier> of_pixel;

    /// Returns the tier of a pixel that shows a mirror, from 1, or none (0).
    ReflectionTier tier_at(std::size_t pixel, std::uint32_t mirror) const;
};

} // namespace catoptric::session
