#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <vector>

namespace catoptric::render {

/// What a scene differs in from the one before.
struct Changes {
    bool layout = false;    ///< objects are others, or of another kind
    bool materials = false; ///< or exact spheres
    bool lights = false;
    std::vector<std::size_t> moved;
    bool shapes() const { return layout || !moved.empty(); }
};

/// What the objects of a scene looked like.
class Seen {
public:
    /// What differs from the scene that was seen last, which `now` becomes; with `anew` everything.
    Changes take_over(const scene::Scene& now, bool anew);

private:
    struct Object {
        std::size_t mesh = 0, material = 0;
        dmat4 world_from_object{1};
        std::optional<scene::Sphere> sphere;
        bool seen_by_camera = true, mirror = false;
    };
    std::vector<Object> objects_;
    std::vector<scene::Material> materials_;
    std::vector<scene::Punctual> punctual_;
};

} // namespace catoptric::render
