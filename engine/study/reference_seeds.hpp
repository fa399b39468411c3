#pragma once

#include "scene/scene.hpp"

#include <set>
#include <string>
#include <vector>

namespace catoptric::study {

using namespace session;

/// Returns the values of the seed knobs (TechniqueTraits::seed) in these rows: techniques or plans.
/// Rows without such a knob have the seed 0, so 0 is always listed.
std::set<int> row_seeds(const std::vector<std::string>& rows);

/// Seeds for the frames of a noisy reference. No seed is given twice, and none equals the seed of a
/// row. If reference and row had the same random rays, the row's error would look too small.
class ReferenceSeeds {
public:
    /// `rows`: the judged rows.
    explicit ReferenceSeeds(const std::vector<std::string>& rows) : taken_(row_seeds(rows)) {}
    /// Returns the next seed, from 1.
    int next();
    /// Reserves a seed. Returns false if a row has this seed, or if it was reserved before.
    bool reserve(int seed) { return taken_.insert(seed).second; }

private:
    std::set<int> taken_;
    int last_ = 0;
};

/// Returns whether the technique draws rays from lobes by a seed that can be set.
bool draws_lobe_rays(const std::string& technique);
/// Returns whether the technique traces light between surfaces (TechniqueTraits::paths).
bool traces_paths(const std::string& technique);
/// Returns whether the technique draws rays to the environment of this scene, which then has
/// --environment-shadows and an environment.
bool draws_environment_rays(const std::string& technique, const scene::Scene& scene);
/// Returns the text of a technique with another value of its seed knob.
std::string set_lobe_seed(const std::string& technique, int seed);
/// Returns the number of directions from lobes (TechniqueTraits::rays); 0: there is no such knob.
int find_lobe_rays(const std::string& technique);
/// Returns the text of a technique with another number of directions from lobes.
std::string set_lobe_rays(const std::string& technique, int rays);

} // namespace catoptric::study
