#include "scene/motion.hpp"

#include "core/error.hpp"
#include "scene/moved_sphere.hpp"
#include "scene/pose.hpp"
#include "scene/scene.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/gtc/quaternion.hpp>

namespace catoptric::scene {

namespace {

/// Returns the time wrapped into [0, end]. After the end, the motion starts again at 0.
double wrapped(double seconds, double end) {
    if (!(end > 0) || (seconds >= 0 && seconds <= end)) return seconds;
    const double rest = std::fmod(seconds, end);
    return rest < 0 ? rest + end : rest;
}

/// Returns the cubic Hermite value of glTF 2.0, appendix C, with s from 0 to 1 in an interval of td
/// seconds:
///   p = (2s^3 - 3s^2 + 1) v_k + td (s^3 - 2s^2 + s) b_k
///     + (-2s^3 + 3s^2) v_k+1 + td (s^3 - s^2) a_k+1
template <typename Value>
Value hermite(const Value& value, const Value& out_tangent, const Value& next,
              const Value& in_tangent, double s, double interval) {
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * value + interval * (s3 - 2 * s2 + s) * out_tangent +
           (3 * s2 - 2 * s3) * next + interval * (s3 - s2) * in_tangent;
}

dvec3 between(const dvec3& a, const dvec3& b, double s) { return glm::mix(a, b, s); }
/// Interpolates along the shorter arc.
dvec4 between(const dvec4& a, const dvec4& b, double s) {
    const glm::dquat q = glm::slerp(glm::dquat(a.w, a.x, a.y, a.z), glm::dquat(b.w, b.x, b.y, b.z),
                                    s);
    return {q.x, q.y, q.z, q.w};
}

/// Returns the track's value at any time: before, between or after its keys. The track has at least
/// one key.
template <typename Value>
Value value_at(const Track<Value>& track, double time) {
    const auto after = std::ranges::upper_bound(track.times, time);
    if (after == track.times.begin()) return track.values.front();
    if (after == track.times.end()) return track.values.back();
    const std::size_t k = static_cast<std::size_t>(after - track.times.begin()) - 1;
    const double interval = track.times[k + 1] - track.times[k];
    const double s = (time - track.times[k]) / interval;
    using enum Interpolation;
    if (track.interpolation == step) return track.values[k];
    if (track.interpolation == linear) return between(track.values[k], track.values[k + 1], s);
    return hermite(track.values[k], track.out_tangents[k], track.values[k + 1],
                   track.in_tangents[k + 1], s, interval);
}

template <typename Value>
double end_of(const std::shared_ptr<const Track<Value>>& track) {
    return track == nullptr || track->times.empty() ? 0 : std::max(track->times.back(), 0.0);
}

double end_of(const Rig& rig) {
    double end = 0;
    for (const Rig::Node& node : rig.nodes)
        end = std::max(
            {end, end_of(node.translations), end_of(node.rotations), end_of(node.scales)});
    return end;
}

dmat4 parent_from_node(const Rig::Node& node, double time) {
    const auto now = [&](const auto& track, const auto& otherwise) {
        return track == nullptr || track->times.empty() ? otherwise : value_at(*track, time);
    };
    const dvec4 turn = now(node.rotations, node.rotation);
    const dvec3 scale = now(node.scales, node.scale);
    const glm::dquat rotation(turn.w, turn.x, turn.y, turn.z);
    const double length = glm::length(rotation); // a cubic rotation may pass through zero
    dmat4 result = length > 0 ? dmat4(glm::mat3_cast(rotation / length)) : dmat4(1);
    for (int i = 0; i < 3; ++i) result[i] *= scale[i];
    result[3] = dvec4(now(node.translations, node.translation), 1);
    return node.parent_from_space * result;
}

/// Transforms of the nodes of rigs at one instant. Each rig is computed once.
class Poses {
public:
    explicit Poses(double seconds) : seconds_(seconds) {}
    dmat4 of(const Follows& follows) {
        std::vector<dmat4>& pose = poses_[follows.rig.get()];
        if (pose.empty()) pose = world_from_nodes(*follows.rig, seconds_);
        return pose[follows.node] * follows.node_from_object;
    }

private:
    double seconds_;
    std::map<const Rig*, std::vector<dmat4>> poses_;
};

dvec3 offset_at(const Harmonic& motion, double seconds) {
    // 1 - cos(a) = 2 sin^2(a/2) keeps its digits near zero. The remainder is exact.
    const double phase = std::remainder(seconds, motion.period) / motion.period;
    const double sine = std::sin(std::numbers::pi * phase);
    return motion.amplitude * (2 * sine * sine);
}

dvec3 offset_at(const Keyframes& motion, double seconds) {
    if (motion.keys == nullptr || motion.keys->times.empty()) return dvec3(0);
    const Keys& keys = *motion.keys;
    const double time = motion.repeats ? wrapped(seconds, keys.times.back()) : seconds;
    return motion.world_from_keys * (value_at(keys, time) - motion.rest);
}

/// Returns the translation of a motion that keeps the object's axes; zero for any other motion.
dvec3 offset_of(const Motion& motion, double seconds) {
    if (const auto* harmonic = std::get_if<Harmonic>(&motion)) return offset_at(*harmonic, seconds);
    if (const auto* frames = std::get_if<Keyframes>(&motion)) return offset_at(*frames, seconds);
    return dvec3(0);
}

/// Returns the camera carried by its node. It keeps its distance to the target, however the node is
/// scaled.
Camera carried(const Camera& camera, const dmat4& now_from_rest) {
    Camera result = camera;
    result.eye = transform_point(now_from_rest, camera.eye);
    const dvec3 ahead = normalized_or_zero(dmat3(now_from_rest) * (camera.target - camera.eye));
    result.target = result.eye + glm::distance(camera.target, camera.eye) * ahead;
    result.up = normalized_or_zero(dmat3(now_from_rest) * camera.up);
    result.follows = {};
    return result;
}

} // namespace

const Follows* followed(const Motion& motion) {
    const auto* follows = std::get_if<Follows>(&motion);
    return follows && follows->rig ? follows : nullptr;
}

Keys in_the_world(const Keyframes& motion) {
    Keys keys = motion.keys ? *motion.keys : Keys();
    for (dvec3& value : keys.values) value = motion.world_from_keys * (value - motion.rest);
    for (dvec3& tangent : keys.in_tangents) tangent = motion.world_from_keys * tangent;
    for (dvec3& tangent : keys.out_tangents) tangent = motion.world_from_keys * tangent;
    return keys;
}

std::vector<dmat4> world_from_nodes(const Rig& rig, double seconds) {
    const double time = rig.repeats ? wrapped(seconds, end_of(rig)) : seconds;
    std::vector<dmat4> world;
    world.reserve(rig.nodes.size());
    for (const Rig::Node& node : rig.nodes) {
        const dmat4 own = parent_from_node(node, time);
        world.push_back(node.parent ? world[*node.parent] * own : own);
    }
    return world;
}

double period_of(const Motion& motion) {
    if (const auto* harmonic = std::get_if<Harmonic>(&motion)) return harmonic->period;
    if (const auto* frames = std::get_if<Keyframes>(&motion)) return end_of(frames->keys);
    const Follows* follows = followed(motion);
    return follows ? end_of(*follows->rig) : 0;
}

double period(const Scene& scene) {
    double longest = 0;
    const Rig* last = nullptr; // skips neighbours that follow the same rig, as a rig may be long
    const auto add = [&](const Motion& motion) {
        const auto* follows = std::get_if<Follows>(&motion);
        if (follows && follows->rig.get() == last) return;
        if (follows) last = follows->rig.get();
        longest = std::max(longest, period_of(motion));
    };
    for (const Object& object : scene.objects) add(object.motion);
    for (const Punctual& light : scene.punctual) add(light.motion);
    for (const Camera& camera : scene.cameras) add(camera.follows);
    return longest;
}

Camera camera_at(const Camera& camera, double seconds) {
    return camera.follows.rig ? carried(camera, Poses(seconds).of(camera.follows)) : camera;
}

void check_time(double seconds) {
    check(std::isfinite(seconds), Failure::usage, "time: wanted a finite number of seconds, found ",
          seconds);
}

void pose(Scene& still, const Scene& scene, double seconds) {
    check_time(seconds);
    still.objects = scene.objects, still.punctual = scene.punctual, still.cameras = scene.cameras;
    Poses poses(seconds);
    const auto move = [&](dmat4& place, const Motion& motion) {
        if (const Follows* follows = followed(motion)) place = poses.of(*follows);
        const dvec3 offset = offset_of(motion, seconds);
        place[3] += dvec4(offset, 0);
        return offset;
    };
    for (Object& object : still.objects) {
        if (const Follows* follows = followed(object.motion))
            object.sphere = moved_sphere(object, poses.of(*follows));
        const dvec3 offset = move(object.world_from_object, object.motion);
        if (object.sphere) object.sphere->centre += offset;
        object.motion = std::monostate();
    }
    for (Punctual& light : still.punctual) {
        move(light.world_from_light, light.motion);
        light.motion = std::monostate();
    }
    for (Camera& camera : still.cameras)
        if (camera.follows.rig) camera = carried(camera, poses.of(camera.follows));
}

SceneAt::SceneAt(const Scene& scene, double seconds) : scene_(scene) {
    check_time(seconds);
    if (is_animated(scene)) moved_ = at(scene, seconds);
}

Scene at(const Scene& scene, double seconds) {
    Scene still = scene;
    pose(still, scene, seconds);
    return still;
}

} // namespace catoptric::scene
