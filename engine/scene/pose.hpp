#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace catoptric::scene {

/// Makes `still`, a copy of the scene or what this made of one before, what `at` gives for the
/// instant, without copying a mesh or a material. A time that is not finite is `Failure::usage`.
void pose(Scene& still, const Scene& scene, double seconds);

/// The scene at an instant, for as long as `scene` lives. Only an animated scene is copied: `at`
/// copies each mesh. Throws as `at`.
class SceneAt {
public:
    SceneAt(const Scene& scene, double seconds);
    const Scene& operator*() const { return moved_ ? *moved_ : scene_; }

private:
    const Scene& scene_;
    std::optional<Scene> moved_;
};

/// Returns the node of a rig that the motion follows, or null where it follows none.
const Follows* followed(const Motion& motion);

/// Throws `usage` for a time that is not a finite number of seconds.
void check_time(double seconds);

} // namespace catoptric::scene
