#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

/// Motion of objects, lights and cameras. A time before or after all keys takes the first or last
/// key.
namespace catoptric::scene {

/// translation(t) = amplitude * (1 - cos(2 pi t / period)), world units; 0 at t = 0.
struct Harmonic {
    dvec3 amplitude{0};
    double period = 1; ///< seconds, > 0
};

enum class Interpolation { step, linear, cubic };

/// Values over time. Interpolation is step, linear, or cubic Hermite as in glTF's CUBICSPLINE.
template <typename Value>
struct Track {
    using Interpolation = scene::Interpolation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times; ///< seconds, increasing
    std::vector<Value> values;
    std::vector<Value> in_tangents, out_tangents; ///< only with `cubic`
};
using Keys = Track<dvec3>;  ///< positions or scales
using Turns = Track<dvec4>; ///< unit quaternions, w last; `linear` interpolates along the sphere

/// World-space translation through keys: world_from_keys * (position - rest), relative to the
/// object's place at rest. Objects that follow the same keys share them.
struct Keyframes {
    std::shared_ptr<const Keys> keys; ///< none, or keys without times: stands still
    dmat3 world_from_keys{1};
    dvec3 rest{0};
    /// Whether the motion starts again after the last key; false: the object stays there.
    bool repeats = true;
};

/// Hierarchy of moving nodes. Nodes that stand still are left out.
struct Rig {
    struct Node {
        std::optional<std::size_t> parent; ///< index of the parent, which comes earlier in `nodes`
        dmat4 parent_from_space{1}; ///< still transforms between the parent and this node's space
        /// Translation at rest, in the space that `parent_from_space` maps to the parent; used if
        /// no track moves the node.
        dvec3 translation{0};
        dvec4 rotation{0, 0, 0, 1};
        dvec3 scale{1};
        std::shared_ptr<const Keys> translations, scales;
        std::shared_ptr<const Turns> rotations;
    };
    std::vector<Node> nodes;
    /// Whether the motion starts again after the rig's last key; false: nodes stay there.
    bool repeats = false;
};

/// Attachment to a node of a rig. The transform is world_from_node * node_from_object. It replaces
/// the transform at rest, which is the transform of the first instant. For a camera, it carries
/// eye, target and up from their values at rest.
struct Follows {
    std::shared_ptr<const Rig> rig; ///< none: stands still
    std::size_t node = 0;
    dmat4 node_from_object{1};
    bool operator==(const Follows&) const = default;
};

using Motion = std::variant<std::monostate, Harmonic, Keyframes, Follows>;

/// Returns the keys with positions and tangents in world space, relative to the object's place at
/// rest.
CATOPTRIC_API Keys in_the_world(const Keyframes& motion);

/// Returns the world transform of each node of the rig. Throws nothing; costs a few hundred
/// operations a node.
CATOPTRIC_API std::vector<dmat4> world_from_nodes(const Rig& rig, double seconds);

/// Returns the period of a motion, or the time of its last key, in seconds; 0 if it stands still.
CATOPTRIC_API double period_of(const Motion& motion);

} // namespace catoptric::scene
