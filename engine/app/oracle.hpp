#pragma once

#include "app/run.hpp"
#include "bvh/bvh.hpp"
#include "measure/lookup.hpp"
#include "measure/picture.hpp"
#include "render/geometry.hpp"

#include <vector>

namespace catoptric::app {

/// What rays really meet in a request's scene at its instant, found on the CPU with the device's
/// own mathematics: where a mirror pixel should have looked, and what it looked at instead.
class Oracle {
public:
    /// Traces every pixel centre: about a microsecond a ray.
    explicit Oracle(const Request& request);

    /// `lookup`: a picture of where mirrors looked (shaders/lib/mirror.glsl), row-major.
    /// First-order mirror pixels only, judged in the capture that the row looked into, whichever it
    /// was. `left_out`: captures without the mirrors that are exact spheres.
    std::vector<measure::LookedUp> judge(const std::vector<vec4>& lookup,
                                         bool left_out = false) const;

    /// Pixels that looked within one texel of a light's outline. `faces`: texels along an edge of
    /// each mirror's capture, entry n-1 of mirror n.
    measure::Mask at_light_edges(const std::vector<vec4>& lookup,
                                 const std::vector<std::uint32_t>& faces) const;

private:
    /// A mirror pixel whose reflected ray meets no second mirror.
    struct Target {
        std::size_t pixel = 0;
        std::uint32_t mirror = 0; ///< from 0
        int object = -1;          ///< that the reflected ray meets; -1: nothing
        dvec3 place{0};           ///< where; or, where it leaves, its direction
    };
    static constexpr int kNothing = -1;

    void trace(const Request& request);
    /// The object that capture `mirror` shows in a direction, in its first or second layer.
    int captured_object(std::uint32_t mirror, const vec3& direction, bool second_layer,
                        bool left_out) const;

    render::Geometry geometry_;
    std::vector<bool> emits_; ///< by object
    std::vector<std::size_t> mirror_objects_;
    std::vector<vec3> centres_; ///< of the captures
    bvh::Bvh everything_;
    std::vector<bvh::Bvh> without_; ///< everything but mirror n
    std::vector<Target> targets_;
};

} // namespace catoptric::app
