// Which way is up.
#include "scene/wishes.hpp"

#include <map>
#include <type_traits>
#include <variant>

namespace catoptric::scene {

namespace {

/// y from z: columns are where x, y and z go.
const dmat3 kTurn{dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(0, 1, 0)};

dvec3 turned(const dvec3& v) { return {v.x, v.z, -v.y}; }

void turn(dmat4& world_from) {
    for (int column = 0; column < 4; ++column)
        world_from[column] = dvec4(turned(dvec3(world_from[column])), world_from[column].w);
}

/// Rigs turn as wholes, and what follows one goes on sharing it.
class Turner {
public:
    void turn(Motion& motion) {
        std::visit([this](auto& its) { turn(its); }, motion);
    }
    void turn(Follows& follows) {
        if (!follows.rig) return;
        std::shared_ptr<const Rig>& turned_rig = rigs_[follows.rig];
        if (!turned_rig) {
            Rig rig = *follows.rig;
            for (Rig::Node& node : rig.nodes)
                if (!node.parent) scene::turn(node.parent_from_space);
            turned_rig = std::make_shared<const Rig>(std::move(rig));
        }
        follows.rig = turned_rig;
    }

private:
    void turn(std::monostate&) {}
    void turn(Harmonic& motion) { motion.amplitude = turned(motion.amplitude); }
    void turn(Keyframes& motion) { motion.world_from_keys = kTurn * motion.world_from_keys; }

    std::map<std::shared_ptr<const Rig>, std::shared_ptr<const Rig>> rigs_;
};

} // namespace

void turn_z_up(Scene& scene) {
    Turner turner;
    for (Object& object : scene.objects) {
        turn(object.world_from_object);
        turner.turn(object.motion);
        if (object.sphere) object.sphere->centre = turned(object.sphere->centre);
    }
    for (Camera& camera : scene.cameras) {
        camera.eye = turned(camera.eye), camera.target = turned(camera.target),
        camera.up = turned(camera.up);
        turner.turn(camera.follows);
        // It is carried from where it stands, which has turned.
        camera.follows.node_from_object *= dmat4(glm::transpose(kTurn));
    }
    for (Punctual& light : scene.punctual) {
        turn(light.world_from_light);
        turner.turn(light.motion);
    }
}

} // namespace catoptric::scene
