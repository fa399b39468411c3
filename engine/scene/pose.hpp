#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace catoptric::scene {

Camera camera_at(const Camera& camera, double seconds);

/// Returns whether some object, light or camera moves.
bool is_animated(const Scene& scene);
/// Returns the longest period of all motions, in seconds; 0 if nothing moves.
double scene_period(const Scene& scene);

/// Sets `still` to the scene at this time, without copying a mesh or a material. `still` is a copy
/// of the scene or an earlier result of this function. Throws `Failure::usage` for a time that is
/// not finite.
void move_to_time(Scene& still, const Scene& scene, double seconds);

/// Scene at an instant, valid as long as `scene` lives. Only an animated scene is copied, with each
/// mesh. Throws as `scene_at`.
class SceneAtTime {
public:
    SceneAtTime(const Scene& scene, double seconds);
    const Scene& operator*() const { return moved_ ? *moved_ : scene_; }

private:
    const Scene& scene_;
    std::optional<Scene> moved_;
};

/// Returns the node of a rig that the motion follows, or null if it follows none.
const RigAttachment* followed_node(const Motion& motion);

/// Throws `usage` for a time that is not a finite number of seconds.
void check_time(double seconds);

} // namespace catoptric::scene
