#pragma once

#include "require/sight.hpp"

#include <optional>
#include <vector>

/// Why things are left out, in words.
namespace catoptric::require {

/// What the rules found beside the model.
struct Findings {
    /// Of each mirror: why the camera does not see it; none where it does.
    std::vector<std::optional<Unseen>> camera;
    /// All that sentences depend on, so that they are made anew only where it changed.
    std::vector<std::uint64_t> key;
};
void fill_key(Findings& findings, const Model& model);

/// "1", "2-5", "1-3, 7" of numbers in ascending order.
std::string ranges(const std::vector<std::size_t>& numbers);

/// Captures, faces and shadow maps that the model does without; what is said alike of several is
/// said once.
std::vector<CulledWork> left_out(const Model& model, const Findings& findings,
                                 const scene::Scene& scene);

/// A light's name, in quotes; empty where a lamp's mesh makes several lights and none has one.
std::string name_of_light(const scene::Scene& scene, std::size_t light, std::size_t count);
/// "+X -Y" ...
std::string names_of(Faces faces);

} // namespace catoptric::require
