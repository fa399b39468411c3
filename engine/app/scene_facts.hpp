#pragma once

#include "app/run.hpp"
#include "measure/comparison.hpp"

#include <vector>

namespace catoptric::app {

/// The object that the ray through each pixel's centre meets first, row by row; -1: none. Found on
/// the processor, at the request's instant; what alpha masks cut out counts. Costs a projection of
/// each triangle; where many large ones lie behind each other, a hierarchy over all instead.
std::vector<int> objects_seen(const Request& request, uvec2 size);

/// Share of the pixels that show one of these materials.
double share_of(const std::vector<int>& seen, const scene::Scene& scene,
                const std::vector<std::size_t>& materials);

/// Returns every gap of the scene with its share of the picture that `seen` (objects_seen) is of,
/// the largest share first, those without one last.
std::vector<measure::UnsupportedFeatureFacts> unsupported_facts(const scene::Scene& scene,
                                                                const std::vector<int>& seen);

/// Every light as the shading formula sees it.
std::vector<measure::LightFacts> light_facts(const scene::Scene& scene);
std::optional<measure::EnvironmentFacts> environment_facts(const scene::Scene& scene);

/// Longest side 128, of the request's shape.
uvec2 small_size(uvec2 size);

/// What a report says of the request's scene; `seen`: objects_seen of a picture that shares are of.
measure::SceneFacts scene_facts(const Request& request, const std::vector<int>& seen);
/// The same, of a picture of at most 128 pixels a side where a share is to be told.
measure::SceneFacts scene_facts(const Request& request);

} // namespace catoptric::app
