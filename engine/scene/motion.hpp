#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

/// How things move. A time that is not within the keys is their first or last one.
namespace catoptric::scene {

/// translation(t) = amplitude * (1 - cos(2 pi t / period)), world units; 0 at t = 0.
struct Harmonic {
    dvec3 amplitude{0};
    double period = 1; ///< seconds, > 0
};

enum class Interpolation { step, linear, cubic };

/// Values in time, cubic Hermite as glTF's CUBICSPLINE (or linear or step).
template <typename Value>
struct Track {
    using Interpolation = scene::Interpolation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times; ///< seconds, increasing
    std::vector<Value> values;
    std::vector<Value> in_tangents, out_tangents; ///< only with `cubic`
};
using Keys = Track<dvec3>;  ///< places, or scales
using Turns = Track<dvec4>; ///< unit quaternions, w last; `linear` goes along the sphere

/// World-space translation through keys, world_from_keys * (place - rest), relative to the object's
/// place at rest. Objects share the keys that they follow.
struct Keyframes {
    std::shared_ptr<const Keys> keys; ///< none, or without a time: stands still
    dmat3 world_from_keys{1};
    dvec3 rest{0};
    bool repeats = true; ///< after the last key; else it stays there
};

/// Nodes that move within one another, those that stand still left out.
struct Rig {
    struct Node {
        std::optional<std::size_t> parent; ///< comes before it
        dmat4 parent_from_space{1};        ///< what stands still between its parent and its space
        dvec3 translation{0};              ///< at rest, in that space: where no track is
        dvec4 rotation{0, 0, 0, 1};
        dvec3 scale{1};
        std::shared_ptr<const Keys> translations, scales;
        std::shared_ptr<const Turns> rotations;
    };
    std::vector<Node> nodes;
    bool repeats = false; ///< after the last key of all; else each track stays at its last
};

/// The place of a node of a rig: world_from_node * node_from_object in place of the transform at
/// rest, which is that of the first instant; of a camera it carries eye, target and up from there.
struct Follows {
    std::shared_ptr<const Rig> rig; ///< none: stands still
    std::size_t node = 0;
    dmat4 node_from_object{1};
    bool operator==(const Follows&) const = default;
};

using Motion = std::variant<std::monostate, Harmonic, Keyframes, Follows>;

/// The keys with their places and tangents as the world has them, relative to the object's rest.
CATOPTRIC_API Keys in_the_world(const Keyframes& motion);

/// World from each of the rig's nodes. Throws nothing; costs a few hundred operations a node.
CATOPTRIC_API std::vector<dmat4> world_from_nodes(const Rig& rig, double seconds);

/// Seconds: of a motion its period, or the time of its last key; 0: it stands still.
CATOPTRIC_API double period_of(const Motion& motion);

} // namespace catoptric::scene
