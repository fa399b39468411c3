#pragma once

#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <vector>

// Motion of objects, lights and cameras, evaluated at an instant.
namespace catoptric::scene {

using RotationTrack =
    Track<dvec4>; ///< unit quaternions, w last; `linear` interpolates along the sphere

/// Hierarchy of moving nodes. Nodes that stand still are left out.
struct NodeRig {
    struct RigNode {
        std::optional<std::size_t> parent; ///< index of the parent, which comes earlier in `nodes`
        dmat4 parent_from_space{1};        ///< product of the transforms between the parent and
                                           ///< this node that no track moves
        /// Translation at rest, in the space that `parent_from_space` maps to the parent; used if
        /// no track moves the node.
        dvec3 translation{0};
        dvec4 rotation{0, 0, 0, 1};
        dvec3 scale{1};
        std::shared_ptr<const TranslationTrack> translations, scales;
        std::shared_ptr<const RotationTrack> rotations;
    };
    std::vector<RigNode> nodes;
    /// Whether the motion starts again after the rig's last key; false: nodes stay there.
    bool repeats = false;
};

/// Returns the keys with positions and tangents in world space, relative to the object's place at
/// rest.
TranslationTrack keys_in_world(const Keyframes& motion);

/// Returns the world transform of each node of the rig. Throws nothing; costs a few hundred
/// operations a node.
std::vector<dmat4> node_transforms(const NodeRig& rig, double seconds);

/// Returns the period of a motion, or the time of its last key, in seconds; 0 if it stands still.
double motion_period(const Motion& motion);

} // namespace catoptric::scene
