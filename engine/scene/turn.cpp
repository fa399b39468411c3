// Which way is up.
#include "scene/wishes.hpp"

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

void turn(std::monostate&) {}
void turn(Harmonic& motion) { motion.amplitude = turned(motion.amplitude); }
void turn(Keyframes& motion) { motion.world_from_keys = kTurn * motion.world_from_keys; }

} // namespace

void turn_z_up(Scene& scene) {
    const auto turn_motion = [](Motion& motion) {
        std::visit([](auto& its) { turn(its); }, motion);
    };
    for (Object& object : scene.objects) {
        turn(object.world_from_object);
        turn_motion(object.motion);
        if (object.sphere) object.sphere->centre = turned(object.sphere->centre);
    }
    for (Camera& camera : scene.cameras)
        camera.eye = turned(camera.eye), camera.target = turned(camera.target),
        camera.up = turned(camera.up);
    for (Punctual& light : scene.punctual) {
        turn(light.world_from_light);
        turn_motion(light.motion);
    }
}

} // namespace catoptric::scene
