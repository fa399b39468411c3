#pragma once

#include "measure/comparison.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// Facts about a scene that only reports and `catoptric info` show.
namespace catoptric::measure {

/// Unsupported feature of the scene file: something left out, approximated or added.
struct UnsupportedFeatureFacts {
    std::string id;
    std::uint64_t count = 0;
    std::string first;                 ///< place of the first occurrence
    std::optional<double> pixel_share; ///< of the picture, 0..1; empty if pixels cannot tell it
};

/// Light as the shading formula sees it, in world units.
struct LightFacts {
    std::string kind; ///< "mesh", or the name of a scene::LightKind, such as "spot"
    std::string name; ///< name of a light without a surface
    dvec3 position{0};
    /// Direction in which a light shines, or in which a mesh faces. 0: all directions.
    dvec3 direction{0};
    /// Radiance of a mesh; candela of a point or spot light; lux of a directional light.
    dvec3 emission{0};
    double area = 0;          ///< area of a mesh
    bool is_parallel = false; ///< whether the light is infinitely far away
};

struct EnvironmentFacts {
    std::string name;
    double scale = 1, rotation_degrees = 0;
};

/// Lights, environment and unsupported features of a scene.
struct SceneContents {
    std::vector<LightFacts> lights;
    std::optional<EnvironmentFacts> environment;
    std::vector<UnsupportedFeatureFacts> unsupported;
};

/// Returns the contents of a scene, or contents without entries if they are not known.
inline const SceneContents& read_scene_contents(const SceneFacts& facts) {
    static const SceneContents kUnknownContents;
    return facts.contents ? *facts.contents : kUnknownContents;
}

} // namespace catoptric::measure
