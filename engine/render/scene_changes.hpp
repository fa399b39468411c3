#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <vector>

namespace catoptric::render {

/// The differences between a scene and the same scene at the previous update.
struct SceneChanges {
    bool layout = false;    ///< the objects differ in number or kind
    bool materials = false; ///< materials or exact spheres changed
    bool lights = false;
    std::vector<std::size_t> moved;
    bool has_shape_changes() const { return layout || !moved.empty(); }
};

/// The state of a scene's objects at the last update.
class SceneChangeTracker {
public:
    /// Returns the differences from the scene of the last call, then stores `now` in its place.
    /// `report_all`: reports all data of the scene as changed.
    SceneChanges update(const scene::Scene& now, bool report_all);

private:
    struct ObjectState {
        std::size_t mesh = 0, material = 0;
        dmat4 world_from_object{1};
        std::optional<scene::Sphere> sphere;
        bool seen_by_camera = true, mirror = false;
    };
    std::vector<ObjectState> objects_;
    std::vector<scene::Material> materials_;
    std::vector<scene::PunctualLight> punctual_;
};

} // namespace catoptric::render
