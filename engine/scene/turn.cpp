// Turns scenes from +z up to +y up.
#include "scene/motion.hpp"
#include "scene/scene_overrides.hpp"

#include <map>
#include <memory>
#include <utility>
#include <variant>

namespace catoptric::scene {

namespace {

/// Rotation from z up to y up. Its columns are the images of the x, y and z axes.
const dmat3 kTurn{dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(0, 1, 0)};

dvec3 turned(const dvec3& v) { return {v.x, v.z, -v.y}; }

void turn(dmat4& world_from) {
    for (int column = 0; column < 4; ++column)
        world_from[column] = dvec4(turned(dvec3(world_from[column])), world_from[column].w);
}

/// Turns motions. Objects that share a rig share the turned rig.
class Turner {
public:
    void operator()(std::monostate&) {}
    void operator()(Harmonic& motion) { motion.amplitude = turned(motion.amplitude); }
    void operator()(Keyframes& motion) { motion.world_from_keys = kTurn * motion.world_from_keys; }
    void operator()(Follows& motion) {
        if (!motion.rig) return;
        std::shared_ptr<const Rig>& known = rigs_[motion.rig];
        if (!known) {
            Rig rig = *motion.rig;
            for (Rig::Node& node : rig.nodes)
                if (!node.parent) turn(node.parent_from_space);
            known = std::make_shared<const Rig>(std::move(rig));
        }
        motion.rig = known;
    }

private:
    std::map<std::shared_ptr<const Rig>, std::shared_ptr<const Rig>> rigs_;
};

} // namespace

void turn_z_up(Scene& scene) {
    Turner turner;
    const auto turn_motion = [&](Motion& motion) {
        std::visit([&](auto& its) { turner(its); }, motion);
    };
    for (Object& object : scene.objects) {
        turn(object.world_from_object);
        turn_motion(object.motion);
        if (object.sphere) object.sphere->centre = turned(object.sphere->centre);
    }
    for (Camera& camera : scene.cameras) {
        camera.eye = turned(camera.eye), camera.target = turned(camera.target);
        camera.up = turned(camera.up);
        turner(camera.follows);
        // The camera's place at rest has turned, so the node must first undo this turn.
        camera.follows.node_from_object *= dmat4(glm::transpose(kTurn));
    }
    for (Punctual& light : scene.punctual) {
        turn(light.world_from_light);
        turn_motion(light.motion);
    }
}

} // namespace catoptric::scene
