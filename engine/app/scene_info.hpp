#pragma once

#include "app/run.hpp"
#include "measure/comparison.hpp"
#include "scene/mirror_shape.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::app {

/// A material as it is understood.
struct MaterialInfo {
    std::string name;
    /// "mirror" (constant reflectance), "sharp" (Schlick), "smooth dielectric", "rough metal",
    /// "diffuse" or "unlit"; where textures vary it, what most tells of the first object with it.
    std::string kind;
    std::size_t objects = 0; ///< that have it
    vec3 albedo{0};
    float metallic = 0, roughness = 1;
    vec3 f0{0};    ///< of its factors; a mirror's reflectance
    vec3 light{0}; ///< what it lights others with; 0: nothing
    bool glows = false, is_masked = false, is_two_sided = false;
    std::vector<std::string> textures; ///< "base colour 256x256" ...
};

struct MirrorInfo {
    std::size_t number = 0; ///< from 1
    std::string name;
    scene::Shape shape;
    double screen_share = 0; ///< of the picture
    dvec3 capture_centre{0}; ///< world units
    vec3 reflectance{1};     ///< straight on; the mean over what of it is a mirror
    bool is_constant = true; ///< else grows towards grazing angles
};

struct SceneInfo {
    measure::SceneFacts facts;
    std::size_t objects = 0, meshes = 0;
    std::size_t instances = 0; ///< objects that show a mesh which another shows before them
    std::uint64_t stored_triangles = 0; ///< of meshes, each once
    std::uint64_t geometry_bytes = 0, image_bytes = 0, file_bytes = 0;
    std::vector<MaterialInfo> materials;
    std::vector<MirrorInfo> mirrors;
    std::vector<std::string> mirror_options; ///< candidates.hpp; only without a mirror
    std::vector<measure::CameraFacts> cameras;
};

/// What there is to say of a request's scene, from its camera and at its instant. Costs rays
/// through a picture of 128 pixels a side.
SceneInfo scene_info(const Request& request);

} // namespace catoptric::app
