#pragma once

#include "measure/scene_contents.hpp"
#include "session/run.hpp"

#include <vector>

namespace catoptric::session {

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
