#pragma once

#include "measure/comparison.hpp"
#include "measure/scene_contents.hpp"
#include "scene/material.hpp"
#include "scene/material_facts.hpp"
#include "scene/mirror_shape.hpp"
#include "session/run.hpp"

#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::session {

/// A material as the engine interprets it.
struct MaterialInfo {
    std::string name;
    /// "mirror" (constant reflectance), "sharp" (Schlick), "rough mirror", "glass", "smooth
    /// dielectric", "rough metal", "rough dielectric", "diffuse" or "unlit". If textures vary the
    /// material, the first object with it decides the kind.
    std::string kind;
    std::size_t objects = 0; ///< number of objects with this material
    vec3 albedo{0};
    /// The values of scene::kMaterialFactors, in their order.
    std::array<float, std::size(scene::kMaterialFactors)> factors{};
    vec3 f0{0};    ///< F0 of the material's factors; a mirror's reflectance
    vec3 light{0}; ///< light that the material emits onto other surfaces; 0: none
    bool glows = false, is_masked = false, is_blended = false, is_two_sided = false;
    std::vector<std::string> textures; ///< "base colour 256x256" ...
};

struct MirrorInfo {
    std::size_t number = 0; ///< number of the mirror, from 1
    std::string name;
    scene::MirrorShape shape;
    double screen_share = 0; ///< share of the picture, 0 to 1
    dvec3 capture_centre{0}; ///< world units
    vec3 reflectance{1};     ///< head-on; the mean over the parts that are mirrors
    bool is_constant = true; ///< false: reflectance grows towards grazing angles
};

struct SceneInfo {
    measure::SceneFacts facts;
    std::size_t objects = 0, meshes = 0;
    std::size_t instances = 0;          ///< objects whose mesh an earlier object shows, too
    std::uint64_t stored_triangles = 0; ///< triangles of all meshes, each mesh counted once
    std::uint64_t geometry_bytes = 0, image_bytes = 0, file_bytes = 0;
    std::vector<MaterialInfo> materials;
    std::vector<MirrorInfo> mirrors;
    /// Names of the objects; entry n-1 is object n of pictures with --aov object.
    std::vector<std::string> object_names;
    /// Suggested `--mirror` options (candidates.hpp), only for a scene without a mirror.
    std::vector<std::string> mirror_options;
    std::vector<measure::CameraFacts> cameras;
};

/// Returns all facts of a request's scene, from its camera and at its instant. Costs rays through a
/// picture with a longest side of 128 pixels.
SceneInfo make_scene_info(const Request& request);

/// Returns the object that the ray through each pixel's centre meets first, row by row; -1: none.
/// Works on the processor, at the request's instant. Parts that alpha masks cut out count as solid.
/// Costs a projection per triangle. Costs a BVH over all triangles instead if many large ones lie
/// behind each other.
std::vector<int> find_visible_objects(const Request& request, uvec2 size);

/// Returns the share of the pixels that show one of these materials.
double pixel_share(const std::vector<int>& seen, const scene::Scene& scene,
                   const std::vector<std::size_t>& materials);

/// Returns every unsupported feature of the scene with its share of the picture `seen`
/// (find_visible_objects). The largest share comes first, and features without a share come last.
std::vector<measure::UnsupportedFeatureFacts> unsupported_features(const scene::Scene& scene,
                                                                   const std::vector<int>& seen);

/// Returns every light as the shading formula sees it.
std::vector<measure::LightFacts> light_facts(const scene::Scene& scene);
std::optional<measure::EnvironmentFacts> make_environment_facts(const scene::Scene& scene);

/// Returns the camera, which may follow a moving node, at an instant in seconds.
measure::CameraFacts make_camera_facts(const scene::Camera& moving, double seconds);

/// Returns a size of the same aspect ratio whose longest side is 128.
uvec2 thumbnail_size(uvec2 size);

/// Returns the facts that a report lists about the request's scene. `seen`: find_visible_objects of
/// the picture that shares refer to.
measure::SceneFacts make_scene_facts(const Request& request, const std::vector<int>& seen);
/// Returns the same facts. If a share is needed, it refers to a picture with a longest side of 128
/// pixels.
measure::SceneFacts make_scene_facts(const Request& request);

} // namespace catoptric::session
