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
const dmat3 kYUpFromZUp{dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(0, 1, 0)};

dvec3 turn_vector(const dvec3& v) { return {v.x, v.z, -v.y}; }

void turn_transform(dmat4& world_from) {
    for (int column = 0; column < 4; ++column)
        world_from[column] = dvec4(turn_vector(dvec3(world_from[column])), world_from[column].w);
}

/// Objects that share a rig share the turned rig.
class MotionTurner {
public:
    void operator()(std::monostate&) {}
    void operator()(HarmonicMotion& motion) { motion.amplitude = turn_vector(motion.amplitude); }
    void operator()(Keyframes& motion) {
        motion.world_from_keys = kYUpFromZUp * motion.world_from_keys;
    }
    void operator()(RigAttachment& motion) {
        if (!motion.rig) return;
        std::shared_ptr<const NodeRig>& known = rigs_[motion.rig];
        if (!known) {
            NodeRig rig = *motion.rig;
            for (NodeRig::RigNode& node : rig.nodes)
                if (!node.parent) turn_transform(node.parent_from_space);
            known = std::make_shared<const NodeRig>(std::move(rig));
        }
        motion.rig = known;
    }

private:
    std::map<std::shared_ptr<const NodeRig>, std::shared_ptr<const NodeRig>> rigs_;
};

} // namespace

void turn_to_y_up(Scene& scene) {
    MotionTurner turner;
    const auto turn_motion = [&](Motion& motion) {
        std::visit([&](auto& its) { turner(its); }, motion);
    };
    for (Object& object : scene.objects) {
        turn_transform(object.world_from_object);
        turn_motion(object.motion);
        if (object.sphere) object.sphere->centre = turn_vector(object.sphere->centre);
    }
    for (Camera& camera : scene.cameras) {
        camera.eye = turn_vector(camera.eye), camera.target = turn_vector(camera.target);
        camera.up = turn_vector(camera.up);
        turner(camera.follows);
        // The camera's place at rest has turned, so the node must first undo this turn.
        camera.follows.node_from_object *= dmat4(glm::transpose(kYUpFromZUp));
    }
    for (PunctualLight& light : scene.punctual) {
        turn_transform(light.world_from_light);
        turn_motion(light.motion);
    }
}

} // namespace catoptric::scene
