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
double wrap_time(double seconds, double end) {
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

dvec3 interpolate(const dvec3& a, const dvec3& b, double s) { return glm::mix(a, b, s); }
/// Interpolates two unit quaternions along the shorter arc.
dvec4 interpolate(const dvec4& a, const dvec4& b, double s) {
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
    if (track.interpolation == linear) return interpolate(track.values[k], track.values[k + 1], s);
    return hermite(track.values[k], track.out_tangents[k], track.values[k + 1],
                   track.in_tangents[k + 1], s, interval);
}

template <typename Value>
double end_time(const std::shared_ptr<const Track<Value>>& track) {
    return track == nullptr || track->times.empty() ? 0 : std::max(track->times.back(), 0.0);
}

double end_time(const NodeRig& rig) {
    double end = 0;
    for (const NodeRig::RigNode& node : rig.nodes)
        end = std::max(
            {end, end_time(node.translations), end_time(node.rotations), end_time(node.scales)});
    return end;
}

dmat4 parent_from_node(const NodeRig::RigNode& node, double time) {
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
class RigAtTime {
public:
    explicit RigAtTime(double seconds) : seconds_(seconds) {}
    dmat4 world_from_object(const RigAttachment& follows) {
        std::vector<dmat4>& pose = poses_[follows.rig.get()];
        if (pose.empty()) pose = node_transforms(*follows.rig, seconds_);
        return pose[follows.node] * follows.node_from_object;
    }

private:
    double seconds_;
    std::map<const NodeRig*, std::vector<dmat4>> poses_;
};

dvec3 offset_at(const HarmonicMotion& motion, double seconds) {
    // 1 - cos(a) = 2 sin^2(a/2) keeps its digits near zero. The remainder is exact.
    const double phase = std::remainder(seconds, motion.period) / motion.period;
    const double sine = std::sin(std::numbers::pi * phase);
    return motion.amplitude * (2 * sine * sine);
}

dvec3 offset_at(const Keyframes& motion, double seconds) {
    if (motion.keys == nullptr || motion.keys->times.empty()) return dvec3(0);
    const TranslationTrack& keys = *motion.keys;
    const double time = motion.repeats ? wrap_time(seconds, keys.times.back()) : seconds;
    return motion.world_from_keys * (value_at(keys, time) - motion.rest);
}

/// Returns the translation of a motion that keeps the object's axes; zero for any other motion.
dvec3 translation_at(const Motion& motion, double seconds) {
    if (const auto* harmonic = std::get_if<HarmonicMotion>(&motion))
        return offset_at(*harmonic, seconds);
    if (const auto* frames = std::get_if<Keyframes>(&motion)) return offset_at(*frames, seconds);
    return dvec3(0);
}

/// Returns the camera carried by its node. It keeps its distance to the target, however the node is
/// scaled.
Camera move_camera_with_node(const Camera& camera, const dmat4& now_from_rest) {
    Camera result = camera;
    result.eye = transform_point(now_from_rest, camera.eye);
    const dvec3 ahead = normalized_or_zero(dmat3(now_from_rest) * (camera.target - camera.eye));
    result.target = result.eye + glm::distance(camera.target, camera.eye) * ahead;
    result.up = normalized_or_zero(dmat3(now_from_rest) * camera.up);
    result.follows = {};
    return result;
}

} // namespace

const RigAttachment* followed_node(const Motion& motion) {
    const auto* follows = std::get_if<RigAttachment>(&motion);
    return follows && follows->rig ? follows : nullptr;
}

TranslationTrack keys_in_world(const Keyframes& motion) {
    TranslationTrack keys = motion.keys ? *motion.keys : TranslationTrack();
    for (dvec3& value : keys.values) value = motion.world_from_keys * (value - motion.rest);
    for (dvec3& tangent : keys.in_tangents) tangent = motion.world_from_keys * tangent;
    for (dvec3& tangent : keys.out_tangents) tangent = motion.world_from_keys * tangent;
    return keys;
}

std::vector<dmat4> node_transforms(const NodeRig& rig, double seconds) {
    const double time = rig.repeats ? wrap_time(seconds, end_time(rig)) : seconds;
    std::vector<dmat4> world;
    world.reserve(rig.nodes.size());
    for (const NodeRig::RigNode& node : rig.nodes) {
        const dmat4 own = parent_from_node(node, time);
        world.push_back(node.parent ? world[*node.parent] * own : own);
    }
    return world;
}

double motion_period(const Motion& motion) {
    if (const auto* harmonic = std::get_if<HarmonicMotion>(&motion)) return harmonic->period;
    if (const auto* frames = std::get_if<Keyframes>(&motion)) return end_time(frames->keys);
    const RigAttachment* follows = followed_node(motion);
    return follows ? end_time(*follows->rig) : 0;
}

double scene_period(const Scene& scene) {
    double longest = 0;
    const NodeRig* last =
        nullptr; // a rig may have many nodes; objects that follow the same rig are often neighbours
    const auto add = [&](const Motion& motion) {
        const auto* follows = std::get_if<RigAttachment>(&motion);
        if (follows && follows->rig.get() == last) return;
        if (follows) last = follows->rig.get();
        longest = std::max(longest, motion_period(motion));
    };
    for (const Object& object : scene.objects) add(object.motion);
    for (const PunctualLight& light : scene.punctual) add(light.motion);
    for (const Camera& camera : scene.cameras) add(camera.follows);
    return longest;
}

Camera camera_at(const Camera& camera, double seconds) {
    return camera.follows.rig
               ? move_camera_with_node(camera, RigAtTime(seconds).world_from_object(camera.follows))
               : camera;
}

void check_time(double seconds) {
    check(std::isfinite(seconds), Failure::usage, "time: wanted a finite number of seconds, found ",
          seconds);
}

void move_to_time(Scene& still, const Scene& scene, double seconds) {
    check_time(seconds);
    still.objects = scene.objects, still.punctual = scene.punctual, still.cameras = scene.cameras;
    RigAtTime poses(seconds);
    const auto apply_motion = [&](dmat4& place, const Motion& motion) {
        if (const RigAttachment* follows = followed_node(motion))
            place = poses.world_from_object(*follows);
        const dvec3 offset = translation_at(motion, seconds);
        place[3] += dvec4(offset, 0);
        return offset;
    };
    for (Object& object : still.objects) {
        if (const RigAttachment* follows = followed_node(object.motion))
            object.sphere = move_sphere(object, poses.world_from_object(*follows));
        const dvec3 offset = apply_motion(object.world_from_object, object.motion);
        if (object.sphere) object.sphere->centre += offset;
        object.motion = std::monostate();
    }
    for (PunctualLight& light : still.punctual) {
        apply_motion(light.world_from_light, light.motion);
        light.motion = std::monostate();
    }
    for (Camera& camera : still.cameras)
        if (camera.follows.rig)
            camera = move_camera_with_node(camera, poses.world_from_object(camera.follows));
}

SceneAtTime::SceneAtTime(const Scene& scene, double seconds) : scene_(scene) {
    check_time(seconds);
    if (is_animated(scene)) moved_ = scene_at(scene, seconds);
}

Scene scene_at(const Scene& scene, double seconds) {
    Scene still = scene;
    move_to_time(still, scene, seconds);
    return still;
}

} // namespace catoptric::scene
