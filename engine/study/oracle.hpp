#pragma once

#include "bvh/bvh.hpp"
#include "measure/lookup.hpp"
#include "measure/picture.hpp"
#include "render/geometry.hpp"
#include "session/run.hpp"

#include <vector>

namespace catoptric::study {

using namespace session;

/// Finds on the CPU what rays of a request's camera meet, with the same mathematics as the device.
/// From this, it computes for each mirror pixel the right direction of the look-up, and what the
/// pixel looked at instead.
class TrueHitFinder {
public:
    /// Traces a ray through every pixel centre. Costs about a microsecond per ray.
    explicit TrueHitFinder(const Request& request);

    /// Judges the first-order mirror pixels of `lookup`, a row-major picture of where mirrors
    /// looked (shaders/lib/mirror.glsl). Each pixel is judged in the capture that the row looked
    /// into. `left_out`: captures lack the mirrors that are exact spheres.
    std::vector<measure::LookupError> judge_lookups(const std::vector<vec4>& lookup,
                                                    bool left_out = false) const;

    /// Returns the pixels that looked within one texel of a light's outline. `faces`: texels along
    /// an edge of each mirror's capture, entry n-1 of mirror n.
    measure::Mask find_light_edges(const std::vector<vec4>& lookup,
                                   const std::vector<std::uint32_t>& faces) const;

private:
    /// A mirror pixel whose reflected ray meets no second mirror.
    struct FirstOrderPixel {
        std::size_t pixel = 0;
        std::uint32_t mirror = 0; ///< number of the mirror, from 0
        int object = -1;          ///< object that the reflected ray meets; -1: none
        /// Point that the reflected ray meets; the ray's direction if the ray meets nothing.
        dvec3 place{0};
    };
    static constexpr int kNoObject = -1;

    void trace(const Request& request);
    /// Returns the object that the capture of `mirror` shows in a direction, in its first or second
    /// layer.
    int find_captured_object(std::uint32_t mirror, const vec3& direction, bool second_layer,
                             bool left_out) const;

    render::FrameGeometry geometry_;
    std::vector<bool> emits_; ///< whether each object emits light
    std::vector<std::size_t> mirror_objects_;
    std::vector<vec3> centres_; ///< centres of the captures
    bvh::Bvh everything_;
    std::vector<bvh::Bvh> without_; ///< entry n: all objects but mirror n
    std::vector<FirstOrderPixel> targets_;
};

} // namespace catoptric::study
